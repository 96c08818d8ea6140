#include "planner/predict_path.h"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/planner/open_ground.h"

namespace slipway::planner {
namespace {

TEST(PredictPath, JoinsCornersByTurnsAndStraights) {
  const PlanProblem problem = problem_of(kOpen);
  NoProgress progress;
  const auto drive = predict_path(
      problem, {{5.0, 5.0, std::nullopt}, {15.0, 5.0, std::nullopt}, {15.0, 12.0, 0.0}}, progress);
  ASSERT_TRUE(drive.has_value());
  EXPECT_NEAR(drive->length_m, 17.0, 1e-6);
  EXPECT_NEAR(drive->turned_rad, std::numbers::pi, 1e-6);
}

TEST(PredictPath, NamesTheCornerBehindMissingElevation) {
  NoProgress progress;
  const auto drive = predict_path(
      problem_of(kOneGap),
      {{5.0, 15.0, std::nullopt}, {15.0, 15.0, std::nullopt}, {30.0, 15.0, std::nullopt}}, progress);
  ASSERT_FALSE(drive.has_value());
  EXPECT_EQ(drive.error().code, ErrorCode::kNoData);
  ASSERT_FALSE(drive.error().faults.empty());
  EXPECT_EQ(drive.error().faults[0].pointer, "/path/2");
}

}  // namespace
}  // namespace slipway::planner
