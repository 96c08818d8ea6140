#include "gap/estimate/soil_estimation.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "soil_tests.h"

namespace slipway::gap {
namespace {

void print(const char* title, const SoilEstimate& e, const sim::Soil& truth) {
  fmt::print("{}: {} evaluations, variance {:.3g}, {}\n", title, e.evaluations, e.residual_variance,
             e.converged ? "converged" : "not converged");
  for (const EstimatedParameter& p : e.parameters)
    fmt::print("  {:+.2f} %  {}\n", 100.0 * off(e, *p.parameter.soil, truth), p.words);
  for (const OpenDirection& open : e.open) fmt::print("  open: {} ({:.2f})\n", open.words, open.share);
}

constexpr SoilParameter kSaid[] = {SoilParameter::kBekker, SoilParameter::kN, SoilParameter::kFrictionAngle,
                                   SoilParameter::kShearModulus};

TEST(EstimateSoil, From49PercentOffTheTruthIsFoundWithoutNoise) {
  const sim::Soil truth = dry_sand();
  for (const double sign : {1.0, -1.0}) {
    const auto e = estimate(start_49_percent_off(truth, sign), made_wheel_tests(truth, {}));
    ASSERT_TRUE(e) << e.error().detail;
    print("without noise", *e, truth);
    for (const SoilParameter p : kSaid) {
      EXPECT_LT(std::abs(off(*e, p, truth)), 0.03) << row_of(p).name;
      EXPECT_EQ(of(*e, p).determination, Determination::kDetermined) << row_of(p).name;
    }
  }
}

TEST(EstimateSoil, WithTwoPercentNoiseItStaysWithinTenPercentAndSaysThatDrySandHidesItsCohesion) {
  const sim::Soil truth = dry_sand();
  int covered = 0, intervals = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const auto data = made_wheel_tests(truth, {.noise = 0.02, .seed = seed});
    const auto e = estimate(start_49_percent_off(truth, seed % 2 == 0 ? 1.0 : -1.0), data);
    ASSERT_TRUE(e) << e.error().detail;
    print("2 % noise", *e, truth);
    for (const SoilParameter p : kSaid)
      EXPECT_LT(std::abs(off(*e, p, truth)), 0.10) << row_of(p).name << ", seed " << seed;
    EXPECT_NE(of(*e, SoilParameter::kCohesion).determination, Determination::kDetermined) << seed;
    for (const EstimatedParameter& p : e->parameters) {
      const double value = value_of(*p.parameter.soil, truth, e->width_m);
      ++intervals;
      covered += value >= p.low && value <= p.high ? 1 : 0;
    }
  }
  fmt::print("covered {} of {}\n", covered, intervals);
  EXPECT_GE(covered, intervals * 8 / 10);
}

}  // namespace
}  // namespace slipway::gap
