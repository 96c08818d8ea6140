#include "sim/rover/multipass.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/angle.h"
#include "sim/quasi_static/quasi_static.h"
#include "tests/sim/reference_models.h"

namespace slipway::sim {
namespace {

constexpr double kMars = 3.71;

std::vector<int> listed(const PerWheel<int>& leaders) {
  return {leaders.begin(), leaders.end()};
}

StationState level(const RoverModel& rover, double stiffening, const DriveCommand& command = {}) {
  Soil soil = sandy_loam();
  soil.multipass_stiffening = stiffening;
  QuasiStaticSolver solver(rover, kMars);
  return solver.solve(stance_on_plane(rover, {}), soil, command);
}

TEST(Leaders, OnTheStraightEveryWheelFollowsTheNextOneOfItsSide) {
  EXPECT_EQ(listed(leaders(six_wheeler(), {})), (std::vector<int>{-1, 0, 1, -1, 3, 4}));
}

TEST(Leaders, BackwardsTheRearWheelsLead) {
  EXPECT_EQ(listed(leaders(six_wheeler(), {.speed_m_s = -0.04})), (std::vector<int>{1, 2, -1, 4, 5, -1}));
}

TEST(Leaders, TurningInPlaceNoWheelFollowsAnother) {
  EXPECT_EQ(listed(leaders(six_wheeler(), {.turn_in_place = true, .turn_rate_rad_s = 0.03})),
            std::vector<int>(6, -1));
}

TEST(Leaders, InCrabMotionTheTracksLieApart) {
  const DriveCommand crab{.crab_rad = rad_from_deg(20.0)};
  EXPECT_EQ(listed(leaders(six_wheeler(), crab)), std::vector<int>(6, -1));
}

TEST(Leaders, CrabbingSquareToTheSideTheRightWheelsFollowTheLeftOnes) {
  const DriveCommand crab{.crab_rad = std::numbers::pi / 2};
  EXPECT_EQ(listed(leaders(six_wheeler(), crab)), (std::vector<int>{-1, -1, -1, 0, 1, 2}));
}

TEST(Leaders, OnAnArcWheelsWithTheSameRadiusFollowAndOthersDoNot) {
  // About (0, R): front and rear at the same distance, the middle one on its own circle.
  const RoverModel rover = six_wheeler();
  const double radius = 0.9;
  const auto led = leaders(rover, {.curvature_1_m = 1.0 / radius});
  EXPECT_EQ(led[2], 0) << "left rear in the front wheel's track, past the middle one";
  EXPECT_EQ(led[1], -1);
  // On a wide arc all three share a track.
  EXPECT_EQ(listed(leaders(rover, {.curvature_1_m = 0.02})), (std::vector<int>{-1, 0, 1, -1, 3, 4}));
}

TEST(Multipass, SoilWithoutMemoryGivesEveryWheelItsOwnSinkage) {
  EXPECT_EQ(rut_share(0.0, 0.9), 0.0);
  const StationState state = level(six_wheeler(), 0.0);
  for (const WheelState& wheel : state.wheels)
    EXPECT_DOUBLE_EQ(wheel.sinkage_m, sinkage_m(0.125, wheel.entry_angle_rad));
}

TEST(Multipass, AnIncompressibleTrackIsNotMadeDeeper) {
  EXPECT_NEAR(rut_share(1e12, 0.9), 1.0, 1e-12);
  // A rear wheel with the front one's load; stiffness a thousandfold.
  const StationState state = level(four_wheeler(SuspensionType::kAveraging), 1e3);
  ASSERT_TRUE(state.moving());
  EXPECT_NEAR(state.wheels[1].sinkage_m, state.wheels[0].sinkage_m, 0.02 * state.wheels[0].sinkage_m);
  EXPECT_LT(sinkage_m(0.125, state.wheels[1].entry_angle_rad), 0.02 * state.wheels[0].sinkage_m);
}

TEST(Multipass, ReloadingPassesThroughThePressureAtWhichTheLeaderLeftTheSoil) {
  for (const double s : {0.3, 1.0, 4.0})
    for (const double n : {0.6, 1.0, 1.3}) {
      const double depth = 0.03, bottom = rut_share(s, n) * depth;
      EXPECT_NEAR((1.0 + s) * std::pow(depth - bottom, n), std::pow(depth, n), 1e-12);
    }
}

TEST(Multipass, AWheelUnderTheLeadersLoadComesOutAtTheLeadersDepthOrDeeper) {
  double before = 0.0;
  for (const double s : {0.0, 0.5, 1.0, 2.0, 4.0}) {
    const StationState state = level(four_wheeler(SuspensionType::kAveraging), s);
    ASSERT_TRUE(state.moving());
    EXPECT_EQ(state.left_rut_depth_m, state.wheels[1].sinkage_m);
    EXPECT_EQ(state.right_rut_depth_m, state.wheels[3].sinkage_m);
    const double own = sinkage_m(0.125, state.wheels[1].entry_angle_rad);
    EXPECT_LE(own, state.wheels[1].sinkage_m);
    EXPECT_TRUE(s == 0.0 || own < before) << "a stiffer track carries with less";
    before = own;
  }
}

TEST(Multipass, BackwardsTheRutIsTheFrontWheels) {
  const StationState state = level(six_wheeler(), 1.0, {.speed_m_s = -0.04});
  EXPECT_EQ(state.left_rut_depth_m, state.wheels[0].sinkage_m);
}

TEST(TotalSinkage, ARutOfThreeWheelsAddsUpFromTheFirstToTheLast) {
  PerWheel<int> led(3, -1);
  led[1] = 0;
  led[2] = 1;
  PerWheel<double> share(3, 0.5), own(3, 0.01);
  const auto total = total_sinkages_m(led, share, own);
  EXPECT_DOUBLE_EQ(total[0], 0.01);
  EXPECT_DOUBLE_EQ(total[1], 0.015);
  EXPECT_DOUBLE_EQ(total[2], 0.0175);
}

}  // namespace
}  // namespace slipway::sim
