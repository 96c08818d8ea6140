#include "research/validation/report/statistics.h"

#include <gtest/gtest.h>

#include "core/random.h"

namespace slipway::validation {
namespace {

TEST(Median, IsTheMiddleOrTheMeanOfTheTwoInTheMiddle) {
  EXPECT_EQ(median({3.0, 1.0, 2.0}), 2.0);
  EXPECT_EQ(median({4.0, 1.0, 3.0, 2.0}), 2.5);
  EXPECT_EQ(median_abs({-4.0, 1.0, 2.0}), 2.0);
  EXPECT_EQ(median_abs({}), 0.0);
}

TEST(Quantile, LiesOnTheLineBetweenOrderStatistics) {
  EXPECT_EQ(quantile({10.0, 0.0}, 0.25), 2.5);
  EXPECT_EQ(quantile({1.0, 2.0, 3.0}, 1.0), 3.0);
  EXPECT_EQ(quantile({7.0}, 0.3), 7.0);
}

TEST(AgreementOf, AShiftIsBiasAndNotLackOfCorrelation) {
  const Agreement a = agreement({2.0, 3.0, 4.0}, {1.0, 2.0, 3.0});
  EXPECT_NEAR(a.r, 1.0, 1e-12);
  EXPECT_NEAR(a.rms, 1.0, 1e-12);
  EXPECT_NEAR(a.bias, 1.0, 1e-12);
  EXPECT_NEAR(agreement({3.0, 2.0, 1.0}, {1.0, 2.0, 3.0}).r, -1.0, 1e-12);
}

TEST(MedianIntervalByGroup, GroupsThatDifferMakeItWiderThanTheirSamplesWould) {
  // Eight drives of forty windows: each drive has its own level, its windows are nearly alike.
  std::vector<std::vector<double>> drives, samples;
  for (std::uint64_t d = 0; d < 8; ++d) {
    drives.emplace_back();
    for (std::uint64_t k = 0; k < 40; ++k) {
      drives.back().push_back(random_normal(3, d) + 0.01 * random_normal(random_key(4, d), k));
      samples.push_back({drives.back().back()});
    }
  }
  const Interval by_drive = median_interval_by_group(drives, 0.95, 1000, 7);
  const Interval by_sample = median_interval_by_group(samples, 0.95, 1000, 7);
  EXPECT_GT(by_drive.high - by_drive.low, 2.0 * (by_sample.high - by_sample.low));
  std::vector<double> all;
  for (const auto& drive : drives) all.insert(all.end(), drive.begin(), drive.end());
  EXPECT_LE(by_drive.low, median(all));
  EXPECT_GE(by_drive.high, median(all));
  EXPECT_EQ(median_interval_by_group(drives, 0.95, 1000, 7).low, by_drive.low);
}

// Of two values a resample has the mean 0, 1/2 or 1 with probabilities 1/4, 1/2 and 1/4.
TEST(MeanInterval, OfTwoValuesIsAsByHand) {
  const std::vector<double> differences{0.0, 1.0};
  const Interval wide = mean_interval(differences, 0.9, 4000, 1),
                 narrow = mean_interval(differences, 0.4, 4000, 1);
  EXPECT_EQ(wide.low, 0.0);
  EXPECT_EQ(wide.high, 1.0);
  EXPECT_EQ(narrow.low, 0.5);
  EXPECT_EQ(narrow.high, 0.5);
}

// Pairs that differ by the same leave nothing open, however far the pairs are from each other.
TEST(MeanInterval, OfPairsThatDifferByTheSameHasNoWidth) {
  const std::vector<double> first{3.0, 100.0, -7.0}, other{5.0, 102.0, -5.0};
  std::vector<double> differences;
  for (std::size_t k = 0; k < first.size(); ++k) differences.push_back(other[k] - first[k]);
  const Interval interval = mean_interval(differences, 0.9, 100, 1);
  EXPECT_EQ(interval.low, 2.0);
  EXPECT_EQ(interval.high, 2.0);
}

TEST(BootstrapInterval, OfARatioOfSumsResamplesPairs) {
  const std::vector<double> first{1.0, 2.0, 10.0}, other{2.0, 4.0, 20.0};
  const auto ratio = [&](std::span<const std::size_t> drawn) {
    double a = 0.0, b = 0.0;
    for (const std::size_t k : drawn) {
      a += first[k];
      b += other[k];
    }
    return b / a;
  };
  const Interval interval = bootstrap_interval(first.size(), ratio, 0.9, 200, 2);
  EXPECT_EQ(interval.low, 2.0);
  EXPECT_EQ(interval.high, 2.0);
}

}  // namespace
}  // namespace slipway::validation
