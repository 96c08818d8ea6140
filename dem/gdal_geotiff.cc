#include <cpl_string.h>
#include <cpl_vsi.h>
#include <fmt/format.h>
#include <gdal_priv.h>

#include <array>
#include <atomic>
#include <memory>
#include <vector>

#include "dem/gdal_session.h"
#include "dem/geotiff.h"

namespace slipway::dem {
namespace {

constexpr float kNodata = -9999.0F;

struct VsiFree {
  void operator()(GByte* bytes) const { VSIFree(bytes); }
};

std::vector<float> stored_heights(const Terrain& terrain) {
  const GridGeometry& geometry = terrain.geometry();
  std::vector<float> heights;
  heights.reserve(static_cast<std::size_t>(geometry.rows) * static_cast<std::size_t>(geometry.columns));
  for (int row = 0; row < geometry.rows; ++row)
    for (int column = 0; column < geometry.columns; ++column)
      heights.push_back(static_cast<float>(terrain.height_m(Cell{row, column}).value_or(kNodata)));
  return heights;
}

bool write(GDALDataset& raster, const Terrain& terrain, const std::string& crs_wkt) {
  const GridGeometry& geometry = terrain.geometry();
  std::array<double, 6> transform{geometry.west_m,   geometry.cell_x_m, 0.0, geometry.north_m, 0.0,
                                  -geometry.cell_y_m};
  if (raster.SetGeoTransform(transform.data()) != CE_None) return false;
  if (!crs_wkt.empty() && raster.SetProjection(crs_wkt.c_str()) != CE_None) return false;
  GDALRasterBand& band = *raster.GetRasterBand(1);
  std::vector<float> heights = stored_heights(terrain);
  return band.SetNoDataValue(kNodata) == CE_None &&
         band.RasterIO(GF_Write, 0, 0, geometry.columns, geometry.rows, heights.data(), geometry.columns,
                       geometry.rows, GDT_Float32, 0, 0, nullptr) == CE_None;
}

}  // namespace

Result<std::string> encode_geotiff(const Terrain& terrain, const std::string& crs_wkt) {
  const GdalSession session;
  // A name of its own for each call: the memory files are the process's.
  static std::atomic<unsigned long long> count{0};
  const std::string name = fmt::format("/vsimem/slipway-{}.tif", count++);
  CPLStringList options;
  options.AddNameValue("COMPRESS", "DEFLATE");
  options.AddNameValue("PREDICTOR", "3");
  GDALDatasetUniquePtr raster(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
      name.c_str(), terrain.geometry().columns, terrain.geometry().rows, 1, GDT_Float32, options.List()));
  const bool complete = raster && write(*raster, terrain, crs_wkt);
  raster.reset();  // closing writes the directory of the file
  vsi_l_offset size = 0;
  const std::unique_ptr<GByte, VsiFree> bytes(VSIGetMemFileBuffer(name.c_str(), &size, TRUE));
  if (!complete || !bytes) {
    return fail(ErrorCode::kInternal,
                fmt::format("The elevation could not be encoded: {}", session.complaints()));
  }
  return std::string(reinterpret_cast<const char*>(bytes.get()), static_cast<std::size_t>(size));
}

}  // namespace slipway::dem
