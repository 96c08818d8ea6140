// Telemetry of a drive under way as evidence of the ground, and what a scout drive would be worth.
#include "sim/prediction/telemetry.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "core/angle.h"
#include "sim/prediction/scout_drive.h"
#include "tests/sim/reference_models.h"

namespace slipway::sim {
namespace {

const RoverModel kRover = six_wheeler();

std::vector<PathStation> straight(double length_m, double from_m = 0.0, double yaw_rad = 0.0) {
  std::vector<PathStation> path;
  const int pieces = static_cast<int>(std::ceil(length_m / 0.25));
  for (int k = 0; k <= pieces; ++k) {
    const double s = length_m * k / pieces;
    path.push_back({.pose = {(from_m + s) * std::cos(yaw_rad), (from_m + s) * std::sin(yaw_rad), yaw_rad},
                    .distance_m = s});
  }
  return path;
}

FunctionGround slope(double deg, double toward_rad = 0.0) {
  const double rise = std::tan(rad_from_deg(deg));
  return FunctionGround([rise, toward_rad](double x, double y) {
    return rise * (x * std::cos(toward_rad) + y * std::sin(toward_rad));
  });
}

// Ground that is loam everywhere or sand everywhere.
SoilBeliefs either(double sand_weight) {
  SoilDistribution ground = certain("either", sandy_loam());
  ground.alternatives = {
      {"loam", std::make_shared<SoilDistribution>(certain("loam", sandy_loam())), 1.0 - sand_weight,
       1.0 - sand_weight},
      {"sand", std::make_shared<SoilDistribution>(certain("sand", loose_sand())), sand_weight, sand_weight}};
  ground.drawn_apart = false;
  return {{ground}, certain("unknown_ground", sandy_loam())};
}

double slip_on(const Ground& ground, const Soil& soil, const std::vector<PathStation>& path) {
  NoProgress progress;
  const SoilBeliefs sure{{certain("sure", soil)}, certain("unknown_ground", soil)};
  const auto drive = predict_drive(kRover, 3.71, ground, sure, path, {}, {.draws = 0}, 1, progress);
  EXPECT_TRUE(drive);
  double come_m = 0.0, rolled_m = 0.0;
  for (std::size_t k = 1; k < drive->stations.size(); ++k) {
    const double way_m = path[k].distance_m - path[k - 1].distance_m;
    come_m += way_m;
    rolled_m += way_m / (1.0 - drive->stations[k].state.slip_ratio);
  }
  return 1.0 - come_m / rolled_m;
}

MeasuredStretch measured(double slip, double come_m) {
  return {.rolled_m = come_m / (1.0 - slip), .come_m = come_m, .current_a = {}, .wheel_currents_a = {}};
}

std::vector<ConditionedDraw> conditioned(const Ground& ground, const SoilBeliefs& beliefs,
                                         const std::vector<PathStation>& path, const MeasuredStretch& stretch,
                                         int count, int tries = 1) {
  NoProgress progress;
  std::vector<ConditionedDraw> draws(static_cast<std::size_t>(count));
  const auto done = condition_on_stretch(kRover, 3.71, ground, beliefs, path, stretch, {}, {.draws = count},
                                         tries, 2, progress, draws);
  EXPECT_TRUE(done);
  return draws;
}

double normal_density(double deviation, double sd) {
  return std::exp(-0.5 * deviation * deviation / (sd * sd)) / (sd * std::sqrt(2.0 * std::numbers::pi));
}

// Two soils, one stretch: each draw has one of two weights, and the share of the sand is Bayes' rule.
TEST(Telemetry, TwoSoilsAreWeighedByBayesRuleByHand) {
  const FunctionGround ground = slope(8.0);
  const auto path = straight(4.0);
  const double loam = slip_on(ground, sandy_loam(), path), sand = slip_on(ground, loose_sand(), path);
  ASSERT_GT(sand, loam + 0.1);
  const MeasuredStretch stretch = measured(loam + 0.5 * (sand - loam) - 0.02, 4.0);
  const auto by_hand = [&](double slip) {
    // Two positions of 5 cm over the way that the wheels roll, and 2 % of slip that no model knows; no
    // slip_error.
    const double sd = std::sqrt(2.0 * std::pow(0.05 / stretch.rolled_m, 2) + 0.02 * 0.02);
    return 0.95 * normal_density(stretch.slip_ratio() - slip, sd) + 0.05;
  };
  const auto draws = conditioned(ground, either(0.3), path, stretch, 300);
  double of_sand = 0.0, all = 0.0;
  int sandy = 0;
  for (const ConditionedDraw& draw : draws) {
    const bool is_sand = std::abs(draw.weight - by_hand(sand)) < std::abs(draw.weight - by_hand(loam));
    EXPECT_NEAR(draw.weight, by_hand(is_sand ? sand : loam), 0.02 * draw.weight);
    sandy += is_sand ? 1 : 0;
    of_sand += is_sand ? draw.weight : 0.0;
    all += draw.weight;
  }
  EXPECT_NEAR(sandy / 300.0, 0.3, 0.08);
  const double prior = sandy / 300.0;
  const double posterior = prior * by_hand(sand) / (prior * by_hand(sand) + (1.0 - prior) * by_hand(loam));
  EXPECT_NEAR(of_sand / all, posterior, 0.01);
}

TEST(Telemetry, ALikelihoodKnowsCurrentsNoiseAndThatAModelMayBeWrong) {
  const MeasuredStretch still = measured(0.2, 4.0);
  const DrawnStretch same{.slip_ratio = 0.2, .currents_a = {1.0, 1.0}, .slip_error = 0.0};
  const DrawnStretch other{.slip_ratio = 0.6, .currents_a = {1.0, 1.0}, .slip_error = 0.0};
  EXPECT_GT(likelihood(still, same, {}), 50.0 * likelihood(still, other, {}));
  EXPECT_NEAR(likelihood(still, other, {}), 0.05, 1e-6) << "a rock that no draw knows";
  // A place less well known tells less.
  EXPECT_LT(likelihood(still, same, {.position_m = 1.0}), 0.2 * likelihood(still, same, {}));
  // The ground's own error of slip widens the density.
  DrawnStretch rippled = same;
  rippled.slip_error = 0.5;
  EXPECT_LT(likelihood(still, rippled, {}), likelihood(still, same, {}));
  MeasuredStretch with_current = still;
  with_current.current_a = 2.0;
  const double right = likelihood(with_current, same, {});
  with_current.current_a = 5.0;
  EXPECT_GT(right, 10.0 * likelihood(with_current, same, {}));
  MeasuredStretch by_wheel = still;
  by_wheel.wheel_currents_a = {1.0, std::nullopt};
  EXPECT_GT(likelihood(by_wheel, same, {}), likelihood(still, same, {}));
}

// What is shared by all ground of a soil is learnt from its first metres.
TEST(Telemetry, MuchSlipBehindRaisesTheRiskAheadAndLittleSlipLowersIt) {
  const FunctionGround ground = slope(8.0);
  const SoilBeliefs beliefs = either(0.1);
  const auto ahead = straight(20.0, 4.0);
  const DriveLimits limits{.max_slip_ratio = 0.3};
  const auto predicted = [&](const std::optional<MeasuredStretch>& stretch) {
    RiskOptions risk{.draws = 300};
    if (stretch)
      risk.conditioned = std::make_shared<const std::vector<ConditionedDraw>>(
          conditioned(ground, beliefs, straight(4.0), *stretch, 300));
    NoProgress progress;
    return predict_drive(kRover, 3.71, ground, beliefs, ahead, limits, risk, 0, progress).value().outcomes;
  };
  const double loam = slip_on(ground, sandy_loam(), straight(4.0));
  const double sand = slip_on(ground, loose_sand(), straight(4.0));
  ASSERT_GT(sand, 0.35);
  const DriveOutcomes before = predicted(std::nullopt), slipped = predicted(measured(sand, 4.0)),
                      held = predicted(measured(loam, 4.0));
  ASSERT_GT(before.stop.share, 0.05);
  EXPECT_LT(before.stop.share, 0.2);
  EXPECT_GT(slipped.stop.share, 0.9);
  EXPECT_LT(held.stop.share, 0.5 * before.stop.share);
}

TEST(Telemetry, ATurnedAndMovedMapGivesTheSameWeights) {
  const SoilBeliefs beliefs = either(0.3);
  const double turn_rad = rad_from_deg(90.0);
  const FunctionGround ground = slope(8.0), turned = slope(8.0, turn_rad);
  const MeasuredStretch stretch = measured(0.3, 4.0);
  const auto here = conditioned(ground, beliefs, straight(4.0), stretch, 40);
  const auto there = conditioned(turned, beliefs, straight(4.0, 0.0, turn_rad), stretch, 40);
  const auto moved = conditioned(ground, beliefs, straight(4.0, 1000.0), stretch, 40);
  for (std::size_t d = 0; d < here.size(); ++d) {
    EXPECT_NEAR(there[d].weight, here[d].weight, 1e-3 * here[d].weight);
    EXPECT_NEAR(moved[d].weight, here[d].weight, 1e-3 * here[d].weight);
  }
}

// A patch is learnt by redrawing it, while the draw keeps its other ground.
TEST(Telemetry, TriesFindAPatchThatFitsWhatIsMeasured) {
  const FunctionGround ground = slope(8.0);
  SoilBeliefs beliefs = either(0.2);
  beliefs.known.front().alternatives_by = AlternativesBy::kPatch;
  beliefs.known.front().correlation_length_m = 10.0;
  const double sand = slip_on(ground, loose_sand(), straight(4.0));
  NoProgress progress;
  const auto stop_again = [&](int tries) {
    RiskOptions risk{.draws = 200};
    auto draws = conditioned(ground, beliefs, straight(4.0), measured(sand, 4.0), 200, tries);
    double sum = 0.0, squares = 0.0;
    for (const ConditionedDraw& draw : draws) {
      sum += draw.weight;
      squares += draw.weight * draw.weight;
    }
    risk.conditioned = std::make_shared<const std::vector<ConditionedDraw>>(std::move(draws));
    const auto drive = predict_drive(kRover, 3.71, ground, beliefs, straight(4.0), {.max_slip_ratio = 0.3},
                                     risk, 0, progress);
    return std::pair(drive->outcomes.stop.share, sum * sum / squares);
  };
  const auto [once, effective_once] = stop_again(1);
  const auto [often, effective_often] = stop_again(8);
  EXPECT_GT(once, 0.8);
  EXPECT_GT(often, 0.8);
  EXPECT_GT(effective_often, 1.5 * effective_once) << "more draws fit when their patch is drawn again";
}

// Ground that is firm or loose everywhere, where a few metres tell which.
TEST(Scout, IsWorthMostWhereTheBeliefIsDividedAndTheDriveHangsOnIt) {
  const FunctionGround ground = slope(8.0);
  const auto scout_for = [&](double sand_weight) {
    NoProgress progress;
    return predict_drive(kRover, 3.71, ground, either(sand_weight), straight(30.0), {.max_slip_ratio = 0.3},
                         {.draws = 400}, 0, progress)
        .value()
        .scout;
  };
  const auto divided = scout_for(0.3);
  ASSERT_TRUE(divided);
  EXPECT_NEAR(divided->to_m - divided->from_m, kScoutLength_m, 0.3);
  // By hand: turning back costs 0.5, a drive over loam nothing, one over sand the sol that it halts on; so
  // not knowing costs 0.3. Known, 70 % of the drives are taken and cost nothing, 30 % are not and cost 0.5,
  // but for the model's error of 5 %.
  EXPECT_NEAR(divided->worth_sols, 0.3 - 0.5 * 0.3, 0.03);
  EXPECT_NEAR(divided->go, 0.7, 0.1);
  EXPECT_NEAR(divided->no_go, 0.3, 0.1);
  EXPECT_GT(divided->slip_ratio.p95, divided->slip_ratio.p05 + 0.1);
  // Where all is loose nothing is learnt, and where nothing goes wrong nothing decides.
  const auto sure = scout_for(1.0);
  ASSERT_TRUE(sure);
  EXPECT_LT(sure->worth_sols, 1e-9);
  EXPECT_FALSE(scout_for(0.0));
}

TEST(Scout, WhatItMayMeasureIsAProbabilityAndNarrowerOnALongerScout) {
  const auto spread_of_shares = [](double length_m) {
    const auto shares = measured_shares(0.4, 0.0, length_m);
    EXPECT_NEAR(std::accumulate(shares.begin(), shares.end(), 0.0), 1.0, 1e-12);
    return *std::max_element(shares.begin(), shares.end());
  };
  EXPECT_GT(spread_of_shares(5.0), spread_of_shares(1.0));
}

}  // namespace
}  // namespace slipway::sim
