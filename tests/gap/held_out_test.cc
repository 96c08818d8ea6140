#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "gap/diagnosis/held_out/extrapolation.h"
#include "gap/diagnosis/held_out/gap_closure.h"
#include "gap/diagnosis/held_out/planners_view.h"

namespace slipway::gap {
namespace {

constexpr auto kSlip = static_cast<std::size_t>(Channel::kSlip);

TEST(ClosedShare, IsTheFallOfTheRmsOverTheFallToTheFloor) {
  // Of 4 observations: rms 3 before, 1.5 after, floor 1.
  EXPECT_DOUBLE_EQ(*closed_share(36.0, 9.0, 4.0, 4.0), 0.75);
  EXPECT_DOUBLE_EQ(*closed_share(36.0, 1.0, 4.0, 4.0), 1.0) << "below a floor that was estimated too high";
  EXPECT_DOUBLE_EQ(*closed_share(36.0, 49.0, 4.0, 4.0), 0.0) << "worse than before";
  EXPECT_EQ(closed_share(4.0, 1.0, 4.0, 4.0), std::nullopt) << "no gap to close";
  EXPECT_EQ(closed_share(0.0, 0.0, 0.0, 0.0), std::nullopt);
}

TEST(Folds, HoldOutEachDriveOnceTogetherWithItsRepeats) {
  const std::vector<std::size_t> groups{0, 1, 2, 1, 3, 4, 5, 6, 0};
  std::vector<int> held_out(groups.size(), 0);
  for (int fold = 0; fold < 5; ++fold) {
    const std::vector<bool> learnt = learnt_from_in(groups, fold, 5);
    for (std::size_t d = 0; d < groups.size(); ++d) {
      held_out[d] += learnt[d] ? 0 : 1;
      for (std::size_t e = 0; e < d; ++e)
        if (groups[d] == groups[e]) {
          EXPECT_EQ(learnt[d], learnt[e]) << d << " repeats " << e;
        }
    }
  }
  EXPECT_EQ(held_out, std::vector<int>(groups.size(), 1));
}

HeldOutErrors errors_of(double retuned, double with) {
  HeldOutErrors e;
  e.retuned[kSlip] = retuned;
  e.with[kSlip] = with;
  e.floor[kSlip] = e.count[kSlip] = 1.0;
  return e;
}

TEST(HeldOutErrors, AddUpOverWindows) {
  HeldOutErrors sum = errors_of(4.0, 1.0);
  sum.log_gain = 0.5;
  sum.add(sum);
  EXPECT_EQ(sum.retuned[kSlip], 8.0);
  EXPECT_EQ(sum.with[kSlip], 2.0);
  EXPECT_EQ(sum.count[kSlip], 2.0);
  EXPECT_EQ(sum.log_gain, 1.0);
}

// Two groups; three resamples: the first twice, both, the second twice.
const std::vector<std::vector<std::size_t>> kResamples{{0, 0}, {0, 1}, {1, 1}};

TEST(Bootstrap, SumsTheDrawnGroups) {
  const std::vector<HeldOutErrors> errors{errors_of(4.0, 1.0), errors_of(16.0, 9.0)};
  const Bootstrapped reported = bootstrap_errors(errors, kResamples);
  EXPECT_EQ(reported.all.with[kSlip], 10.0) << "each group once";
  ASSERT_EQ(reported.resampled.size(), 3U);
  EXPECT_EQ(reported.resampled[0].with[kSlip], 2.0);
  EXPECT_EQ(reported.resampled[1].with[kSlip], 10.0);
  EXPECT_EQ(reported.resampled[2].with[kSlip], 18.0);
}

TEST(Bootstrap, OfGroupsThatAreAlikeHasNoWidth) {
  const std::vector<HeldOutErrors> errors{errors_of(9.0, 4.0), errors_of(9.0, 4.0)};
  const Bootstrapped sums = bootstrap_errors(errors, kResamples);
  const Interval rms =
      sums.interval([](const HeldOutErrors& e) { return std::sqrt(e.with[kSlip] / e.count[kSlip]); });
  EXPECT_DOUBLE_EQ(rms.low, 2.0);
  EXPECT_DOUBLE_EQ(rms.value, 2.0);
  EXPECT_DOUBLE_EQ(rms.high, 2.0);
}

TEST(Bootstrap, CountsAResampleWithoutAGapForBothEnds) {
  const std::vector<HeldOutErrors> errors{errors_of(1.0, 1.0), errors_of(25.0, 1.0)};
  const auto closed = [](const HeldOutErrors& e) {
    return closed_share(e.retuned[kSlip], e.with[kSlip], e.floor[kSlip], e.count[kSlip]);
  };
  const std::vector<std::vector<std::size_t>> only_the_first{{0, 0}, {0, 0}, {0, 0}};
  const auto interval = bootstrap_errors(errors, only_the_first).closed_interval(closed);
  ASSERT_TRUE(interval);
  EXPECT_DOUBLE_EQ(interval->value, 1.0);
  EXPECT_DOUBLE_EQ(interval->low, 0.0);
  EXPECT_DOUBLE_EQ(interval->high, 1.0);
  const std::vector<HeldOutErrors> no_gap{errors_of(1.0, 1.0), errors_of(1.0, 1.0)};
  EXPECT_FALSE(bootstrap_errors(no_gap, kResamples).closed_interval(closed));
}

DriveSlip drive(double measured, double nominal, double retuned, double corrected) {
  return {2.0 * measured, 2.0, {2.0 * nominal, 2.0 * retuned, 2.0 * corrected}};
}

TEST(RankPairs, CountsPairsOfWhichOneClearlySlippedMore) {
  // Measured 0.1, 0.3, 0.32 and a drive without windows: of three pairs one is too near.
  const std::vector<DriveSlip> drives{drive(0.1, 0.5, 0.2, 0.1), drive(0.3, 0.4, 0.1, 0.2),
                                      drive(0.32, 0.6, 0.3, 0.3), DriveSlip{}};
  const RankedPairs ranked = rank_pairs(drives, 0.05);
  EXPECT_EQ(ranked.pairs, 2U);
  EXPECT_EQ(ranked.in_order[0], 1.0);
  EXPECT_EQ(ranked.in_order[1], 1.0);
  EXPECT_EQ(ranked.in_order[2], 2.0);
}

TEST(Extrapolation, PredictsTheHarshestThirdWhereDrivesDiffer) {
  const ExtrapolationOptions options;
  std::vector<double> harshness;
  for (int i = 0; i <= 12; ++i) harshness.push_back(i);
  EXPECT_NEAR(*harsh_from(harshness, 5.0, options), 8.0, 1e-12) << "the quantile 2/3 of 0 to 12";
  EXPECT_EQ(harsh_from(harshness, 12.5, options), std::nullopt) << "they differ by less";
  harshness.resize(11);
  EXPECT_EQ(harsh_from(harshness, 5.0, options), std::nullopt) << "too few groups for a third of four";
  harshness.push_back(11.0);
  harshness.push_back(std::numeric_limits<double>::quiet_NaN());
  EXPECT_TRUE(harsh_from(harshness, 5.0, options)) << "twelve that have a number";
}

TEST(Extrapolation, HasTheStandardErrorOfTheMean) {
  const MeanGain gain = mean_gain(std::vector<double>{1.0, 3.0, 5.0, 7.0});
  EXPECT_DOUBLE_EQ(gain.mean, 4.0);
  EXPECT_DOUBLE_EQ(gain.error, std::sqrt(20.0 / 3.0 / 4.0));
}

}  // namespace
}  // namespace slipway::gap
