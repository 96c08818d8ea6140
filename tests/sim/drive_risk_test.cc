// Risk over draws of the ground: the properties that a decision leans on.
#include "sim/prediction/drive_risk.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/angle.h"
#include "core/random.h"
#include "tests/sim/reference_models.h"

namespace slipway::sim {
namespace {

const RoverModel kRover = six_wheeler();
const SoilBeliefs kSure{{certain("loam", sandy_loam())}, certain("unknown_ground", sandy_loam())};
const SoilBeliefs kUnsure{{spread("loam", sandy_loam(), 0.4)}, spread("unknown_ground", loose_sand(), 0.5)};
const FunctionGround kHills([](double x, double y) { return 0.2 * std::sin(0.7 * x) * std::cos(0.5 * y); });

FunctionGround slope(double deg) {
  const double rise = std::tan(rad_from_deg(deg));
  return FunctionGround([rise](double x, double) { return rise * x; });
}

void add_drive(std::vector<PathStation>& path, double length_m) {
  const Pose2 from = path.back().pose;
  const double before = path.back().distance_m;
  const int pieces = static_cast<int>(std::ceil(length_m / 0.25 - 1e-9));
  for (int k = 1; k <= pieces; ++k) {
    const double s = length_m * k / pieces;
    path.push_back(
        {.pose = {from.x_m + s * std::cos(from.yaw_rad), from.y_m + s * std::sin(from.yaw_rad), from.yaw_rad},
         .distance_m = before + s});
  }
}

void add_turn(std::vector<PathStation>& path, double turn_deg) {
  const int pieces = static_cast<int>(std::ceil(std::abs(turn_deg) / 15.0));
  for (int k = 0; k < pieces; ++k) {
    PathStation next = path.back();
    next.turned_rad = rad_from_deg(turn_deg / pieces);
    next.pose.yaw_rad += next.turned_rad;
    next.turning_in_place = true;
    path.push_back(next);
  }
}

std::vector<PathStation> straight(double length_m) {
  std::vector<PathStation> path(1);
  add_drive(path, length_m);
  return path;
}

std::vector<PathStation> zigzag() {
  std::vector<PathStation> path(1);
  for (int k = 0; k < 6; ++k) {
    add_drive(path, 4.1);
    add_turn(path, k % 2 == 0 ? 80.0 : -80.0);
  }
  return path;
}

DrivePrediction predict(const Ground& ground, const SoilBeliefs& beliefs,
                        const std::vector<PathStation>& path, const RiskOptions& risk = {},
                        const DriveLimits& limits = {}) {
  NoProgress progress;
  auto drive = predict_drive(kRover, 3.71, ground, beliefs, path, limits, risk, 0, progress);
  EXPECT_TRUE(drive);
  return std::move(drive).value();
}

TEST(DriveRisk, WithoutSpreadEveryPercentileIsTheMeanAlsoWhereTheRoverTurns) {
  const DrivePrediction drive = predict(kHills, kSure, zigzag(), {.draws = 5});
  EXPECT_NEAR(drive.duration_s_p95, drive.duration_s, 1e-6 * drive.duration_s);
  EXPECT_NEAR(drive.energy_j_p95, drive.energy_j, 1e-6 * drive.energy_j);
  EXPECT_NEAR(drive.mean_slip_ratio_p05, drive.mean_slip_ratio, 1e-6);
  EXPECT_NEAR(drive.mean_slip_ratio_p50, drive.mean_slip_ratio, 1e-6);
  EXPECT_NEAR(drive.mean_slip_ratio_p95, drive.mean_slip_ratio, 1e-6);
  for (const StationPrediction& s : drive.stations) {
    EXPECT_NEAR(s.slip_ratio_p05, s.state.slip_ratio, 1e-5);
    EXPECT_NEAR(s.slip_ratio_p50, s.state.slip_ratio, 1e-5);
    EXPECT_NEAR(s.slip_ratio_p95, s.state.slip_ratio, 1e-5);
    EXPECT_NEAR(s.current_a_p95, largest_current_a(s.state), 1e-5);
    EXPECT_NEAR(s.sinkage_m_p95, deepest_sinkage_m(s.state), 1e-5);
  }
}

// The quantiles of the mean slip are those of the draws' own means, which drawn_outcomes() gives one by one.
TEST(DriveRisk, QuantilesOfTheMeanSlipAreOfTheDrawsMeans) {
  const RiskOptions risk{.draws = 21, .seed = 5};
  const DrivePrediction drive = predict(kHills, kUnsure, zigzag(), risk);
  NoProgress progress;
  const auto drawn = drawn_outcomes(kRover, 3.71, kHills, kUnsure, zigzag(), {}, risk, 0, progress);
  ASSERT_TRUE(drawn);
  std::vector<double> slips;
  for (const DrawnOutcome& each : *drawn) {
    if (each.immobilised) {
      EXPECT_LT(each.driven_m, drive.length_m);
    } else {
      EXPECT_NEAR(each.driven_m, drive.length_m, 1e-9);
    }
    slips.push_back(each.mean_slip_ratio());
  }
  std::sort(slips.begin(), slips.end());
  EXPECT_NEAR(drive.mean_slip_ratio_p05, slips[1], 1e-12);
  EXPECT_NEAR(drive.mean_slip_ratio_p50, slips[10], 1e-12);
  EXPECT_NEAR(drive.mean_slip_ratio_p95, slips[19], 1e-12);
  EXPECT_LT(drive.mean_slip_ratio_p05, drive.mean_slip_ratio_p95);
}

TEST(DriveRisk, AP95OfAZigzagIsNotBelowItsMedian) {
  const DrivePrediction drive = predict(kHills, kUnsure, zigzag(), {.draws = 48});
  EXPECT_GE(drive.duration_s_p95, 0.95 * drive.duration_s);
  for (const StationPrediction& s : drive.stations) {
    EXPECT_GE(s.slip_ratio_p95, s.slip_ratio_p50);
    EXPECT_GE(s.slip_ratio_p50, s.slip_ratio_p05);
  }
}

// A map that may be wrong: the tilt of a level drive has an interval, and trips its rule in some draws.
TEST(DriveRisk, ADrawnReliefGivesTiltAndClearanceAnInterval) {
  const FunctionGround level([](double, double) { return 0.0; });
  const DriveLimits tight{.max_tilt_rad = rad_from_deg(4.0)};
  RiskOptions risk{.draws = 60};
  const DrivePrediction as_mapped = predict(level, kSure, straight(6.0), risk, tight);
  risk.relief =
      std::make_shared<const ReliefSpread>(ReliefSpread{.elevation_error_m = 0.1, .error_length_m = 3.0});
  const DrivePrediction drawn = predict(level, kSure, straight(6.0), risk, tight);
  const auto tilt_of = [](const DrivePrediction& drive) {
    return drive.outcomes.rules[static_cast<std::size_t>(Rule::kTilt)];
  };
  EXPECT_EQ(tilt_of(as_mapped).trips.share, 0.0);
  EXPECT_GT(tilt_of(drawn).trips.share, 0.2);
  EXPECT_LT(tilt_of(drawn).trips.share, 1.0);
  ASSERT_EQ(drawn.stations.size(), as_mapped.stations.size());
  for (std::size_t k = 0; k < drawn.stations.size(); ++k) {
    const StationPrediction& sure = as_mapped.stations[k];
    EXPECT_NEAR(sure.tilt_rad_p95, sure.tilt_rad_p05, 1e-6);
    EXPECT_EQ(sure.clearance_m_p05, sure.clearance_m_p95);
    if (sure.station.distance_m < 3.0 * kRover.circumscribed_m()) continue;  // near where it stands
    EXPECT_GT(drawn.stations[k].tilt_rad_p95 - drawn.stations[k].tilt_rad_p05, rad_from_deg(1.0)) << k;
    EXPECT_GT(drawn.stations[k].clearance_m_p95 - drawn.stations[k].clearance_m_p05, 0.001) << k;
    EXPECT_EQ(drawn.stations[k].state.slip_ratio, sure.state.slip_ratio) << "the mean drive is the map's";
  }
}

// The linkage can't follow what a map of such error would be: every draw ends there, as a halt. Where the
// rover stands it is known to stand.
TEST(DriveRisk, ADrawWithoutAStanceHaltsBeyondTheStart) {
  const FunctionGround level([](double, double) { return 0.0; });
  RiskOptions risk{.draws = 8};
  risk.relief =
      std::make_shared<const ReliefSpread>(ReliefSpread{.elevation_error_m = 40.0, .error_length_m = 1.0});
  const DrivePrediction drawn = predict(level, kSure, straight(6.0), risk);
  EXPECT_EQ(drawn.outcomes.stop.share, 1.0);
  EXPECT_EQ(drawn.outcomes.embedding.share, 0.0);
  EXPECT_EQ(drawn.risk, 1.0);
  EXPECT_EQ(drawn.stations.front().stops, 0.0);
  EXPECT_EQ(drawn.stations.front().tilt_rad_p95, drawn.stations.front().tilt_rad_p05);
}

TEST(DriveRisk, ALimitThatTheGroundBreaksIsCertainAtWhateverLength) {
  // A step up at 13.9 m tilts the rover beyond 14 deg over the last quarter of a metre only.
  const FunctionGround ends_steep([](double x, double) { return x < 14.4 ? 0.0 : 0.6 * (x - 14.4); });
  const DriveLimits tight{.max_tilt_rad = rad_from_deg(3.0)};
  for (const double length : {14.0, 13.99}) {
    const DrivePrediction drive = predict(ends_steep, kSure, straight(length), {.draws = 8}, tight);
    ASSERT_FALSE(drive.broken_limits.empty());
    EXPECT_EQ(drive.risk, 1.0) << length;
    EXPECT_EQ(drive.outcomes.stop.share, 1.0) << length;
  }
}

TEST(DriveRisk, IsSteadyUnderACentimetre) {
  const DriveLimits tight{.max_slip_ratio = 0.12};
  const RiskOptions many{.draws = 100};
  const double whole = predict(kHills, kUnsure, straight(14.0), many, tight).risk;
  const double shorter = predict(kHills, kUnsure, straight(13.99), many, tight).risk;
  EXPECT_GT(whole, 0.02);
  EXPECT_LT(whole, 0.98);
  EXPECT_NEAR(whole, shorter, 0.05);
}

TEST(DriveRisk, WithoutStanceItIsCertain) {
  const FunctionGround wall([](double x, double) { return x < 4.0 ? 0.0 : 40.0 * (x - 4.0); });
  const DrivePrediction drive = predict(wall, kSure, straight(8.0), {.draws = 4});
  ASSERT_TRUE(drive.immobilised);
  EXPECT_EQ(drive.risk, 1.0);
  EXPECT_EQ(drive.outcomes.stop.share, 1.0);
  EXPECT_EQ(drive.draws, 4);
}

TEST(DriveRisk, DrawsGoPastAPlaceWhereOnlyTheMeanSoilEnds) {
  // A hump too steep for the mean soil and not for every draw of it; after it the ground is level.
  const FunctionGround hump([](double x, double) { return 2.2 * std::exp(-std::pow((x - 8.0) / 4.0, 2)); });
  const SoilBeliefs beliefs{{spread("sand", loose_sand(), 0.9)}, certain("unknown_ground", sandy_loam())};
  const DrivePrediction drive = predict(hump, beliefs, straight(20.0), {.draws = 60});
  ASSERT_TRUE(drive.immobilised);
  EXPECT_GT(drive.risk_immobilised, 0.0);
  EXPECT_LT(drive.risk_immobilised, 1.0);
}

TEST(DriveRisk, GrowsWithTheSlopeTheSpreadAndTheWay) {
  const DriveLimits tight{.max_slip_ratio = 0.25};
  const RiskOptions many{.draws = 120};
  const auto stops = [&](double deg, double relative, double length_m) {
    const SoilBeliefs beliefs{{spread("loam", sandy_loam(), relative)},
                              certain("unknown_ground", sandy_loam())};
    const DrivePrediction drive = predict(slope(deg), beliefs, straight(length_m), many, tight);
    return std::pair(1.0 - drive.outcomes.completed.share, drive.risk);
  };
  std::pair<double, double> before{0.0, 0.0};
  for (const double deg : {0.0, 6.0, 9.0, 12.0, 15.0, 20.0}) {
    const auto now = stops(deg, 0.4, 20.0);
    EXPECT_GE(now.first, before.first) << deg;
    EXPECT_GE(now.second, before.second) << deg;
    before = now;
  }
  EXPECT_GT(before.first, 0.8);
  before = {0.0, 0.0};
  for (const double length : {5.0, 10.0, 40.0, 80.0}) {
    const auto now = stops(9.0, 0.4, length);
    EXPECT_GE(now.first, before.first) << length;
    EXPECT_GE(now.second, before.second) << length;
    before = now;
  }
  EXPECT_LT(stops(6.0, 0.1, 20.0).second, stops(6.0, 0.6, 20.0).second + 1e-12);
}

TEST(DriveRisk, DrawsUntilTheBarsAreDecidedAndNoFurther) {
  const RiskOptions sequential{.draws = 24, .max_draws = 1000};
  const DrivePrediction firm = predict(slope(2.0), kUnsure, straight(5.0), sequential);
  EXPECT_EQ(firm.draws, 272) << "the fewest clean draws that show less than 1 %";
  EXPECT_LT(firm.outcomes.embedding.high, 0.01);
  const DrivePrediction hopeless = predict(slope(28.0), kUnsure, straight(5.0), sequential);
  EXPECT_EQ(hopeless.draws, 24);
  EXPECT_GT(hopeless.outcomes.stop.low, 0.5);
}

ConditionedDraw weighing(double weight) {
  ConditionedDraw draw;
  draw.weight = weight;
  return draw;
}

TEST(DriveRisk, WeightsOfDrawsCountAndLessenTheirEffectiveNumber) {
  const DriveLimits tight{.max_slip_ratio = 0.2};
  RiskOptions options{.draws = 64};
  const DrivePrediction even = predict(slope(8.0), kUnsure, straight(10.0), options, tight);
  EXPECT_NEAR(even.outcomes.effective_draws, 64.0, 1e-9);
  ASSERT_GT(even.outcomes.stop.share, 0.05);
  ASSERT_LT(even.outcomes.stop.share, 0.95);
  // All weight on the draws that do not stop.
  NoProgress progress;
  std::vector<ConditionedDraw> weights;
  for (int d = 0; d < 64; ++d) {
    RiskOptions one = options;
    std::vector<ConditionedDraw> only(64, weighing(0.0));
    only[static_cast<std::size_t>(d)].weight = 1.0;
    one.conditioned = std::make_shared<const std::vector<ConditionedDraw>>(only);
    const DrivePrediction alone = predict(slope(8.0), kUnsure, straight(10.0), one, tight);
    EXPECT_NEAR(alone.outcomes.effective_draws, 1.0, 1e-9);
    weights.push_back(weighing(1.0 - alone.outcomes.stop.share));
  }
  options.conditioned = std::make_shared<const std::vector<ConditionedDraw>>(weights);
  const DrivePrediction clean = predict(slope(8.0), kUnsure, straight(10.0), options, tight);
  EXPECT_EQ(clean.outcomes.stop.share, 0.0);
  EXPECT_NEAR(clean.outcomes.effective_draws, 64.0 * (1.0 - even.outcomes.stop.share), 1e-5);
}

// Patches of loam and of loose sand on a slope that only the sand makes slippery.
struct Patches {
  SoilBeliefs beliefs{{certain("patches", sandy_loam())}, certain("unknown_ground", sandy_loam())};
  DriveLimits tight{.max_slip_ratio = 0.3};
  FunctionGround ground = slope(8.0);
  RiskOptions options{.draws = 400};

