#pragma once

#include <cpl_string.h>
#include <gdal_priv.h>

#include <cstddef>
#include <filesystem>
#include <string>

#include "core/progress.h"
#include "core/result.h"
#include "dem/gdal_session.h"

namespace slipway::dem {

// Copies a dataset to a cloud-optimised GeoTIFF of this name, compressed on so many threads; 0: all.
// `options` are the driver's besides. Errors: unwritable_file with GDAL's reasons; cancelled.
Result<void> copy_as_cog(const std::string& name, GDALDataset& source, CPLStringList options,
                         std::size_t threads, const GdalSession& session, Progress& progress);

// What an unfinished copy leaves.
void remove_unfinished_cog(const std::filesystem::path& file);

}  // namespace slipway::dem
