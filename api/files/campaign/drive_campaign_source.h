#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "api/files/catalogue.h"
#include "core/result.h"
#include "gap/diagnosis/model/drive_campaign.h"

namespace slipway::api {

// Reads a "drive-campaign/1": campaign.json, the terrains and the drives' CSVs that it names, all of them
// inside the folder. A raster without a coordinate reference system is taken as a local frame of metres,
// which is what the format's map frame is. The faults of all files are reported together; pointers begin with
// the file, "campaign.json#/drives/3/terrain" or "D001.csv#/12/x_m". Errors: unreadable_data.
Result<gap::DriveCampaign> load_drive_campaign(const std::filesystem::path& folder,
                                               const Catalogue& catalogue);

// The noises that nobody stated of channels that the drives have, each in a sentence: a noise is asked for
// where its channel was measured, and nowhere else.
std::vector<std::string> missing_noise(const gap::MeasurementStd& std,
                                       std::span<const gap::MeasuredDriveSeries> drives);

// Of a drive of which only the end was recorded the first and the last row are taken; a note says so.
void take_ends_of_final_only(gap::DriveCampaign& campaign, gap::MeasuredDriveSeries& drive);
// What the drives' rows say of how they were recorded: rates that differ from the commanded ones, currents
// that were divided evenly. Notes say so.
void take_as_recorded(gap::DriveCampaign& campaign);

}  // namespace slipway::api
