#include "research/validation/report/conformal.h"

#include <gtest/gtest.h>

#include "core/random.h"

namespace slipway::validation {
namespace {

TEST(StretchToHold, IsOneAtTheEndsAndCountsFromTheMiddle) {
  EXPECT_DOUBLE_EQ(stretch_to_hold(2.0, 4.0, 4.0), 1.0);
  EXPECT_DOUBLE_EQ(stretch_to_hold(2.0, 4.0, 2.0), 1.0);
  EXPECT_DOUBLE_EQ(stretch_to_hold(2.0, 4.0, 3.0), 0.0);
  EXPECT_DOUBLE_EQ(stretch_to_hold(2.0, 4.0, 0.0), 3.0);
}

TEST(ConformalStretch, IsTheRankThatHoldsTheNextOne) {
  std::vector<double> nine;
  for (int k = 9; k >= 1; --k) nine.push_back(k);
  EXPECT_EQ(conformal_stretch(nine, 0.9), 9.0);
  EXPECT_EQ(conformal_stretch(nine, 0.5), 5.0);
  nine.pop_back();
  EXPECT_FALSE(conformal_stretch(nine, 0.9));
}

// Intervals that are a third of what they should be, and the values of a second sample in the corrected ones.
TEST(ConformalStretch, MakesIntervalsThatAreTooNarrowHoldTheirShare) {
  std::vector<double> stretches;
  for (std::uint64_t k = 0; k < 500; ++k)
    stretches.push_back(stretch_to_hold(-0.55, 0.55, random_normal(1, k)));
  const double stretch = conformal_stretch(stretches, 0.9).value();
  EXPECT_NEAR(stretch, 3.0, 0.3);
  int before = 0, after = 0;
  for (std::uint64_t k = 0; k < 4000; ++k) {
    const double needed = stretch_to_hold(-0.55, 0.55, random_normal(2, k));
    before += needed <= 1.0 ? 1 : 0;
    after += needed <= stretch ? 1 : 0;
  }
  EXPECT_LT(before, 0.5 * 4000);
  EXPECT_NEAR(after / 4000.0, 0.9, 0.03);
}

}  // namespace
}  // namespace slipway::validation
