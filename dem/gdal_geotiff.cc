#include <cpl_string.h>
#include <fmt/format.h>
#include <gdal_priv.h>

#include <array>
#include <vector>

#include "dem/gdal_memory_file.h"
#include "dem/gdal_session.h"
#include "dem/geotiff.h"

namespace slipway::dem {
namespace {

constexpr float kNodata = -9999.0F;

std::vector<float> stored_heights(const Terrain& terrain) {
  const GridGeometry& geometry = terrain.geometry();
  std::vector<float> heights;
  heights.reserve(static_cast<std::size_t>(geometry.rows) * static_cast<std::size_t>(geometry.columns));
  for (int row = 0; row < geometry.rows; ++row)
    for (int column = 0; column < geometry.columns; ++column)
      heights.push_back(static_cast<float>(terrain.height_m(Cell{row, column}).value_or(kNodata)));
  return heights;
}

std::vector<std::int16_t> stored_classes(const SoilMap& map, std::int16_t elsewhere) {
  const GridGeometry& geometry = map.geometry();
  std::vector<std::int16_t> classes;
  classes.reserve(static_cast<std::size_t>(geometry.rows) * static_cast<std::size_t>(geometry.columns));
  for (int row = 0; row < geometry.rows; ++row) {
    for (int column = 0; column < geometry.columns; ++column) {
      const Eigen::Vector2d centre = geometry.centre_m({row, column});
      const bool known = map.soil_at(centre.x(), centre.y()).has_value();
      classes.push_back(known ? static_cast<std::int16_t>(*map.class_at(centre.x(), centre.y())) : elsewhere);
    }
  }
  return classes;
}

// GF_Write reads the cells only, but GDAL takes them as a pointer to non-const.
bool write(GDALDataset& raster, const GridGeometry& geometry, void* cells, GDALDataType type,
           const std::string& crs_wkt) {
  std::array<double, 6> transform{geometry.west_m,   geometry.cell_x_m, 0.0, geometry.north_m, 0.0,
                                  -geometry.cell_y_m};
  if (raster.SetGeoTransform(transform.data()) != CE_None) return false;
  if (!crs_wkt.empty() && raster.SetProjection(crs_wkt.c_str()) != CE_None) return false;
  GDALRasterBand& band = *raster.GetRasterBand(1);
  if (type == GDT_Float32 && band.SetNoDataValue(kNodata) != CE_None) return false;
  return band.RasterIO(GF_Write, 0, 0, geometry.columns, geometry.rows, cells, geometry.columns,
                       geometry.rows, type, 0, 0, nullptr) == CE_None;
}

Result<std::string> encode(const GridGeometry& geometry, void* cells, GDALDataType type,
                           const std::string& crs_wkt) {
  const GdalSession session;
  GdalMemoryFile file(".tif");
  CPLStringList options;
  options.AddNameValue("COMPRESS", "DEFLATE");
  options.AddNameValue("PREDICTOR", type == GDT_Float32 ? "3" : "2");
  GDALDatasetUniquePtr raster(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
      file.name().c_str(), geometry.columns, geometry.rows, 1, type, options.List()));
  const bool complete = raster && write(*raster, geometry, cells, type, crs_wkt);
  raster.reset();  // closing writes the directory of the file
  auto bytes = file.take();
  if (!complete || !bytes) {
    return fail(ErrorCode::kInternal,
                fmt::format("The raster could not be encoded: {}", session.complaints()));
  }
  return *std::move(bytes);
}

}  // namespace

Result<std::string> encode_geotiff(const Terrain& terrain, const std::string& crs_wkt) {
  std::vector<float> heights = stored_heights(terrain);
  return encode(terrain.geometry(), heights.data(), GDT_Float32, crs_wkt);
}

Result<std::string> encode_geotiff(const SoilMap& map, std::int16_t elsewhere, const std::string& crs_wkt) {
  std::vector<std::int16_t> classes = stored_classes(map, elsewhere);
  return encode(map.geometry(), classes.data(), GDT_Int16, crs_wkt);
}

}  // namespace slipway::dem
