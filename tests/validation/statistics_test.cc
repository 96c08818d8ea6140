#include "validation/report/statistics.h"

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

}  // namespace
}  // namespace slipway::validation
