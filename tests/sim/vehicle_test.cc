// Rovers on other wheels and suspensions than six on a rocker-bogie.
#include <gtest/gtest.h>

#include <cmath>

#include "core/angle.h"
#include "core/random.h"
#include "sim/quasi_static/quasi_static.h"
#include "sim/rover/suspension.h"
#include "tests/sim/reference_models.h"

namespace slipway::sim {
namespace {

constexpr double kMars = 3.71;

Attitude sloping(double pitch_deg, double roll_deg) {
  return {.roll_rad = rad_from_deg(roll_deg), .pitch_rad = rad_from_deg(pitch_deg), .yaw_rad = 0.0};
}

// Stiff enough that sinkage hardly moves the wheels' points of contact.
Soil firm_soil() {
  Soil soil = sandy_loam();
  soil.pressure.k_phi = 2e8;
  soil.cohesion_pa = 2e4;
  return soil;
}

StationState straight(const RoverModel& rover, const Stance& stance, const Soil& soil) {
  QuasiStaticSolver solver(rover, kMars);
  return solver.solve(stance, soil, {.speed_m_s = 0.04});
}

double carried_n(const StationState& state) {
  double sum = 0.0;
  for (const WheelState& wheel : state.wheels) sum += wheel.load_n;
  return sum;
}

// Loads of four wheels at (+-l/2, +-b/2) on a slope: a quarter of the weight's normal share each, moved
// downhill by the slope's share at the height of the centre of mass,
//
//   W cos / 4  +- W h g_x / (2 l)  +- W h g_y / (2 b)
//
// (statics; the moments that drive the wheels move load too, by T / l in all: they are taken from the state).
TEST(FourWheeler, LoadsOnASlopeAreThoseOfStatics) {
  for (const SuspensionType type : {SuspensionType::kAveraging, SuspensionType::kRigid}) {
    const RoverModel rover = four_wheeler(type);
    const Attitude attitude = sloping(-10, 7);
    const Stance stance = stance_on_plane(rover, attitude);
    const StationState state = straight(rover, stance, firm_soil());
    ASSERT_TRUE(state.moving());
    const double weight = rover.mass_kg * kMars, length = 1.4, width = 1.0;
    const Eigen::Vector3d g = -stance.R_MB.row(2).transpose() * weight;
    double torque = 0.0, pull_moment = 0.0;
    for (const WheelState& wheel : state.wheels) {
      torque += wheel.torque_nm;
      // The pull acts at the wheels' centres with the torque about them, the lateral force on the ground.
      pull_moment += wheel.drawbar_pull_n * 0.125;
    }
    const double to_rear = (-g.x() * 0.35 + torque - pull_moment) / length / 2.0;
    const double to_right = g.y() * -0.35 / width / 2.0;
    for (int k = 0; k < 4; ++k) {
      const double expected =
          -g.z() / 4.0 + (k % 2 == 1 ? to_rear : -to_rear) + (k >= 2 ? to_right : -to_right);
      // The sides' torques differ with their loads, which twists the loads by a little on either diagonal.
      EXPECT_NEAR(state.wheels[k].load_n, expected, 0.003 * weight)
          << k << " of suspension " << static_cast<int>(type);
    }
    EXPECT_NEAR(carried_n(state), -g.z(), 1e-5);
  }
}

TEST(FourWheeler, AnAveragingSuspensionBalancesTheMomentsOfBothSidesAboutTheirPivots) {
  const RoverModel rover = four_wheeler(SuspensionType::kAveraging);
  const Stance stance = stance_on_plane(rover, sloping(-6, 8));
  const StationState state = straight(rover, stance, sandy_loam());
  ASSERT_TRUE(state.moving());
  const auto moment = [&](int k) {
    const WheelState& w = state.wheels[k];
    const Eigen::Vector3d pivot(0.0, k < 2 ? 0.4 : -0.4, 0.4);
    const Eigen::Vector3d force(w.drawbar_pull_n, w.lateral_force_n, w.load_n);
    return (stance.p_B_wheel[k] - pivot).cross(force).y() - w.torque_nm;
  };
  EXPECT_NEAR(moment(0) + moment(1), moment(2) + moment(3), 1e-5);
}

TEST(FourWheeler, RigidOnAPlaneTheWheelsSinkTogether) {
  const RoverModel rover = four_wheeler(SuspensionType::kRigid);
  const StationState state = straight(rover, stance_on_plane(rover, sloping(-5, 6)), sandy_loam());
  ASSERT_TRUE(state.moving());
  const auto depth = [&](int k) { return state.wheels[k].sinkage_m; };
  EXPECT_NEAR(depth(0) - depth(1), depth(2) - depth(3), 1e-9) << "four rims in one plane";
}

// A hollow under the left front wheel, deeper than the others sink.
TEST(FourWheeler, RigidOverAHollowOneWheelHangsAndThreeCarryAll) {
  RoverModel rover = four_wheeler(SuspensionType::kRigid);
  rover.com_m = {-0.05, -0.05, 0.35};
  const FunctionGround ground([](double x, double y) { return x > 0.4 && y > 0.2 ? -0.2 : 0.0; });
  const auto stance = settle(rover, ground, {0.0, 0.0, 0.0});
  ASSERT_TRUE(stance);
  const StationState state = straight(rover, *stance, sandy_loam());
  ASSERT_TRUE(state.moving()) << describe(state.outcome);
  EXPECT_TRUE(state.wheels[0].in_air);
  EXPECT_EQ(state.wheels[0].load_n, 0.0);
  EXPECT_EQ(state.wheels[0].sinkage_m, 0.0);
  for (int k = 1; k < 4; ++k) {
    EXPECT_FALSE(state.wheels[k].in_air);
    EXPECT_GT(state.wheels[k].load_n, 0.0);
  }
  EXPECT_GT(carried_n(state), 0.98 * rover.mass_kg * kMars);
}

TEST(FourWheeler, RigidOverAShallowHollowAllWheelsCarryAndTheOneInItLess) {
  const RoverModel rover = four_wheeler(SuspensionType::kRigid);
  const FunctionGround ground([](double x, double y) { return x > 0.4 && y > 0.2 ? -0.004 : 0.0; });
  const auto stance = settle(rover, ground, {0.0, 0.0, 0.0});
  ASSERT_TRUE(stance);
  const StationState state = straight(rover, *stance, sandy_loam());
  ASSERT_TRUE(state.moving());
  for (const WheelState& wheel : state.wheels) EXPECT_FALSE(wheel.in_air);
  EXPECT_LT(state.wheels[0].load_n, 0.8 * state.wheels[2].load_n);
}

TEST(FourWheeler, AnAveragingSuspensionKeepsAllWheelsOnTheGroundOverAHollow) {
  const RoverModel rover = four_wheeler(SuspensionType::kAveraging);
  const FunctionGround ground([](double x, double y) { return x > 0.4 && y > 0.2 ? -0.1 : 0.0; });
  const auto stance = settle(rover, ground, {0.0, 0.0, 0.0});
  ASSERT_TRUE(stance);
  for (const double gap : stance->gap_m) EXPECT_NEAR(gap, 0.0, 1e-6);
  EXPECT_GT(stance->rocker_rad, 0.01) << "the left rocker turns nose down";
  const StationState state = straight(rover, *stance, sandy_loam());
  ASSERT_TRUE(state.moving());
  for (const WheelState& wheel : state.wheels) EXPECT_GT(wheel.load_n, 50.0);
}

TEST(FourWheeler, RigidOnAPlaneSettlesLikeThePlanesClosedForm) {
  const FunctionGround ground([](double x, double y) { return 0.2 * x - 0.1 * y; });
  for (const SuspensionType type : {SuspensionType::kAveraging, SuspensionType::kRigid}) {
    const RoverModel rover = four_wheeler(type);
    const auto settled = settle(rover, ground, {0.0, 0.0, 0.4});
    ASSERT_TRUE(settled);
    const Stance closed = stance_on_plane(rover, settled->attitude);
    for (int k = 0; k < 4; ++k) {
      EXPECT_LT((settled->p_B_wheel[k] - closed.p_B_wheel[k]).norm(), 1e-6);
      EXPECT_LT((settled->normal_B[k] - closed.normal_B[k]).norm(), 1e-6);
      EXPECT_NEAR(settled->gap_m[k], 0.0, 1e-6);
    }
  }
}

TEST(ThreeWheeler, LoadsAreThoseOfATripod) {
  const RoverModel rover = three_wheeler();
  const StationState state = straight(rover, stance_on_plane(rover, {}), firm_soil());
  ASSERT_TRUE(state.moving());
  const double weight = rover.mass_kg * kMars;
  double turning = 0.0;  // moment of torques and pulls about y
  for (const WheelState& wheel : state.wheels) turning += wheel.torque_nm - 0.125 * wheel.drawbar_pull_n;
  const double tail = (weight * (0.7 - 0.2) + turning) / 1.4;
  EXPECT_NEAR(state.wheels[2].load_n, tail, 1e-4);
  EXPECT_NEAR(state.wheels[0].load_n, 0.5 * (weight - tail), 1e-4);
  EXPECT_NEAR(state.wheels[0].load_n, state.wheels[1].load_n, 1e-4);
}

TEST(EightWheeler, RigidTheSinkagesOfASideLieOnAStraightLine) {
  const RoverModel rover = even_wheeler(SuspensionType::kRigid, 4);
  EXPECT_EQ(undetermined_loads(rover), 5);
  const StationState state = straight(rover, stance_on_plane(rover, sloping(-8, 4)), sandy_loam());
  ASSERT_TRUE(state.moving());
  const double slope = state.wheels[1].sinkage_m - state.wheels[0].sinkage_m;
  EXPECT_GT(slope, 0.0) << "uphill the rear carries more";
  for (const int k : {2, 3, 5, 6, 7})
    EXPECT_NEAR(state.wheels[k].sinkage_m - state.wheels[k - 1].sinkage_m - (k == 4 ? 0.0 : slope), 0.0, 1e-8)
        << k;
  EXPECT_NEAR(carried_n(state), rover.mass_kg * kMars * std::cos(sloping(-8, 4).tilt_rad()), 1e-4);
}

TEST(EightWheeler, OverACrestTheEndWheelsHangAndTheMiddleOnesCarry) {
  const RoverModel rover = even_wheeler(SuspensionType::kRigid, 4);
  const FunctionGround ground([](double x, double) { return std::abs(x) > 0.5 ? -0.1 : 0.0; });
  const auto stance = settle(rover, ground, {0.0, 0.0, 0.0});
  ASSERT_TRUE(stance);
  const StationState state = straight(rover, *stance, sandy_loam());
  ASSERT_TRUE(state.moving()) << describe(state.outcome);
  for (const int k : {0, 3, 4, 7}) EXPECT_TRUE(state.wheels[k].in_air) << k;
  for (const int k : {1, 2, 5, 6}) EXPECT_GT(state.wheels[k].load_n, 0.0) << k;
}

// A wrong attitude on level ground and a slope are the same to the wheels: gravity is all that differs.
TEST(AttitudeBias, OnLevelGroundIsASlopeExactly) {
  for (const auto& [pitch, roll] : {std::pair{-8.0, 0.0}, {0.0, 6.0}, {5.0, -4.0}}) {
    RoverModel biased = six_wheeler();
    biased.pitch_bias_rad = rad_from_deg(pitch);
    biased.roll_bias_rad = rad_from_deg(roll);
    const StationState a = straight(biased, stance_on_plane(biased, {}), sandy_loam());
    const StationState b =
        straight(six_wheeler(), stance_on_plane(six_wheeler(), sloping(pitch, roll)), sandy_loam());
    ASSERT_TRUE(a.moving());
    EXPECT_NEAR(a.slip_ratio, b.slip_ratio, 1e-8);
    EXPECT_NEAR(a.side_slip_rad, b.side_slip_rad, 1e-8);
    for (int k = 0; k < 6; ++k) EXPECT_NEAR(a.wheels[k].load_n, b.wheels[k].load_n, 1e-4);
  }
}

// A random rover of 3 to 8 wheels on any suspension that fits their number, with some wheels dead.
RoverModel random_rover(int trial) {
  const auto uniform = [trial](int stream, double low, double high) {
    return low + (high - low) * random_uniform(100 + stream, trial);
  };
  const int kind = static_cast<int>(uniform(1, 0.0, 6.0));
  RoverModel rover = kind == 0   ? six_wheeler()
                     : kind == 1 ? three_wheeler()
                     : kind == 2 ? four_wheeler(SuspensionType::kAveraging)
                     : kind == 3 ? even_wheeler(SuspensionType::kAveraging, 3)
                                 : even_wheeler(SuspensionType::kRigid, kind == 4 ? 2 : 4);
  for (std::size_t k = 0; k < rover.wheels.size(); ++k) {
    WheelModel& wheel = rover.wheels[k];
    const int stream = 10 + 10 * static_cast<int>(k);
    const double fate = uniform(stream, 0.0, 1.0);
    if (fate < 0.06) wheel.drive = WheelDrive::kLocked;
    if (fate > 0.94) wheel.drive = WheelDrive::kFree;
    wheel.drag_nm = uniform(stream + 1, 0.0, 0.5);
    wheel.rate_share = uniform(stream + 2, 0.8, 1.0);
    wheel.steering_offset_rad = uniform(stream + 3, -0.05, 0.05);
    wheel.steerable = uniform(2, 0.0, 1.0) < 0.5;
  }
  rover.pitch_bias_rad = uniform(3, -0.03, 0.03);
  rover.com_m.z() = uniform(4, 0.2, 0.6);
  return rover;
}

DriveCommand random_command(int trial) {
  const auto uniform = [trial](int stream, double low, double high) {
    return low + (high - low) * random_uniform(300 + stream, trial);
  };
  DriveCommand command;
  command.speed_m_s = uniform(1, 0.0, 1.0) < 0.5 ? 0.04 : -0.04;
  command.curvature_1_m = uniform(2, -0.6, 0.6);
  if (trial % 3 == 0) command.crab_rad = uniform(3, -1.6, 1.6);
  command.turn_in_place = trial % 5 == 0;
  command.turn_rate_rad_s = uniform(4, 0.0, 1.0) < 0.5 ? 0.03 : -0.03;
  command.motor_temp_c = uniform(5, -60.0, 60.0);
  return command;
}

TEST(RandomRovers, EveryStationGivesFiniteNumbersOrAReason) {
  int moving = 0, given_up = 0, hanging = 0, stood = 0;
  constexpr int kTrials = 3000;
  for (int trial = 0; trial < kTrials; ++trial) {
    const auto uniform = [trial](int stream, double low, double high) {
      return low + (high - low) * random_uniform(stream, trial);
    };
    const RoverModel rover = random_rover(trial);
    const double amplitude = uniform(1, 0.0, 0.1), phase = uniform(2, 0.0, 6.28);
    const double sx = uniform(3, -0.3, 0.3), sy = uniform(4, -0.3, 0.3);
    const FunctionGround ground([=](double x, double y) {
      return sx * x + sy * y + amplitude * std::sin(2.0 * x + phase) * std::cos(1.5 * y);
    });
    const auto stance = settle(rover, ground, {0.0, 0.0, uniform(5, -3.14, 3.14)});
    if (!stance) continue;
    ++stood;
    Soil soil = make_soil({uniform(6, 0.0, 5e4), std::pow(10.0, uniform(7, 5.0, 7.0)), uniform(8, 0.5, 1.4)},
                          std::pow(10.0, uniform(9, 1.0, 4.2)), uniform(10, 20.0, 42.0),
                          uniform(11, 0.005, 0.04), 0.2, 0.3);
    soil.multipass_stiffening = uniform(12, 0.0, 1.0) < 0.5 ? 0.0 : uniform(13, 0.0, 5.0);
    soil.multipass_strengthening = uniform(30, 0.0, 0.5);
    QuasiStaticSolver solver(rover, kMars);
    const StationState state = solver.solve(*stance, soil, random_command(trial));
    given_up += state.outcome == Outcome::kNotConverged ? 1 : 0;
    ASSERT_EQ(state.wheels.size(), rover.wheels.size());
    ASSERT_TRUE(std::isfinite(state.slip_ratio) && std::isfinite(state.side_slip_rad)) << trial;
    ASSERT_TRUE(std::isfinite(state.electric_power_w) && std::isfinite(state.left_rut_depth_m)) << trial;
    bool hangs = false;
    for (const WheelState& wheel : state.wheels) {
      ASSERT_TRUE(std::isfinite(wheel.load_n) && std::isfinite(wheel.current_a)) << trial;
      ASSERT_TRUE(std::isfinite(wheel.rate_rad_s) && std::isfinite(wheel.sinkage_m)) << trial;
      ASSERT_TRUE(!state.moving() || wheel.load_n > -1e-6) << trial;
      hangs = hangs || wheel.in_air;
    }
    moving += state.moving() ? 1 : 0;
    hanging += hangs ? 1 : 0;
  }
  std::printf("stood %d, moving %d, with a wheel in the air %d, given up %d of %d\n", stood, moving, hanging,
              given_up, kTrials);
  EXPECT_GT(moving, kTrials / 3);
  EXPECT_GT(hanging, 20);
  EXPECT_LE(given_up, kTrials / 100);
}

}  // namespace
}  // namespace slipway::sim
