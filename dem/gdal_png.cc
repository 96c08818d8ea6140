#include <cpl_vsi.h>
#include <fmt/format.h>
#include <gdal_priv.h>

#include <atomic>
#include <memory>

#include "dem/gdal_session.h"
#include "dem/hillshade.h"

namespace slipway::dem {
namespace {

struct VsiFree {
  void operator()(GByte* bytes) const { VSIFree(bytes); }
};

}  // namespace

Result<std::string> encode_png(const std::vector<std::uint8_t>& grey, int rows, int columns) {
  if (rows < 1 || columns < 1 ||
      grey.size() != static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns)) {
    return fail(ErrorCode::kInvalidRequest,
                fmt::format("An image of {} x {} pixels was given {} values.", rows, columns, grey.size()));
  }
  const GdalSession session;
  GDALDriverManager& drivers = *GetGDALDriverManager();
  const GDALDatasetUniquePtr image(
      drivers.GetDriverByName("MEM")->Create("", columns, rows, 1, GDT_Byte, nullptr));
  // GDAL takes what it writes from as a pointer to non-const; GF_Write reads it only.
  auto* pixels = const_cast<std::uint8_t*>(grey.data());
  if (!image || image->GetRasterBand(1)->RasterIO(GF_Write, 0, 0, columns, rows, pixels, columns, rows,
                                                  GDT_Byte, 0, 0, nullptr) != CE_None) {
    return fail(ErrorCode::kInternal, fmt::format("The image could not be held: {}", session.complaints()));
  }
  // A name of its own for each call: the memory files are the process's.
  static std::atomic<unsigned long long> count{0};
  const std::string name = fmt::format("/vsimem/slipway-{}.png", count++);
  GDALDatasetUniquePtr written(
      drivers.GetDriverByName("PNG")->CreateCopy(name.c_str(), image.get(), TRUE, nullptr, nullptr, nullptr));
  const bool complete = written != nullptr;
  written.reset();  // closing writes the end of the file
  vsi_l_offset size = 0;
  const std::unique_ptr<GByte, VsiFree> bytes(VSIGetMemFileBuffer(name.c_str(), &size, TRUE));
  if (!complete || !bytes) {
    return fail(ErrorCode::kInternal,
                fmt::format("The image could not be encoded: {}", session.complaints()));
  }
  return std::string(reinterpret_cast<const char*>(bytes.get()), static_cast<std::size_t>(size));
}

}  // namespace slipway::dem
