#pragma once

#include <string>
#include <vector>

#include "api/json/strict_reader.h"
#include "gap/diagnosis/model/drive_campaign.h"

namespace slipway::api {

inline constexpr std::size_t kMaxAppendedDrives = 2000;

// Drives in a request: those of "drive-campaign/1" with their rows as "csv" in the place of "file", on the
// terrains of a campaign that ships and made by its rover. They become a campaign of their own with the
// setting of that one; faults go to the reader's. The fingerprint is of every byte of theirs and of the
// setting's.
gap::DriveCampaign read_appended_drives(json::ObjectReader& reader, const gap::DriveCampaign& setting);

}  // namespace slipway::api
