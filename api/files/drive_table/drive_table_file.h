#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "api/files/catalogue.h"
#include "api/json/strict_reader.h"
#include "campaign/drive_table.h"
#include "core/result.h"

namespace slipway::api::json {

// Reads a table of drives ("campaign-table/1", docs/guide/campaigns.md) against what the service ships;
// elevation files are looked for in `folder`. All faults together, those of campaign::faults_of too:
// invalid_request.
Result<campaign::DriveTable> read_campaign_table(std::string_view bytes, const std::filesystem::path& folder,
                                                 const Catalogue& catalogue);

// Parts of it. The terrains need the soils' names, the drives the terrains'; what is not given for a leg is
// the rover's.
std::vector<campaign::TableTerrain> read_table_terrains(
    ObjectReader& table, const std::filesystem::path& folder,
    const std::map<std::string, sim::SoilDistribution, std::less<>>& soils);
std::vector<campaign::DriveEntry> read_table_drives(ObjectReader& table,
                                                    const std::vector<campaign::TableTerrain>& terrains,
                                                    const sim::RoverModel& rover);
void read_table_sensors(ObjectReader& table, sim::DriveSensors& sensors);

}  // namespace slipway::api::json
