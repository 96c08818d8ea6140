#include <cpl_conv.h>
#include <gdal_priv.h>

#include <array>

#include "terrain_grid.h"

namespace slipway::gap_benchmark {

bool write_geotiff(const TerrainGrid& grid, const std::filesystem::path& file) {
  GDALAllRegister();
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  if (driver == nullptr) return false;
  char** options = nullptr;
  options = CSLSetNameValue(options, "COMPRESS", "DEFLATE");
  options = CSLSetNameValue(options, "PREDICTOR", "3");
  GDALDataset* set =
      driver->Create(file.string().c_str(), grid.cells(), grid.cells(), 1, GDT_Float32, options);
  CSLDestroy(options);
  if (set == nullptr) return false;
  std::array<double, 6> transform{-grid.half_m(), grid.cell_m(), 0.0, grid.half_m(), 0.0, -grid.cell_m()};
  bool written = set->SetGeoTransform(transform.data()) == CE_None;
  std::vector<float> heights = grid.heights();
  GDALRasterBand* band = set->GetRasterBand(1);
  written = band->SetNoDataValue(-9999.0) == CE_None && written;
  written = band->RasterIO(GF_Write, 0, 0, grid.cells(), grid.cells(), heights.data(), grid.cells(),
                           grid.cells(), GDT_Float32, 0, 0) == CE_None &&
            written;
  GDALClose(set);
  return written;
}

}  // namespace slipway::gap_benchmark