  Patches() {
    SoilDistribution& patchy = beliefs.known.front();
    const auto loam = std::make_shared<SoilDistribution>(certain("loam", sandy_loam()));
    const auto sand = std::make_shared<SoilDistribution>(certain("sand", loose_sand()));
    patchy.alternatives = {{"loam", loam, 0.8, 0.8}, {"sand", sand, 0.2, 0.2}};
    patchy.alternatives_by = AlternativesBy::kPatch;
    patchy.alternatives_spread = 1.0;
    patchy.correlation_length_m = 10.0;
    patchy.drawn_apart = false;
  }
  double stop_at(double from_m) const {
    std::vector<PathStation> path = straight(6.0);
    for (PathStation& station : path) station.pose.x_m += from_m;
    return predict(ground, beliefs, path, options, tight).outcomes.stop.share;
  }
  // After a drive over the first 6 m.
  Patches after(bool stopped, double model_error, int tries) const {
    NoProgress progress;
    std::vector<ConditionedDraw> draws(static_cast<std::size_t>(options.draws));
    const auto done = condition_draws(kRover, 3.71, ground, beliefs, straight(6.0), tight, options,
                                      {stopped, model_error, tries}, 1, progress, draws);
    EXPECT_TRUE(done);
    Patches out = *this;
    out.options.conditioned = std::make_shared<const std::vector<ConditionedDraw>>(std::move(draws));
    return out;
  }
};

TEST(DriveRisk, WhatWasDrivenTellsOfTheSameGroundMostAndOfLikeGroundALittle) {
  const Patches before;
  const double first = before.stop_at(0.0), far = before.stop_at(3000.0);
  ASSERT_GT(first, 0.05);
  ASSERT_LT(first, 0.6);
  const Patches stopped = before.after(true, 0.05, 16), passed = before.after(false, 0.05, 4);
  // Where a rover was stopped it will be again, but for drives that something else stopped.
  EXPECT_GT(stopped.stop_at(0.0), 0.75);
  EXPECT_LT(passed.stop_at(0.0), 0.1 * first);
  EXPECT_GT(stopped.stop_at(3000.0), 1.15 * far) << "loose patches are commoner than was believed";
  EXPECT_LT(passed.stop_at(3000.0), far);
}

TEST(DriveRisk, ConditioningOnCertainGroundLeavesItAsItIs) {
  Patches certain_ground;
  certain_ground.beliefs.known.front().alternatives.clear();
  const double before = certain_ground.stop_at(0.0);
  EXPECT_EQ(certain_ground.after(true, 0.05, 8).stop_at(0.0), before);
}

// Bayes' rule by hand: with one try a draw's weight is the likelihood of the report on its own ground.
TEST(DriveRisk, AWeightIsTheLikelihoodOfTheReport) {
  const Patches before;
  const Patches after = before.after(true, 0.1, 1);
  const double prior = before.stop_at(0.0);
  const double posterior = 0.9 * prior / (0.9 * prior + 0.1 * (1.0 - prior));
  EXPECT_NEAR(after.stop_at(0.0), posterior, 1e-9);
}

// Good news never makes an answer worse: what was a GO stays one however many drives went well, far from the
// next drive or beside it; and a stop on the way of the next drive takes it back.
TEST(DriveRisk, GoodDrivesLeaveAGoAndAStopTakesItBack) {
  Patches ground;
  ground.beliefs.known.front().alternatives[1].pressure_weight =
      ground.beliefs.known.front().alternatives[1].strength_weight = 0.01;
  ground.options = RiskOptions{.draws = 200};
  const auto drive = [&](double from_m) {
    std::vector<PathStation> path = straight(6.0);
    for (PathStation& station : path) station.pose.x_m += from_m;
    return path;
  };
  const auto next_is_go = [&](const std::vector<ConditionedDraw>& draws) {
    RiskOptions options{.draws = 32, .max_draws = 1000};
    options.conditioned =
        std::make_shared<const std::vector<ConditionedDraw>>(renewed(draws, 1000, random_key(1, 1)));
    return options.bars.are_kept(
        predict(ground.ground, ground.beliefs, drive(100.0), options, ground.tight).outcomes);
  };
  std::vector<ConditionedDraw> draws(200);
  ASSERT_TRUE(next_is_go(draws));
  NoProgress progress;
  const auto learn = [&](double from_m, bool stopped) {
    const auto done =
        condition_draws(kRover, 3.71, ground.ground, ground.beliefs, drive(from_m), ground.tight,
                        ground.options, {stopped, 0.05, stopped ? 16 : 2}, 1, progress, draws);
    ASSERT_TRUE(done);
    if (effective_draws(draws) < 100.0)
      draws = renewed(draws, draws.size(), random_key(2, static_cast<std::uint64_t>(from_m)));
  };
  for (int k = 0; k < 14; ++k) {
    learn(7.0 * k + 1.0, false);
    EXPECT_TRUE(next_is_go(draws)) << k + 1 << " good drives";
  }
  learn(100.0, true);
  EXPECT_FALSE(next_is_go(draws));
}

// The weighted mean over the draws that a prediction keeps.
template <class Of>
double mean_of(const DrivePrediction& drive, Of of) {
  double sum = 0.0, weights = 0.0;
  for (const DrawFigures& draw : drive.drawn) {
    sum += draw.weight * static_cast<double>(of(draw));
    weights += draw.weight;
  }
  return sum / weights;
}

TEST(DrawFigures, AddUpToTheSharesOfTheWholeDrive) {
  const DriveLimits tight{.max_slip_ratio = 0.2};
  std::vector<ConditionedDraw> weights(64);
  weights[5].weight = 7.0;
  RiskOptions options{.draws = 64};
  options.conditioned = std::make_shared<const std::vector<ConditionedDraw>>(weights);
  const DrivePrediction drive = predict(slope(8.0), kUnsure, straight(10.0), options, tight);
  ASSERT_EQ(drive.drawn.size(), 64U);
  EXPECT_EQ(drive.drawn[5].weight, 7.0);
  EXPECT_GT(drive.outcomes.expected_stops, 0.0);
  EXPECT_NEAR(mean_of(drive, [](const DrawFigures& d) { return d.stops; }), drive.outcomes.expected_stops,
              1e-12);
  // An embedding behind a halt is one of another sol's drive, which a verdict does not judge.
  EXPECT_GE(mean_of(drive, [](const DrawFigures& d) { return d.embedded; }),
            drive.outcomes.embedding.share - 1e-12);
  EXPECT_NEAR(mean_of(drive, [](const DrawFigures& d) { return d.breaks_a_limit; }), drive.risk, 1e-12);
}

TEST(DrawFigures, WithoutSpreadAreThoseOfTheMeanSoils) {
  const DrivePrediction drive = predict(kHills, kSure, zigzag(), {.draws = 3});
  for (const DrawFigures& draw : drive.drawn) {
    EXPECT_DOUBLE_EQ(draw.driven_m, drive.length_m);
    EXPECT_NEAR(draw.duration_s, drive.duration_s, 1e-6 * drive.duration_s);
    EXPECT_NEAR(draw.energy_j, drive.energy_j, 1e-6 * drive.energy_j);
    EXPECT_NEAR(draw.slip_length_m, drive.mean_slip_ratio * drive.length_m, 1e-6 * drive.length_m);
    EXPECT_FALSE(draw.embedded);
  }
}

TEST(DrawFigures, AnImmobilisedDrawDoesNotComeToAllOfTheWay) {
  const FunctionGround hump([](double x, double) { return 2.2 * std::exp(-std::pow((x - 8.0) / 4.0, 2)); });
  const SoilBeliefs beliefs{{spread("sand", loose_sand(), 0.9)}, certain("unknown_ground", sandy_loam())};
  const DrivePrediction drive = predict(hump, beliefs, straight(20.0), {.draws = 60});
  int passed = 0, held = 0;
  for (const DrawFigures& draw : drive.drawn) {
    EXPECT_LE(draw.driven_m, 20.0 + 1e-9);
    const bool whole = draw.driven_m > 20.0 - 1e-9;
    (whole ? passed : held)++;
    if (!whole) {
      EXPECT_TRUE(draw.breaks_a_limit);
      EXPECT_TRUE(draw.stops > 0 || draw.embedded);
    }
  }
  EXPECT_GT(passed, 0);
  EXPECT_GT(held, 0);
}

TEST(DriveRisk, TheRulesSayWhereAndByHowMuch) {
  const DriveLimits tight{.max_slip_ratio = 0.3, .max_current_a = 0.2};
  const FunctionGround ramp([](double x, double) { return x < 6.0 ? 0.0 : 0.25 * (x - 6.0); });
  const DrivePrediction drive = predict(ramp, kUnsure, straight(12.0), {.draws = 32}, tight);
  ASSERT_EQ(drive.outcomes.rules.size(), kRules);
  const RuleRisk& tilt = drive.outcomes.rules[static_cast<std::size_t>(Rule::kTilt)];
  EXPECT_NEAR(tilt.value.p50, std::atan(0.25), 0.01);
  EXPECT_EQ(tilt.trips.share, 0.0);
  const RuleRisk& current = drive.outcomes.rules[static_cast<std::size_t>(Rule::kCurrent)];
  EXPECT_EQ(current.trips.share, 1.0);
  EXPECT_GE(current.wheel, 0);
  EXPECT_GT(current.value.p50, 0.2);
  EXPECT_LE(current.from_m, current.to_m);
  EXPECT_LE(current.to_m, 12.0 + 1e-9);
}

}  // namespace
}  // namespace slipway::sim
