#pragma once

#include <gdal_priv.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/result.h"
#include "dem/elevation_source.h"
#include "dem/gdal_session.h"

namespace slipway::dem {

// A raster that passed every check which needs no cell to be read.
struct CheckedRaster {
  GDALDatasetUniquePtr dataset;
  ElevationInfo info;
  std::unique_ptr<OGRSpatialReference> system;  // that places its cells, see system_of(); none: nullptr
  int band = 1;                                 // the only one beside opacity
};

// A reason why a raster can't be used as it is.
struct RasterFault {
  ErrorCode code = ErrorCode::kUnreadableRaster;
  std::string sentence;           // with the command that mends it
  bool mendable = false;          // an import can mend it
  bool cells_are_closed = false;  // no cell can be read before it is mended
};

// Opens a regular file with an allowed driver, read-only, with what the sidecars NAME.aux.xml, NAME.msk and
// NAME.ovr beside it say. Errors: unreadable_raster.
Result<GDALDatasetUniquePtr> open_raster(const std::filesystem::path& path, const GdalSession& session);

// All that is wrong with a raster in this coordinate reference system, as far as no cell needs to be read. Of
// the system its horizontal part counts. band: the one that was chosen; 0: there must be one beside opacity.
std::vector<RasterFault> faults_of(GDALDataset& dataset, const OGRSpatialReference* crs,
                                   const std::string& file, PlacelessRaster placeless, int band = 0);
// The faults, of which there is at least one, as one error.
Error error_of(const std::vector<RasterFault>& faults);

// Opens a regular file with an allowed driver, read-only, and refuses what can't be used: more or fewer than
// one band beside one of opacity, complex numbers, a grid that is rotated, south-up or without a place,
// another CRS than a metric projection, blocks that would cost more memory than kMaxBlockBytes to read one
// cell. All reasons are reported together. A placeless raster that is let through has an empty crs_wkt.
Result<CheckedRaster> open_checked_raster(const std::filesystem::path& path, const GdalSession& session,
                                          PlacelessRaster placeless);

// A strip or tile is decoded as a whole, so a small file with one huge block would be a bomb.
constexpr long long kMaxBlockBytes = 256LL << 20;

// "rows 0 to 299, columns 5 to 304", as a person counts them in the raster.
std::string describe(const CellWindow& window);

}  // namespace slipway::dem
