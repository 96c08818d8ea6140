#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "api/files/catalogue.h"
#include "campaign/drive_table.h"
#include "core/result.h"

namespace slipway::api {

struct LoadedTable {
  campaign::DriveTable table;
  // Of everything its drives depend on: the program's version, the table, rover, soils and terrains.
  std::string digest;
};

// The tables that the service ships, data/campaigns/NAME.json, by name in alphabetical order.
std::vector<std::string> campaign_names(const std::filesystem::path& data);

// A table by its file, or by the name of one that is shipped. Errors: not_found, naming those there are;
// those of json::read_campaign_table.
Result<LoadedTable> load_campaign_table(const std::string& file_or_name, const std::filesystem::path& data,
                                        const Catalogue& catalogue);

}  // namespace slipway::api
