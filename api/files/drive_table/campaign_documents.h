#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>

#include "api/json/writer.h"
#include "campaign/campaign_summary.h"
#include "campaign/drive_record.h"
#include "campaign/drive_table.h"
#include "core/result.h"

namespace slipway::api::json {

// campaign.json of a "drive-campaign/1": what the operators knew, and which files hold what was measured. A
// drive of several legs is as many drives there, since the format knows one command a drive. Drives without a
// record, and those that the simulator had no answer to, are left out.
std::string campaign_document(const campaign::DriveTable& table, std::span<const campaign::TableDrive> drives,
                              const std::map<std::string, campaign::DriveRecord>& records);

// summary.json: the drives of each terrain.
std::string campaign_summary_document(const campaign::DriveTable& table, std::size_t drives,
                                      std::span<const campaign::TerrainSummary> summaries);

// drives/ID.json, "drive-outcome/1". Read back, all is there but events, work and soils.
std::string drive_record_document(const campaign::DriveRecord& record);
Result<campaign::DriveRecord> read_drive_record(std::string_view bytes);

}  // namespace slipway::api::json
