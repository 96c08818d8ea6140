#include "research/validation/report/calibration.h"

#include <gtest/gtest.h>

namespace slipway::validation {
namespace {

constexpr double kEdges[] = {0.0, 0.5, 1.0};

// By hand: 8 of 10 where 0.9 was said, 3 of 10 where 0.1 was: each misses.
TEST(CalibrationOf, IsAsByHand) {
  const PredictedShare shares[] = {{0.9, 8.0, 10.0}, {0.1, 3.0, 10.0}};
  const Calibration c = calibration_of(shares, kEdges);
  EXPECT_NEAR(c.share, 11.0 / 20.0, 1e-12);
  EXPECT_NEAR(c.brier, (8 * 0.01 + 2 * 0.81 + 3 * 0.81 + 7 * 0.01) / 20.0, 1e-12);
  EXPECT_NEAR(c.constant_brier, 0.55 * 0.45, 1e-12);
  EXPECT_NEAR(c.expected_error, 0.5 * 0.1 + 0.5 * 0.2, 1e-12);
  ASSERT_EQ(c.bins.size(), 2U);
  EXPECT_NEAR(c.bins[0].predicted, 0.1, 1e-12);
  EXPECT_NEAR(c.bins[0].came_about, 0.3, 1e-12);
}

TEST(CalibrationOf, BinsHoldTheirLowerEndTheLastBothAndEmptyOnesAreLeftOut) {
  const PredictedShare shares[] = {{0.5, 1.0, 2.0}, {1.0, 2.0, 2.0}};
  const Calibration c = calibration_of(shares, kEdges);
  ASSERT_EQ(c.bins.size(), 1U);
  EXPECT_EQ(c.bins[0].predictions, 2U);
  EXPECT_NEAR(c.expected_error, 0.0, 1e-12);
}

}  // namespace
}  // namespace slipway::validation
