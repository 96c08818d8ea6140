#include "research/validation/cuadriga/log_scatter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "core/angle.h"
#include "core/random.h"

namespace slipway::validation {
namespace {

// Logs of different lengths with a level of their own and normal scatter within, both 1 + growth (g / 10
// deg)^2 as large on a gradient g.
std::vector<LogResidual> drives(int logs, double between, double within, double growth, std::uint64_t seed) {
  std::vector<LogResidual> residuals;
  for (int l = 0; l < logs; ++l) {
    const auto log = static_cast<std::uint64_t>(l);
    const double level = between * random_normal(seed, log);
    for (std::uint64_t k = 0; k < 10 + 5 * (log % 7); ++k) {
      const std::uint64_t key = random_key(seed + 1, log);
      const double tens = 3.0 * random_uniform(key, 2 * k) - 1.5;
      const double z = level + within * random_normal(key, 2 * k + 1);
      residuals.push_back(
          {"log " + std::to_string(l), rad_from_deg(10.0 * tens), (1.0 + growth * tens * tens) * z});
    }
  }
  return residuals;
}

TEST(FoldsByLog, NoLogIsInTwoFoldsAndNoFoldIsEmpty) {
  std::vector<std::string> logs;
  for (int l = 0; l < 24; ++l)
    for (int k = 0; k < 1 + l * l % 17; ++k) logs.push_back("log " + std::to_string(l));
  const std::vector<int> folds = folds_by_log(logs, 5);
  ASSERT_EQ(folds.size(), logs.size());
  std::map<std::string, std::set<int>> folds_of;
  std::map<int, int> filled;
  for (std::size_t k = 0; k < logs.size(); ++k) {
    folds_of[logs[k]].insert(folds[k]);
    ++filled[folds[k]];
  }
  for (const auto& [log, its] : folds_of) EXPECT_EQ(its.size(), 1U) << log;
  ASSERT_EQ(filled.size(), 5U);
  const auto [least, most] = std::minmax_element(
      filled.begin(), filled.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  EXPECT_LE(most->second - least->second, 17) << "folds differ by no more than the longest log";
}

TEST(MeasureScatter, FindsTheTrueStandardDeviationsAndGrowth) {
  const LogScatter scatter = measure_scatter(drives(300, 0.6, 0.8, 0.5, 11));
  EXPECT_NEAR(scatter.between, 0.6, 0.06);
  EXPECT_NEAR(scatter.within, 0.8, 0.04);
  EXPECT_NEAR(scatter.growth, 0.5, 0.11);
  EXPECT_NEAR(scatter.share_between(), 0.36, 0.06);
  EXPECT_NEAR(scatter.quantiles[4], 1.645, 0.15) << "of a normal distribution with standard deviation 1";
  EXPECT_NEAR(scatter.quantiles[0], -1.645, 0.15);
}

TEST(MeasureScatter, DrivesWithoutALevelOfTheirOwnHaveNoScatterBetween) {
  EXPECT_LT(measure_scatter(drives(300, 0.0, 1.0, 0.0, 5)).between, 0.12);
}

TEST(PredictiveIntervals, HoldTheirShareOfHeldOutDrives) {
  const LogScatter scatter = measure_scatter(drives(200, 0.6, 0.8, 0.5, 21));
  const std::vector<LogResidual> unseen = drives(200, 0.6, 0.8, 0.5, 22);
  std::vector<std::string> logs;
  std::vector<bool> in_50, in_90;
  for (const LogResidual& r : unseen) {
    const PredictiveOffsets o = offsets_at(scatter, r.gradient_rad, 0.0);
    logs.push_back(r.log);
    in_50.push_back(r.value >= o.low_50 && r.value <= o.high_50);
    in_90.push_back(r.value >= o.low_90 && r.value <= o.high_90);
  }
  EXPECT_NEAR(coverage_of(logs, in_50).of_windows, 0.5, 0.04);
  EXPECT_NEAR(coverage_of(logs, in_90).of_windows, 0.9, 0.03);
}

TEST(PredictiveIntervals, AreWiderByTheParametersUncertainty) {
  const LogScatter scatter = measure_scatter(drives(50, 0.6, 0.8, 0.0, 3));
  const PredictiveOffsets known = offsets_at(scatter, 0.1, 0.0);
  const PredictiveOffsets unsure = offsets_at(scatter, 0.1, std::sqrt(3.0) * scatter.std_at(0.1));
  EXPECT_NEAR(unsure.high_90 - unsure.low_90, 2.0 * (known.high_90 - known.low_90), 1e-9);
  EXPECT_EQ(unsure.median, known.median);
}

TEST(WeightsByLog, ALogOfEqualWindowsCountsAsOneWindow) {
  const std::vector<std::string> logs{"a", "a", "a", "a", "b"};
  const std::vector<double> alike = weights_by_log(logs, 1.0), apart = weights_by_log(logs, 0.0);
  EXPECT_DOUBLE_EQ(alike[0], 0.25);
  EXPECT_DOUBLE_EQ(alike[4], 1.0);
  EXPECT_DOUBLE_EQ(apart[0], 1.0);
}

TEST(CoverageOf, CountsWindowsAndLogsSeparately) {
  const Coverage coverage = coverage_of({"a", "a", "a", "b"}, {true, true, true, false});
  EXPECT_DOUBLE_EQ(coverage.of_windows, 0.75);
  EXPECT_DOUBLE_EQ(coverage.mean_over_logs, 0.5);
  EXPECT_DOUBLE_EQ(coverage.lowest_of_a_log, 0.0);
}

}  // namespace
}  // namespace slipway::validation
