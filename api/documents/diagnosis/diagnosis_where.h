#pragma once

#include "api/json/writer.h"
#include "gap/diagnosis/diagnosis.h"
#include "gap/diagnosis/model/drive_campaign.h"

namespace slipway::api::json {

// The key "where" of a diagnosis: channels, regimes, places and windows that hold the gap.
void write_where(Writer& w, const gap::DriveCampaign& campaign, const gap::Diagnosis& d);

}  // namespace slipway::api::json
