#pragma once

#include <gdal_priv.h>

#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "core/progress.h"
#include "core/result.h"
#include "dem/gdal_heights.h"
#include "dem/gdal_session.h"
#include "dem/import/gdal_import_arrangement.h"
#include "dem/import/gdal_impossible_heights.h"
#include "dem/import/height_census.h"

namespace slipway::dem {

// What was seen of all heights, m.
struct Scan {
  double lowest_m = std::numeric_limits<double>::infinity(), highest_m = -lowest_m;
  long long heights = 0;
  ImpossibleHeights impossible;
  std::vector<ConstantHeight> constant;  // where they are written; rows and columns of the arrangement
};

// The heights of a raster as an arrangement wants them.
struct HeightSource {
  GDALRasterBand& band;
  const HeightEncoding& encoding;
  const Arrangement& arrangement;
  std::string file;  // its name
};

// Reads every cell. Errors: unreadable_raster where it is damaged, has no height or heights that no ground
// has.
Result<Scan> scan_heights(const HeightSource& source, const GdalSession& session, Progress& progress);

// The same, and writes the cells to a new file. Errors: also unwritable_file.
Result<Scan> write_heights(const HeightSource& source, const std::filesystem::path& out,
                           const GdalSession& session, Progress& progress);

}  // namespace slipway::dem
