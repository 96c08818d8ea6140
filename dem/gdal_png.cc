#include <fmt/format.h>
#include <gdal_priv.h>

#include <algorithm>

#include "dem/gdal_memory_file.h"
#include "dem/gdal_session.h"
#include "dem/hillshade.h"
#include "dem/rgba_image.h"

namespace slipway::dem {
namespace {

// Pixels of so many bytes each, one band a byte.
Result<std::string> encode(const std::uint8_t* bytes, int rows, int columns, int bands) {
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
  return encode(image.pixels.front().data(), image.rows, image.columns, kBands);
}

}  // namespace slipway::dem
