// Fits of recorded drives that begin where the model says that the rover would stand.
#include "gap/diagnosis/search/explanation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "gap/diagnosis/search/prepared_campaign.h"
#include "tests/gap/practice_drives.h"

namespace slipway::gap {
namespace {

// Two windows on the steepest ground, which the nominal rover does not climb on soil with seven tenths of the
// friction that there was. Neither the fit's own steps nor its derivatives tell what would make it climb.
TEST(FitExplanation, FindsBackFromSoilsOnWhichTheRoverWouldStand) {
  DriveCampaign campaign = some_drives(6);
  for (NominalSoil& soil : campaign.soils)
    soil.soil.friction_angle_rad = std::atan(0.7 * std::tan(soil.soil.friction_angle_rad));
  DiagnosisOptions options;
  NoProgress progress;
  const auto prepared = prepare_as_believed(campaign, options, progress);
  ASSERT_TRUE(prepared);
  const Hypothesis nothing(campaign, {});
  const auto fitted = [&](double stronger_friction) {
    options.fit.stronger_friction = stronger_friction;
    return fit_explanation(nothing, *prepared->model, *prepared->noise, nothing.neutral(), options.fit, 1);
  };
  const FittedExplanation stuck = fitted(0.0), found = fitted(1.5);
  EXPECT_GT(stuck.unanswered, 20);
  EXPECT_EQ(found.unanswered, 0);
  EXPECT_GT(found.log_evidence, stuck.log_evidence + 500.0);
}

}  // namespace
}  // namespace slipway::gap
