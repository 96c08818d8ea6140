#pragma once

#include <string>
#include <vector>

#include "api/files/campaign/drive_import.h"
#include "core/result.h"
#include "gap/diagnosis/model/drive_campaign.h"

namespace slipway::api {

// What a unit, a sign, an axis or a clock that was taken for another does to imported drives. `read`: the
// campaign that was made of them, as its own reader has it.

// Values that no rover can have (it lies on its back, its motors burn, ...): the first of each key of the
// mapping, with its place in its log and how many there are.
std::vector<Fault> impossible_values(const ImportedCampaign& campaign, const gap::DriveCampaign& read);

// What is possible and yet hardly to be believed: each says what was read, what was expected and which key of
// the mapping to change.
std::vector<std::string> implausible_readings(const ImportedCampaign& campaign,
                                              const gap::DriveCampaign& read);

}  // namespace slipway::api
