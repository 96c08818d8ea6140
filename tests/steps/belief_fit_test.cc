#include "steps/belief_fit.h"

#include <gtest/gtest.h>

#include "core/angle.h"
#include "core/random.h"
#include "six_wheels.h"

namespace slipway::steps {
namespace {

// Ways over two soils of the wheel law, one of them loose in runs of eight steps, with an odometry that
// counts 2.5 % too much.
std::vector<std::vector<ChainStep>> made_ways() {
  sim::RoverModel rover = six_wheels();
  for (sim::WheelModel& wheel : rover.wheels) wheel.software_radius_m = 1.0 / 0.975 * wheel.radius_m;
  sim::Soil firm, loose;
  firm.pressure = {0.0, 4e6, 1.0};
  firm.cohesion_pa = 500.0;
  firm.friction_angle_rad = rad_from_deg(32.0);
  firm.shear_modulus_x_m = firm.shear_modulus_y_m = 0.008;
  firm.c1 = 0.18;
  firm.c2 = 0.32;
  loose = firm;
  loose.friction_angle_rad = rad_from_deg(26.0);
  loose.shear_modulus_x_m = loose.shear_modulus_y_m = 0.045;
  const PlaneSlips on_firm(rover, 3.71, firm), on_loose(rover, 3.71, loose);
  std::vector<std::vector<ChainStep>> ways;
  for (std::uint64_t s = 0; s < 40; ++s) {
    auto& way = ways.emplace_back();
    for (std::uint64_t t = 0; t < 40; ++t) {
      ChainStep step{.pitch_rad = rad_from_deg(-6.0 + 14.0 * random_uniform(s, t))};
      const bool is_loose = s % 5 == 0 && t >= 20 && t < 28;
      step.slip = (is_loose ? on_loose : on_firm).at(step.pitch_rad, 0.0) +
                  0.015 * random_normal(random_key(s, 1), t);
      way.push_back(step);
    }
  }
  return ways;
}

TEST(BeliefFit, FindsTheShareOfLooseGroundTheOffsetAndTheSlips) {
  BeliefFitOptions options{.candidates = 500, .on_units = 6, .in_patches = 4, .resamples = 10};
  NoProgress progress;
  const auto ways = made_ways();
  const auto fit = fit_belief(six_wheels(), 3.71, ways, {}, options, progress);
  ASSERT_TRUE(fit) << fit.error().detail;
  EXPECT_EQ(fit->steps, 1600U);
  EXPECT_NEAR(fit->odometry_offset.value, 0.025, 0.01);
  double loose = 0.0, all = 0.0, slip_at_8_deg = 0.0, firm = 0.0;
  for (const FittedSoil& soil : fit->soils) {
    all += soil.share.value;
    EXPECT_LE(soil.share.low, soil.share.high);
    if (soil.in_patches) loose += soil.share.value;
    if (soil.in_patches) continue;
    slip_at_8_deg += soil.share.value * soil.slip_at_8_deg;
    firm += soil.share.value;
  }
  EXPECT_NEAR(all, 1.0, 1e-9);
  EXPECT_NEAR(loose, 64.0 / 1600.0, 0.015);
  EXPECT_GT(slip_at_8_deg / firm, 0.03);
  EXPECT_LT(slip_at_8_deg / firm, 0.12);
  EXPECT_LE(fit->soils.size(), 10U);

  const auto soils = as_soils(*fit, options, "a test");
  ASSERT_EQ(soils.size(), fit->soils.size() + 1);
  const sim::SoilDistribution& belief = soils.back();
  EXPECT_EQ(belief.name, "unknown_ground");
  EXPECT_EQ(belief.alternatives_by, sim::AlternativesBy::kUnit);
  EXPECT_FALSE(belief.drawn_apart);
}

TEST(BeliefFit, GivesTheSameSoilsTwiceAndOnAnyNumberOfThreads) {
  BeliefFitOptions options{.candidates = 200, .on_units = 4, .in_patches = 2, .resamples = 4, .threads = 1};
  NoProgress progress;
  const auto ways = made_ways();
  const auto one = fit_belief(six_wheels(), 3.71, ways, {}, options, progress);
  options.threads = 2;
  const auto other = fit_belief(six_wheels(), 3.71, ways, {}, options, progress);
  ASSERT_TRUE(one && other);
  ASSERT_EQ(one->soils.size(), other->soils.size());
  for (std::size_t k = 0; k < one->soils.size(); ++k) {
    EXPECT_EQ(one->soils[k].share.value, other->soils[k].share.value);
    EXPECT_EQ(one->soils[k].share.low, other->soils[k].share.low);
  }
}

TEST(BeliefFit, RefusesATableWithoutSteps) {
  NoProgress progress;
  const auto fit = fit_belief(six_wheels(), 3.71, {}, {}, {}, progress);
  ASSERT_FALSE(fit);
  EXPECT_EQ(fit.error().code, ErrorCode::kInvalidRequest);
}

}  // namespace
}  // namespace slipway::steps
