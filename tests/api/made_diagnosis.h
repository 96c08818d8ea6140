#pragma once

#include "gap/diagnosis/diagnosis.h"
#include "gap/diagnosis/model/drive_campaign.h"

namespace slipway::api::testing {

// data/gap-practice/p05 as it ships.
gap::DriveCampaign practice_campaign();

// Something in every member, also what is not finite, and a corrected model: made up, in no time.
gap::Diagnosis full_diagnosis(const gap::DriveCampaign& campaign);

}  // namespace slipway::api::testing
