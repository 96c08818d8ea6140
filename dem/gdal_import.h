#pragma once

#include <gdal_utils.h>

#include <filesystem>
#include <string>
#include <vector>

#include "core/progress.h"
#include "core/result.h"
#include "dem/gdal_raster.h"

// What imports of elevation and of classes have in common.
namespace slipway::dem {

// How files are written that an import makes.
std::vector<std::string> tiled_creation(bool heights);

// Runs gdalwarp's work from an open raster into a new file. Errors: unwritable_file with GDAL's reasons.
Result<void> warp_raster(GDALDataset& source, const std::filesystem::path& out,
                         const std::vector<std::string>& options, const GdalSession& session,
                         Progress& progress, const char* stage);

// Adds overviews down to a side of some hundred cells. `method` is GDAL's: "AVERAGE", "MODE".
Result<void> add_overviews(const std::filesystem::path& path, const char* method, const GdalSession& session,
                           Progress& progress);

// Faults as an import tells them: what it mends by itself says so.
Error import_error(const std::vector<RasterFault>& faults, const char* pointer);

// One GDAL callback for a stage that Progress is told of.
struct StageProgress {
  Progress* progress;
  const char* stage;
};
int CPL_STDCALL report_stage(double share, const char* message, void* stage);

}  // namespace slipway::dem
