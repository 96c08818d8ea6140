#pragma once

#include <string>
#include <vector>

#include "api/files/campaign/drive_import.h"
#include "gap/diagnosis/model/drive_campaign.h"

namespace slipway::api {

// What imported drives show of wheels that were read from columns of other wheels, or in the other sense: by
// the commanded rates and steering angles, and the sense in which motors drive. Each warning names the
// wheels and the key that mends it.
std::vector<std::string> wheel_warnings(const ImportedCampaign& campaign, const gap::DriveCampaign& read);

}  // namespace slipway::api
