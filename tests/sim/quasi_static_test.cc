#include "sim/quasi_static/quasi_static.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "core/angle.h"
#include "core/random.h"
#include "sim/quasi_static/rover_balance.h"
#include "tests/sim/reference_models.h"

namespace slipway::sim {
namespace {

constexpr double kMars = 3.71;

Attitude sloping(double pitch_deg, double roll_deg) {
  return {.roll_rad = rad_from_deg(roll_deg), .pitch_rad = rad_from_deg(pitch_deg), .yaw_rad = 0.0};
}

StationState straight(const RoverModel& rover, const Soil& soil, const Attitude& attitude,
                      double speed = 0.04) {
  QuasiStaticSolver solver(rover, kMars);
  return solver.solve(stance_on_plane(rover, attitude), soil, {.speed_m_s = speed});
}

double total(const StationState& state, double WheelState::*of) {
  return std::accumulate(state.wheels.begin(), state.wheels.end(), 0.0,
                         [of](double sum, const WheelState& w) { return sum + w.*of; });
}

TEST(QuasiStatic, OnLevelGroundThePullsOfTheWheelsAddUpToNothing) {
  const StationState state = straight(six_wheeler(), sandy_loam(), sloping(0, 0));
  ASSERT_TRUE(state.moving());
  EXPECT_NEAR(total(state, &WheelState::drawbar_pull_n), 0.0, 1e-5);
  EXPECT_NEAR(total(state, &WheelState::load_n), 174.0 * kMars, 1e-5);
  EXPECT_NEAR(state.leftward_m_s, 0.0, 1e-10);
  EXPECT_NEAR(state.yaw_rate_rad_s, 0.0, 1e-10);
  EXPECT_GT(state.slip_ratio, 0.0) << "pushing through soil costs slip";
}

TEST(QuasiStatic, OnAClimbThePullsCarryTheWeightsShare) {
  for (const double climb_deg : {5.0, 12.0, 20.0}) {
    const StationState state = straight(six_wheeler(), sandy_loam(), sloping(-climb_deg, 0));
    ASSERT_TRUE(state.moving());
    const double weight = 174.0 * kMars;
    EXPECT_NEAR(total(state, &WheelState::drawbar_pull_n), weight * std::sin(rad_from_deg(climb_deg)), 1e-5);
    EXPECT_NEAR(total(state, &WheelState::load_n), weight * std::cos(rad_from_deg(climb_deg)), 1e-5);
  }
}

TEST(QuasiStatic, AcrossASlopeTheSideForcesHoldTheRoverAndItSlidesDownhill) {
  const StationState state = straight(six_wheeler(), sandy_loam(), sloping(0, 12));  // left side up
  ASSERT_TRUE(state.moving());
  EXPECT_NEAR(total(state, &WheelState::lateral_force_n), 174.0 * kMars * std::sin(rad_from_deg(12.0)), 1e-5);
  EXPECT_LT(state.side_slip_rad, rad_from_deg(-1.0)) << "downhill is to the right";
}

// The bogies, the differential and the whole rover, taken apart by hand and not through RoverBalance's
// matrices.
TEST(QuasiStatic, EveryPartOfTheSuspensionIsInBalanceAboutItsPivot) {
  const RoverModel rover = six_wheeler();
  const Attitude attitude = sloping(-11, 6);
  const Stance stance = stance_on_plane(rover, attitude);
  const StationState state = straight(rover, sandy_loam(), attitude);
  ASSERT_TRUE(state.moving());
  const auto moment_y = [&](int k, const Eigen::Vector3d& about) {
    const WheelState& w = state.wheels[k];
    const Eigen::Vector3d force(w.drawbar_pull_n, w.lateral_force_n, w.load_n);
    return (stance.p_B_wheel[k] - about).cross(force).y() - w.torque_nm;
  };
  Eigen::Vector3d bogie = rover.suspension.bogie_pivot_m, rocker = rover.suspension.rocker_pivot_m;
  EXPECT_NEAR(moment_y(1, bogie) + moment_y(2, bogie), 0.0, 1e-5);
  const double left = moment_y(0, rocker) + moment_y(1, rocker) + moment_y(2, rocker);
  bogie.y() *= -1.0;
  rocker.y() *= -1.0;
  EXPECT_NEAR(moment_y(4, bogie) + moment_y(5, bogie), 0.0, 1e-5);
  const double right = moment_y(3, rocker) + moment_y(4, rocker) + moment_y(5, rocker);
  EXPECT_NEAR(left, right, 1e-5);

  const Eigen::Vector3d gravity = stance.R_MB.transpose() * Eigen::Vector3d(0, 0, -174.0 * kMars);
  Eigen::Vector3d moment = rover.com_m.cross(gravity), force = gravity;
  for (int k = 0; k < 6; ++k) {
    const WheelState& w = state.wheels[k];
    const Eigen::Vector3d f(w.drawbar_pull_n, w.lateral_force_n, w.load_n);
    force += f;
    // The lateral force acts at the rim's lowest point.
    moment += stance.p_B_wheel[k].cross(f) +
              Eigen::Vector3d(rover.wheels[k].radius_m * w.lateral_force_n, -w.torque_nm, 0);
  }
  EXPECT_LT(force.norm(), 1e-5);
  EXPECT_LT(moment.norm(), 1e-5);
}

TEST(QuasiStatic, EachWheelHasItsOwnLoadSinkageAndCurrent) {
  const StationState state = straight(six_wheeler(), sandy_loam(), sloping(-12, 8));
  for (int k = 0; k < 6; ++k)
    for (int other = 0; other < k; ++other) {
      EXPECT_GT(std::abs(state.wheels[k].load_n - state.wheels[other].load_n), 0.1);
      EXPECT_GT(std::abs(state.wheels[k].current_a - state.wheels[other].current_a), 1e-4);
    }
}

// A steady force at the centre of mass is what gravity would be in another direction.
TEST(QuasiStatic, APullFromOutsideIsCarriedByTheWheels) {
  const RoverModel rover = six_wheeler();
  const Stance stance = stance_on_plane(rover, sloping(0, 0));
  OutsideWrench wrench;
  wrench.force_n = {-60.0, 25.0, -10.0};
  wrench.moment_nm = rover.com_m.cross(wrench.force_n);
  QuasiStaticSolver solver(rover, kMars);
  solver.set_outside(wrench);
  const StationState pulled = solver.solve(stance, sandy_loam(), {.speed_m_s = 0.04});
  ASSERT_TRUE(pulled.moving());
  EXPECT_NEAR(total(pulled, &WheelState::drawbar_pull_n), 60.0, 1e-5);
  EXPECT_NEAR(total(pulled, &WheelState::lateral_force_n), -25.0, 1e-5);
  EXPECT_NEAR(total(pulled, &WheelState::load_n), 174.0 * kMars + 10.0, 1e-5);

  // A slope of that tangent with the same load across it moves the rover as the level pull does.
  const double weight = 174.0 * kMars;
  wrench.force_n = {-weight * std::tan(rad_from_deg(5.0)), 0.0, 0.0};
  wrench.moment_nm = rover.com_m.cross(wrench.force_n);
  solver.set_outside(wrench);
  const StationState level = solver.solve(stance, sandy_loam(), {.speed_m_s = 0.04});
  RoverModel heavier = rover;
  heavier.mass_kg /= std::cos(rad_from_deg(5.0));
  const StationState climbing = straight(heavier, sandy_loam(), sloping(-5.0, 0.0));
  EXPECT_NEAR(level.slip_ratio, climbing.slip_ratio, 1e-6);
  for (std::size_t k = 0; k < rover.wheels.size(); ++k)
    EXPECT_NEAR(level.wheels[k].load_n, climbing.wheels[k].load_n, 1e-4) << k;

  solver.set_outside(std::nullopt);
  EXPECT_NEAR(solver.solve(stance, sandy_loam(), {.speed_m_s = 0.04}).slip_ratio,
              QuasiStaticSolver(rover, kMars).solve(stance, sandy_loam(), {.speed_m_s = 0.04}).slip_ratio,
              1e-8)
      << "nothing acts any more";
}

// The same pull at the body and at the axles: the wheels share it, but only the second turns the bogies.
TEST(QuasiStatic, APullAtAWheelTurnsTheSuspensionsJoints) {
  const RoverModel rover = six_wheeler();
  const Stance stance = stance_on_plane(rover, sloping(0, 0));
  OutsideWrench at_rear;
  at_rear.at_wheel_n = PerWheel<Eigen::Vector3d>(6, Eigen::Vector3d::Zero());
  for (std::size_t k = 0; k < 6; ++k)
    if (rover.wheels[k].position_m.x() < -0.5) at_rear.at_wheel_n[k] = {-20.0, 0.0, 0.0};
  OutsideWrench at_body;
  at_body.force_n = {-40.0, 0.0, 0.0};
  for (std::size_t k = 0; k < 6; ++k) at_body.moment_nm += stance.p_B_wheel[k].cross(at_rear.at_wheel_n[k]);
  QuasiStaticSolver solver(rover, kMars);
  solver.set_outside(at_rear);
  const StationState wheels = solver.solve(stance, sandy_loam(), {.speed_m_s = 0.04});
  solver.set_outside(at_body);
  const StationState body = solver.solve(stance, sandy_loam(), {.speed_m_s = 0.04});
  ASSERT_TRUE(wheels.moving() && body.moving());
  EXPECT_NEAR(total(wheels, &WheelState::drawbar_pull_n), 40.0, 1e-5);
  EXPECT_NEAR(total(body, &WheelState::drawbar_pull_n), 40.0, 1e-5);
  EXPECT_GT(std::abs(wheels.wheels[2].load_n - body.wheels[2].load_n), 1.0) << "the bogie turns";
}

TEST(QuasiStatic, SlipRisesWithTheClimbUntilTheSoilGivesNoMore) {
  double slip = -1.0;
  bool stuck = false;
  for (double climb = -20.0; climb <= 40.0; climb += 1.0) {
    const StationState state = straight(six_wheeler(), loose_sand(), sloping(-climb, 0));
    EXPECT_NE(state.outcome, Outcome::kNotConverged) << climb;
    if (stuck) {
      EXPECT_FALSE(state.moving()) << climb;
    } else if (state.moving()) {
      EXPECT_GT(state.slip_ratio, slip) << climb;
      slip = state.slip_ratio;
    } else {
      EXPECT_EQ(state.outcome, Outcome::kNoTraction);
      EXPECT_GT(climb, 9.0);
      stuck = true;
    }
  }
  EXPECT_TRUE(stuck);
}

TEST(QuasiStatic, DrivingBackwardsUphillMirrorsDrivingForwardsOfTheMirroredRover) {
  RoverModel mirrored = six_wheeler();
  mirrored.com_m.x() *= -1.0;
  mirrored.suspension.rocker_pivot_m.x() *= -1.0;
  mirrored.suspension.bogie_pivot_m.x() *= -1.0;
  for (WheelModel& wheel : mirrored.wheels) wheel.position_m.x() *= -1.0;
  const StationState backwards = straight(six_wheeler(), sandy_loam(), sloping(10, 0), -0.04);
  const StationState forwards = straight(mirrored, sandy_loam(), sloping(-10, 0), 0.04);
  ASSERT_TRUE(backwards.moving());
  EXPECT_NEAR(backwards.slip_ratio, forwards.slip_ratio, 1e-7);
  EXPECT_NEAR(backwards.forward_m_s, -forwards.forward_m_s, 1e-9);
  EXPECT_NEAR(backwards.wheels[0].current_a, -forwards.wheels[0].current_a, 1e-7);
}

TEST(QuasiStatic, ALeftRightMirroredSlopeMirrorsTheMotion) {
  const StationState left = straight(six_wheeler(), sandy_loam(), sloping(-8, 9));
  const StationState right = straight(six_wheeler(), sandy_loam(), sloping(-8, -9));
  EXPECT_NEAR(left.leftward_m_s, -right.leftward_m_s, 1e-10);
  EXPECT_NEAR(left.yaw_rate_rad_s, -right.yaw_rate_rad_s, 1e-10);
  EXPECT_NEAR(left.wheels[0].load_n, right.wheels[3].load_n, 1e-5);
}

TEST(QuasiStatic, AnArcTurnsTheWayItIsSteeredAndATurnInPlaceStaysInPlace) {
  const RoverModel rover = six_wheeler();
  QuasiStaticSolver solver(rover, kMars);
  const Stance level = stance_on_plane(rover, {});
  const StationState arc = solver.solve(level, sandy_loam(), {.speed_m_s = 0.04, .curvature_1_m = 0.4});
  ASSERT_TRUE(arc.moving());
  EXPECT_NEAR(arc.yaw_rate_rad_s, 0.04 * 0.4, 0.1 * 0.04 * 0.4);
  const StationState turn =
      solver.solve(level, sandy_loam(), {.turn_in_place = true, .turn_rate_rad_s = -0.03});
  ASSERT_TRUE(turn.moving());
  EXPECT_LT(turn.yaw_rate_rad_s, -0.025);
  EXPECT_LT(std::hypot(turn.forward_m_s, turn.leftward_m_s), 2e-3);
}

TEST(QuasiStatic, TheMotorsTakeAtLeastThePowerThatLiftsTheRover) {
  for (double climb = 0.0; climb < 20.0; climb += 4.0) {
    const StationState state = straight(six_wheeler(), sandy_loam(), sloping(-climb, 0));
    ASSERT_TRUE(state.moving());
    EXPECT_GT(state.electric_power_w, 174.0 * kMars * state.forward_m_s * std::sin(rad_from_deg(climb)));
  }
}

TEST(QuasiStatic, TheAnswerDoesNotDependOnWhereTheSearchStarted) {
  const RoverModel rover = six_wheeler();
  QuasiStaticSolver warm(rover, kMars);
  for (int trial = 0; trial < 200; ++trial) {
    const Stance stance = stance_on_plane(
        rover, sloping(30.0 * random_uniform(1, trial) - 15.0, 24.0 * random_uniform(2, trial) - 12.0));
    QuasiStaticSolver cold(rover, kMars);
    const StationState a = warm.solve(stance, sandy_loam(), {.speed_m_s = 0.04});
    const StationState b = cold.solve(stance, sandy_loam(), {.speed_m_s = 0.04});
    ASSERT_EQ(a.outcome, b.outcome);
    EXPECT_NEAR(a.slip_ratio, b.slip_ratio, 1e-6);
    EXPECT_NEAR(a.leftward_m_s, b.leftward_m_s, 1e-8);
  }
}

TEST(QuasiStatic, AnOverloadedMotorStallsAndTheWheelIsNamed) {
  RoverModel rover = six_wheeler();
  rover.drive.max_current_a = 0.4;
  const StationState state = straight(rover, sandy_loam(), sloping(-15, 0));
  EXPECT_EQ(state.outcome, Outcome::kStalled);
  EXPECT_TRUE(state.wheel == 2 || state.wheel == 5) << "the rear wheels carry most uphill";
}

TEST(QuasiStatic, ARoverTooHeavyForTheSoilSinksToItsAxles) {
  Soil powder = loose_sand();
  powder.pressure = {10.0, 2000.0, 1.0};
  const StationState state = straight(six_wheeler(), powder, sloping(0, 0));
  EXPECT_EQ(state.outcome, Outcome::kSunkToAxle);
}

TEST(QuasiStatic, ARoverPastItsTippingAngleLiftsItsUphillWheels) {
  RoverModel rover = six_wheeler();
  rover.com_m.z() = 1.2;
  Soil rock = sandy_loam();
  rock.cohesion_pa = 3e5;
  const StationState state = straight(rover, rock, sloping(0, 32));
  EXPECT_EQ(state.outcome, Outcome::kWheelLifted);
  EXPECT_GE(state.wheel, 0);
  EXPECT_LT(state.wheel, 3) << "the left side is uphill";
}

// Random attitudes, uneven wheels, soils and commands: every one gets an answer that balances or a reason.
TEST(QuasiStatic, ThousandsOfRandomStationsGiveABalanceOrAReason) {
  const RoverModel rover = six_wheeler();
  QuasiStaticSolver solver(rover, kMars);
  int moving = 0, given_up = 0;
  constexpr int kTrials = 4000;
  for (int trial = 0; trial < kTrials; ++trial) {
    const auto uniform = [trial](int stream, double low, double high) {
      return low + (high - low) * random_uniform(stream, trial);
    };
    const double amplitude = uniform(1, 0.0, 0.15), phase = uniform(2, 0.0, 6.28);
    const double sx = uniform(3, -0.4, 0.4), sy = uniform(4, -0.4, 0.4);
    const FunctionGround ground([=](double x, double y) {
      return sx * x + sy * y + amplitude * std::sin(2.0 * x + phase) * std::cos(1.5 * y);
    });
    const auto stance = settle(rover, ground, {0.0, 0.0, uniform(5, -3.14, 3.14)});
    if (!stance) continue;
    Soil soil = make_soil({uniform(6, 0.0, 5e4), std::pow(10.0, uniform(7, 4.5, 7.0)), uniform(8, 0.5, 1.4)},
                          std::pow(10.0, uniform(9, 1.0, 4.2)), uniform(10, 15.0, 42.0),
                          uniform(11, 0.005, 0.04), 0.2, 0.3);
    DriveCommand command{.speed_m_s = uniform(12, 0.0, 1.0) < 0.5 ? 0.04 : -0.04,
                         .curvature_1_m = uniform(13, -0.6, 0.6)};
    if (trial % 5 == 0)
      command = {.turn_in_place = true, .turn_rate_rad_s = uniform(14, 0.0, 1.0) < 0.5 ? 0.03 : -0.03};
    const StationState state = solver.solve(*stance, soil, command);
    if (state.outcome == Outcome::kNotConverged) ++given_up;
    ASSERT_TRUE(std::isfinite(state.slip_ratio) && std::isfinite(state.electric_power_w)) << trial;
    for (const WheelState& wheel : state.wheels)
      ASSERT_TRUE(std::isfinite(wheel.load_n) && std::isfinite(wheel.current_a)) << trial;
    if (!state.moving()) continue;
    ++moving;
    for (const WheelState& wheel : state.wheels) ASSERT_GT(wheel.load_n, -1e-6) << trial;
  }
  EXPECT_GT(moving, kTrials / 3);
  EXPECT_LE(given_up, kTrials / 1000) << "the solver may give up on one station in a thousand";
  std::printf("moving %d, given up %d of %d\n", moving, given_up, kTrials);
}

}  // namespace
}  // namespace slipway::sim
