#pragma once

#include <map>
#include <string>
#include <string_view>

#include "core/result.h"

namespace slipway::api::json {

// Which file of a "drive-campaign/1" holds which drive: what is read of campaign.json to tune to it.
struct MeasuredCampaign {
  std::map<std::string, std::string> files;  // by the drive's id
};

// Keys that are not needed are passed over: whoever measured may say more. A file that is not in the
// campaign's folder is a fault. Errors: malformed_json, invalid_request.
Result<MeasuredCampaign> read_measured_campaign(std::string_view bytes);

}  // namespace slipway::api::json
