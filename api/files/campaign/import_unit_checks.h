#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "api/files/campaign/drive_import.h"
#include "gap/diagnosis/model/drive_campaign.h"

namespace slipway::api {

// Readings of imported drives whose sizes are those of another unit: beside what the rover can have, what it
// was commanded, and where it went. Each warning names the key that mends it.
std::vector<std::string> unit_warnings(const ImportedCampaign& campaign, const gap::DriveCampaign& read);

// " to \"rad\"", the unit in which values that are `times` as large as expected would be as expected; ""
// where none is.
std::string better_unit(const ImportedCampaign& campaign, std::string_view key, double times);

}  // namespace slipway::api
