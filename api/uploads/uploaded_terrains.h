#pragma once

#include <string>
#include <string_view>

#include "api/files/catalogue.h"
#include "api/files/terrain_import.h"
#include "api/json/faults.h"
#include "api/uploads/upload_folder.h"
#include "core/progress.h"
#include "core/result.h"

namespace slipway::api {

// A terrain that is to be made of files that were sent.
struct TerrainOrder {
  std::string elevation, soil, legend;  // uploads' ids; the latter two empty where there are none
  TerrainImport import;                 // all but the files and the folder
  Asker asker = {};                     // whose it is then
};

// Makes the asker the one whose terrain it is. Errors: conflict at /name where somebody else's has it.
Result<void> claim_terrain(const UploadFolder& uploads, TerrainOrder& order, const Asker& asker);

// Makes terrains/NAME in the uploads, as import_terrain() does, in the place of one that the asker may
// change. Errors: those of import_terrain(), with the places of the order's keys; not_found, damaged_store,
// storage_full.
Result<TerrainImportReport> take_terrain(UploadFolder& uploads, const TerrainOrder& order,
                                         const Catalogue& catalogue, Progress& progress);

}  // namespace slipway::api
