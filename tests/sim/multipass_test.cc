#include "sim/rover/multipass.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include "core/angle.h"
#include "sim/effects/effect_catalogue.h"
#include "sim/quasi_static/quasi_static.h"
#include "sim/soil/soil_in_force.h"
#include "sim/wheel/entry_angle.h"
#include "tests/sim/reference_models.h"

namespace slipway::sim {
namespace {

constexpr double kMars = 3.71;

// Of a rover that moves at this speed, in the direction so far to the left of its x axis, on a path of this
// curvature.
TrackShares tracks_at(const RoverModel& rover, double speed_m_s, double direction_rad = 0.0,
                      double curvature_1_m = 0.0) {
  return tracks_followed(rover, speed_m_s * Eigen::Vector2d(std::cos(direction_rad), std::sin(direction_rad)),
                         std::abs(speed_m_s) * curvature_1_m);
}

// A table of N x N shares from what is not 0 in it.
struct Share {
  int wheel = 0, leader = 0;
  double share = 0.0;
};
TrackShares table(int wheels, const std::vector<Share>& shares) {
  TrackShares table = TrackShares::Zero(wheels, wheels);
  for (const Share& one : shares) table(one.wheel, one.leader) = one.share;
  return table;
}

void expect_near(const TrackShares& found, const TrackShares& expected, double tolerance = 1e-12) {
  EXPECT_LE((found - expected).cwiseAbs().maxCoeff(), tolerance) << found << "\ninstead of\n" << expected;
}

StationState level(const RoverModel& rover, double stiffening, const DriveCommand& command = {}) {
  Soil soil = sandy_loam();
  soil.multipass_stiffening = stiffening;
  QuasiStaticSolver solver(rover, kMars);
  return solver.solve(stance_on_plane(rover, {}), soil, command);
}

TEST(TracksFollowed, OnTheStraightEachPartOfAWheelFollowsTheLastWheelThatDroveThere) {
  // The middle wheels stand half a width farther out than the others.
  expect_near(tracks_at(six_wheeler(), 0.04),
              table(6, {{1, 0, 0.5}, {2, 1, 0.5}, {2, 0, 0.5}, {4, 3, 0.5}, {5, 4, 0.5}, {5, 3, 0.5}}));
}

TEST(TracksFollowed, BackwardsTheRearWheelsLead) {
  expect_near(tracks_at(six_wheeler(), -0.04),
              table(6, {{1, 2, 0.5}, {0, 1, 0.5}, {0, 2, 0.5}, {4, 5, 0.5}, {3, 4, 0.5}, {3, 5, 0.5}}));
}

TEST(TracksFollowed, WithoutVelocityNoWheelFollowsAnother) {
  expect_near(tracks_followed(six_wheeler(), Eigen::Vector2d::Zero(), 0.03), table(6, {}), 0.0);
}

TEST(TracksFollowed, InCrabMotionTheTracksLieApart) {
  expect_near(tracks_at(six_wheeler(), 0.04, rad_from_deg(20.0)), table(6, {}), 0.0);
}

TEST(TracksFollowed, CrabbingSquareToTheSideTheRightWheelsFollowTheLeftOnes) {
  expect_near(tracks_at(six_wheeler(), 0.04, std::numbers::pi / 2),
              table(6, {{3, 0, 1.0}, {4, 1, 1.0}, {5, 2, 1.0}}));
}

TEST(TracksFollowed, OnAnArcWheelsWithTheSameRadiusFollowAndOthersDoNot) {
  // About (0, R): front and rear at the same distance, the middle one on its own circle.
  const TrackShares tight = tracks_at(six_wheeler(), 0.04, 0.0, 1.0 / 0.9);
  EXPECT_NEAR(tight(2, 0), 1.0, 1e-9) << "left rear in the front wheel's track, past the middle one";
  EXPECT_EQ(tight.row(1).sum(), 0.0);
  // On a wide arc all three share a track.
  const TrackShares wide = tracks_at(six_wheeler(), 0.04, 0.0, 0.02);
  for (const auto& [wheel, leader] : {std::pair{1, 0}, {2, 1}, {4, 3}, {5, 4}})
    EXPECT_GT(wide(wheel, leader), 0.4) << wheel;
}

TEST(TracksFollowed, SlidingAsideAWheelStandsInATrackByWhatIsLeftOfItsWidth) {
  const RoverModel rover = four_wheeler(SuspensionType::kAveraging);
  const double wheelbase_m = rover.wheels[0].position_m.x() - rover.wheels[1].position_m.x();
  for (const double drift_deg : {-5.0, -2.0, 1.0, 5.0}) {
    const double drift = rad_from_deg(drift_deg);
    const double share = 1.0 - wheelbase_m * std::abs(std::sin(drift)) / rover.wheels[1].width_m;
    ASSERT_GT(share, 0.0);
    expect_near(tracks_at(rover, 0.04, drift), table(4, {{1, 0, share}, {3, 2, share}}));
  }
}

TEST(TracksFollowed, ACircleBecomesAStraightLineWithoutAStep) {
  const TrackShares straight = tracks_at(six_wheeler(), 0.04, rad_from_deg(4.0));
  for (const double curvature_1_m : {1e-3, 1e-5, 1e-7, 1e-9, 1e-11, -1e-7})
    expect_near(tracks_at(six_wheeler(), 0.04, rad_from_deg(4.0), curvature_1_m), straight,
                20.0 * std::abs(curvature_1_m) + 1e-13);
}

TEST(TracksFollowed, AreThoseOfTheMirroredMotionMirrored) {
  const TrackShares left = tracks_at(six_wheeler(), 0.04, rad_from_deg(3.0), 0.3);
  const TrackShares right = tracks_at(six_wheeler(), 0.04, rad_from_deg(-3.0), -0.3);
  TrackShares mirrored(6, 6);
  for (int k = 0; k < 6; ++k)
    for (int m = 0; m < 6; ++m) mirrored(k, m) = right((k + 3) % 6, (m + 3) % 6);
  expect_near(left, mirrored);
}

TEST(Multipass, TurningInPlaceNoWheelFollowsAnother) {
  const DriveCommand turn{.turn_in_place = true, .turn_rate_rad_s = 0.03};
  const StationState fresh = level(six_wheeler(), 0.0, turn), stiffening = level(six_wheeler(), 2.0, turn);
  for (std::size_t k = 0; k < 6; ++k) {
    EXPECT_EQ(stiffening.wheels[k].sinkage_m, fresh.wheels[k].sinkage_m) << k;
    EXPECT_EQ(stiffening.wheels[k].torque_nm, fresh.wheels[k].torque_nm) << k;
  }
}

// As Holm saw it: soil that was compacted carries and pulls more. With the effect's own numbers and any
// stiffening, on soils of several exponents, in driving slip.
TEST(Multipass, ASecondPassPullsNoLessThanTheFirst) {
  const Soil soils[] = {ding_like(),
                        sandy_loam(),
                        loose_sand(),
                        make_soil({5270.0, 1515000.0, 0.7}, 1720.0, 29.0, 0.0152, 0.18, 0.32),
                        make_soil({1400.0, 820000.0, 1.0}, 220.0, 33.1, 0.0152, 0.43, 0.32),
                        make_soil({5471.0, 234221.0, 0.91}, 383.0, 19.1, 0.0133, 0.285, 0.32)};
  const WheelGeometry wheel{0.125, 0.16};
  for (const double stiffening : {0.3, 0.9, 3.0})
    for (const Soil& fresh : soils)
      for (const double slip : {0.02, 0.05, 0.1, 0.2, 0.4, 0.6, 0.9}) {
        Soil track = fresh;
        const EffectSetting multipass{.name = "multipass", .parameters = {{"stiffening", stiffening}}};
        apply_effects(std::span(&multipass, 1), track);
        put_in_track(track, 1.0);
        const auto pull = [&](const Soil& soil) {
          const WheelMotion motion{1.0 - slip, 0.0};
          const auto theta = balanced_entry_angle_rad(wheel, soil, 107.0, motion);
          EXPECT_TRUE(theta);
          return theta ? wheel_forces(wheel, soil, *theta, motion).drawbar_pull_n : 0.0;
        };
        EXPECT_GE(pull(track), pull(fresh)) << stiffening << " " << slip << " " << fresh.cohesion_pa;
      }
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
  const TrackShares line = table(3, {{1, 0, 1.0}, {2, 1, 1.0}});
  PerWheel<double> share(3, 0.5), own(3, 0.01);
  const auto total = total_sinkages_m(line, share, own);
  EXPECT_DOUBLE_EQ(total[0], 0.01);
  EXPECT_DOUBLE_EQ(total[1], 0.015);
  EXPECT_DOUBLE_EQ(total[2], 0.0175);
  // Half of the last wheel's width stands in the second one's rut, and a quarter in the first one's.
  const TrackShares beside = table(3, {{1, 0, 1.0}, {2, 1, 0.5}, {2, 0, 0.25}});
  EXPECT_DOUBLE_EQ(total_sinkages_m(beside, share, own)[2], 0.01 + 0.5 * (0.5 * 0.015 + 0.25 * 0.01));
}

}  // namespace
}  // namespace slipway::sim
