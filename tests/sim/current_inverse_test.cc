#include "sim/single_wheel/current_inverse.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/sim/zhurong_simulants.h"

namespace slipway::sim {
namespace {

WheelRigConditions zhurong_on(const Soil& soil) {
  return conditions_of(zhurong_rig(soil));
}

double current_at(WheelRigConditions test, double slip) {
  test.slip = slip;
  return *run_wheel_rig(test).current_a;
}

SoilDistribution usual_spread(const Soil& soil) {
  return spread("simulant", soil, 0.25);
}

TEST(SlipsOfCurrent, GiveBackTheSlipThatMadeTheCurrent) {
  for (const auto& simulant : jlu_mars()) {
    for (const Soil& soil : simulant) {
      const WheelRigConditions test = zhurong_on(soil);
      for (const double slip : {-0.2, 0.0, 0.137, 0.4, 0.85}) {
        const SlipsOfCurrent found = slips_of_current(test, current_at(test, slip));
        ASSERT_EQ(found.slips.size(), 1U) << slip;
        EXPECT_NEAR(*found.reported, slip, 1e-9);
      }
    }
  }
}

TEST(SlipsOfCurrent, TheMotorsIdleCurrentIsAccountedFor) {
  WheelRigConditions test = zhurong_on(jlu_mars()[1][2]);
  test.drive->no_load_current_a = 0.06;
  test.drive->gear_friction_nm = 0.4;
  EXPECT_NEAR(*slips_of_current(test, current_at(test, 0.25)).reported, 0.25, 1e-9);
}

TEST(SlipsOfCurrent, ReportsTheRangeOfCurrentsWhereNoSlipFits) {
  const WheelRigConditions test = zhurong_on(jlu_mars()[1][2]);
  const SlipsOfCurrent found = slips_of_current(test, 9.0);
  EXPECT_TRUE(found.slips.empty());
  EXPECT_FALSE(found.reported);
  EXPECT_NEAR(found.greatest_current_a, current_at(test, kMaxSearchedSlip), 1e-12);
  EXPECT_NEAR(found.least_current_a, current_at(test, kMinSearchedSlip), 1e-12);
}

// Held at its depth, the wheel is the paper's literal one, whose current falls again at high slip.
TEST(SlipsOfCurrent, OfSeveralSlipsTheOneOnTheRisingBranchIsReported) {
  WheelRigConditions test = zhurong_on(jlu_mars()[1][0]);
  test.sinkage_m = 0.0437;
  const double current = current_at(test, 0.25);
  const SlipsOfCurrent found = slips_of_current(test, current);
  ASSERT_EQ(found.slips.size(), 2U);
  EXPECT_NEAR(found.slips[0], 0.25, 1e-9);
  EXPECT_NEAR(*found.reported, 0.25, 1e-9);
  EXPECT_GT(found.slips[1], 0.6);
  EXPECT_NEAR(current_at(test, found.slips[1]), current, 1e-6);
  const CurrentInverse inverse = invert_current(test, certain("loose", test.soil), current, {.draws = 5});
  EXPECT_EQ(inverse.verdict, Trafficability::kUnknown) << "an ambiguous current is no GO";
}

TEST(SlipsOfCurrent, ReportsTheSlipFromWhichTheWheelIsSunk) {
  WheelRigConditions test = zhurong_on(jlu_mars()[1][0]);
  test.soil.n1 = 0.6;
  const SlipsOfCurrent found = slips_of_current(test, 1.5);
  ASSERT_TRUE(found.sunk_from_slip);
  test.slip = *found.sunk_from_slip;
  EXPECT_FALSE(run_wheel_rig(test).stands());
  test.slip -= kSearchedSlipStep;
  EXPECT_TRUE(run_wheel_rig(test).stands());
}

TEST(GreatestPull, IsNoLessThanThePullAtAnySlip) {
  for (const auto& simulant : jlu_mars()) {
    for (const Soil& soil : simulant) {
      WheelRigConditions test = zhurong_on(soil);
      const GreatestPull best = greatest_pull(test).value();
      for (double slip = 0.0; slip <= kMaxSearchedSlip; slip += 0.013) {
        test.slip = slip;
        EXPECT_GE(best.pull_n + 1e-6, run_wheel_rig(test).forces.drawbar_pull_n);
      }
    }
  }
}

TEST(InvertCurrent, TheSlopesInUseAndLeftAddUpToTheMaximum) {
  const WheelRigConditions test = zhurong_on(jlu_mars()[1][2]);
  const CurrentInverse inverse = invert_current(test, usual_spread(test.soil), current_at(test, 0.3), {});
  ASSERT_TRUE(inverse.share_of_pull && inverse.slope_left_rad);
  const double pull = inverse.wheel->forces.drawbar_pull_n;
  EXPECT_NEAR(*inverse.share_of_pull, pull / inverse.greatest->pull_n, 1e-12);
  EXPECT_NEAR(std::tan(*inverse.slope_in_use_rad), pull / test.load_n, 1e-12);
  EXPECT_NEAR(*inverse.slope_in_use_rad + *inverse.slope_left_rad, *inverse.slope_greatest_rad, 1e-12);
  EXPECT_GT(*inverse.slope_left_rad, 0.0);
}

TEST(InvertCurrent, AWheelThatIsPushedHasNoShareOfPull) {
  const WheelRigConditions test = zhurong_on(jlu_mars()[1][2]);
  const CurrentInverse inverse =
      invert_current(test, certain("dense", test.soil), current_at(test, 0.05), {.draws = 1});
  EXPECT_LT(inverse.wheel->forces.drawbar_pull_n, 0.0);
  EXPECT_FALSE(inverse.share_of_pull);
  EXPECT_LT(*inverse.slope_in_use_rad, 0.0);
  EXPECT_NE(inverse.words.back().find("pulls nothing"), std::string::npos);
}

TEST(InvertCurrent, QuantilesHoldTheMeanAndRepeat) {
  const WheelRigConditions test = zhurong_on(jlu_mars()[1][2]);
  const double current = current_at(test, 0.2);
  const CurrentInverse a = invert_current(test, usual_spread(test.soil), current, {});
  const CurrentInverse b = invert_current(test, usual_spread(test.soil), current, {});
  EXPECT_LT(a.quantiles.p05, 0.2);
  EXPECT_GT(a.quantiles.p95, 0.2);
  EXPECT_LE(a.quantiles.p05, a.quantiles.p50);
  EXPECT_EQ(a.quantiles.p50, b.quantiles.p50);
  EXPECT_EQ(a.quantiles.solved + a.quantiles.above + a.quantiles.below, 200);
  const CurrentInverse other = invert_current(test, usual_spread(test.soil), current, {.seed = 2});
  EXPECT_NE(a.quantiles.p50, other.quantiles.p50);
}

TEST(InvertCurrent, ACertainSoilHasNoSpread) {
  const WheelRigConditions test = zhurong_on(jlu_mars()[1][2]);
  const CurrentInverse inverse =
      invert_current(test, certain("dense", test.soil), current_at(test, 0.2), {.draws = 3});
  EXPECT_NEAR(inverse.quantiles.p05, 0.2, 1e-9);
  EXPECT_NEAR(inverse.quantiles.p95, 0.2, 1e-9);
  EXPECT_EQ(inverse.quantiles.risk, 0.0);
}

TEST(InvertCurrent, JudgesBySlipLimitAndRisk) {
  const WheelRigConditions test = zhurong_on(jlu_mars()[1][2]);
  const auto verdict = [&](double slip, const SoilDistribution& belief) {
    return invert_current(test, belief, current_at(test, slip), {}).verdict;
  };
  EXPECT_EQ(verdict(0.1, certain("dense", test.soil)), Trafficability::kGo);
  EXPECT_EQ(verdict(0.38, usual_spread(test.soil)), Trafficability::kUnknown);
  EXPECT_EQ(verdict(0.5, usual_spread(test.soil)), Trafficability::kNoGo);
  const CurrentInverse too_much = invert_current(test, certain("dense", test.soil), 9.0, {.draws = 4});
  EXPECT_EQ(too_much.verdict, Trafficability::kNoGo);
  EXPECT_EQ(too_much.quantiles.above, 4);
  EXPECT_EQ(too_much.quantiles.risk, 1.0);
  EXPECT_NE(too_much.words.at(0).find("explains 9.000 A"), std::string::npos) << too_much.words.at(0);
  const CurrentInverse too_little = invert_current(test, certain("dense", test.soil), -9.0, {.draws = 4});
  EXPECT_EQ(too_little.verdict, Trafficability::kUnknown);
  EXPECT_EQ(too_little.quantiles.below, 4);
}

TEST(InvertCurrent, AWheelThatIsSunkEverywhereIsNoGo) {
  WheelRigConditions test = zhurong_on(jlu_mars()[1][0]);
  test.load_n = 5e4;
  const CurrentInverse inverse = invert_current(test, certain("loose", test.soil), 1.0, {.draws = 2});
  EXPECT_EQ(inverse.verdict, Trafficability::kNoGo);
  EXPECT_FALSE(inverse.greatest);
  EXPECT_NE(inverse.words.at(0).find("sunk to its axle"), std::string::npos);
}

}  // namespace
}  // namespace slipway::sim
