#include <fmt/format.h>
#include <gdal_priv.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "dem/gdal_memory_file.h"
#include "dem/gdal_session.h"
#include "dem/write/hillshade.h"
#include "dem/write/rgba_image.h"

namespace slipway::dem {
namespace {

// Pixels of so many bytes each, one band a byte. With a palette the one band counts its colours.
Result<std::string> encode(const std::uint8_t* bytes, int rows, int columns, int bands,
                           const std::vector<Rgba>& palette = {}) {
  const GdalSession session;
  GDALDriverManager& drivers = *GetGDALDriverManager();
  const GDALDatasetUniquePtr image(
      drivers.GetDriverByName("MEM")->Create("", columns, rows, bands, GDT_Byte, nullptr));
  // GDAL takes what it writes from as a pointer to non-const; GF_Write reads it only.
  auto* pixels = const_cast<std::uint8_t*>(bytes);
  if (!image ||
      image->RasterIO(GF_Write, 0, 0, columns, rows, pixels, columns, rows, GDT_Byte, bands, nullptr, bands,
                      static_cast<GSpacing>(bands) * columns, 1, nullptr) != CE_None) {
    return fail(ErrorCode::kInternal, fmt::format("The image could not be held: {}", session.complaints()));
  }
  if (!palette.empty()) {
    GDALColorTable colours;
    for (std::size_t k = 0; k < palette.size(); ++k) {
      const GDALColorEntry entry{palette[k][0], palette[k][1], palette[k][2], palette[k][3]};
      colours.SetColorEntry(static_cast<int>(k), &entry);
    }
    image->GetRasterBand(1)->SetColorTable(&colours);
  }
  GdalMemoryFile file(".png");
  GDALDatasetUniquePtr written(drivers.GetDriverByName("PNG")->CreateCopy(file.name().c_str(), image.get(),
                                                                          TRUE, nullptr, nullptr, nullptr));
  const bool complete = written != nullptr;
  written.reset();  // closing writes the end of the file
  auto png = file.take();
  if (!complete || !png) {
    return fail(ErrorCode::kInternal,
                fmt::format("The image could not be encoded: {}", session.complaints()));
  }
  return *std::move(png);
}

// An image of few colours: what it is made of, and for every pixel which of them it has.
struct Indexed {
  std::vector<Rgba> palette;
  std::vector<std::uint8_t> indices;
};

// Nothing where it has more colours than a palette holds.
std::optional<Indexed> indexed(const RgbaImage& image) {
  constexpr std::size_t kMostColours = 256;
  Indexed found;
  found.indices.reserve(image.pixels.size());
  std::unordered_map<std::uint32_t, std::uint8_t> places;
  for (const Rgba& pixel : image.pixels) {
    if (!found.indices.empty() && pixel == found.palette[found.indices.back()]) {
      found.indices.push_back(found.indices.back());
      continue;
    }
    const std::uint32_t colour = pixel[0] | pixel[1] << 8U | pixel[2] << 16U | std::uint32_t{pixel[3]} << 24U;
    const auto [place, is_new] = places.try_emplace(colour, static_cast<std::uint8_t>(found.palette.size()));
    if (is_new) {
      if (found.palette.size() == kMostColours) return std::nullopt;
      found.palette.push_back(pixel);
    }
    found.indices.push_back(place->second);
  }
  return found;
}

bool is_opaque_grey(const Rgba& pixel) {
  return pixel[0] == pixel[1] && pixel[1] == pixel[2] && pixel[3] == 0xff;
}

}  // namespace

Result<std::string> encode_png(const std::vector<std::uint8_t>& grey, int rows, int columns) {
  if (rows < 1 || columns < 1 ||
      grey.size() != static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns)) {
    return fail(ErrorCode::kInvalidRequest,
                fmt::format("An image of {} x {} pixels was given {} values.", rows, columns, grey.size()));
  }
  return encode(grey.data(), rows, columns, 1);
}

Result<std::string> encode_png(const RgbaImage& image) {
  if (image.pixels.empty()) return fail(ErrorCode::kInvalidRequest, "An image needs pixels.");
  constexpr int kBands = 4;
  // Shades of grey take a quarter of the bytes, and of the time.
  if (std::all_of(image.pixels.begin(), image.pixels.end(), is_opaque_grey)) {
    std::vector<std::uint8_t> grey(image.pixels.size());
    std::transform(image.pixels.begin(), image.pixels.end(), grey.begin(),
                   [](const Rgba& pixel) { return pixel[0]; });
    return encode(grey.data(), image.rows, image.columns, 1);
  }
  // So do layers of a few classes.
  if (const auto few = indexed(image))
    return encode(few->indices.data(), image.rows, image.columns, 1, few->palette);
  return encode(image.pixels.front().data(), image.rows, image.columns, kBands);
}

}  // namespace slipway::dem
