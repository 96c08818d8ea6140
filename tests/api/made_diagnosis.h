#pragma once

#include <gtest/gtest.h>

#include "gap/diagnosis/diagnosis.h"
#include "gap/diagnosis/model/drive_campaign.h"

namespace slipway::api::testing {

// data/gap-practice/p05 as it ships.
gap::DriveCampaign practice_campaign();

// Something in every member, also what is not finite, and a corrected model: made up, in no time.
gap::Diagnosis full_diagnosis(const gap::DriveCampaign& campaign);

// Tests of what is made of a diagnosis: both of the above, made once.
class WithFullDiagnosis : public ::testing::Test {
 protected:
  static const gap::DriveCampaign& campaign();
  static const gap::Diagnosis& diagnosis();
};

}  // namespace slipway::api::testing
