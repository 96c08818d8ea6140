// The body leans as its wheels sink unequally: closed forms, and the same at every level of fidelity.
#include <gtest/gtest.h>

#include <cmath>

#include "core/angle.h"
#include "sim/quasi_static/quasi_static.h"
#include "sim/rover/stance.h"
#include "tests/sim/dynamic_drives.h"

namespace slipway::sim {
namespace {

constexpr double kWithin_rad = rad_from_deg(0.01);

// Mean depth of the wheels for which the question is answered with yes.
template <class Which>
double mean_depth_m(const RoverModel& rover, const StationState& state, Which which) {
  double sum = 0.0;
  int count = 0;
  for (std::size_t k = 0; k < rover.wheels.size(); ++k) {
    if (!which(rover.wheels[k])) continue;
    sum += state.wheels[k].sinkage_m;
    ++count;
  }
  return sum / count;
}

bool is_left(const WheelModel& wheel) {
  return wheel.side == Side::kLeft;
}
bool is_front(const WheelModel& wheel) {
  return wheel.position_m.x() > 0.0;
}

PerWheel<Soil> softer_on_the_left(const RoverModel& rover) {
  PerWheel<Soil> soils(rover.wheels.size(), sandy_loam());
  for (std::size_t k = 0; k < soils.size(); ++k)
    if (is_left(rover.wheels[k])) soils[k] = loose_sand();
  return soils;
}

StationState level(const RoverModel& rover, const PerWheel<Soil>& soils) {
  QuasiStaticSolver solver(rover, kMars);
  const StationState state = solver.solve(stance_on_plane(rover, {}), soils, {.speed_m_s = 0.04});
  EXPECT_TRUE(state.moving());
  return state;
}

TEST(BodyLean, ASoftPatchUnderTheLeftWheelsRollsTheBodyByTheDepthsOverTheTrack) {
  for (const SuspensionType suspension : {SuspensionType::kRigid, SuspensionType::kAveraging}) {
    const RoverModel rover = even_wheeler(suspension, 2);
    const StationState state = level(rover, softer_on_the_left(rover));
    const double left = mean_depth_m(rover, state, is_left);
    const double right = mean_depth_m(rover, state, [](const WheelModel& w) { return !is_left(w); });
    EXPECT_GT(left - right, 0.005);
    // Positive roll is left side up.
    EXPECT_NEAR(state.attitude.roll_rad, -std::atan((left - right) / rover.track_m()), 1e-5);
  }
}

TEST(BodyLean, AHeavierFrontSinksDeeperAndPitchesTheBody) {
  RoverModel rover = even_wheeler(SuspensionType::kRigid, 2);
  const double wheelbase_m = rover.wheels[0].position_m.x() - rover.wheels[1].position_m.x();
  rover.com_m.x() = 0.25 * wheelbase_m;
  const StationState state = level(rover, PerWheel<Soil>(4, loose_sand()));
  const double front = mean_depth_m(rover, state, is_front);
  const double rear = mean_depth_m(rover, state, [](const WheelModel& w) { return !is_front(w); });
  EXPECT_GT(front - rear, 0.005);
  // Positive pitch is nose down.
  EXPECT_NEAR(state.attitude.pitch_rad, std::atan((front - rear) / wheelbase_m), 1e-5);
  EXPECT_NEAR(state.attitude.roll_rad, 0.0, 1e-9);
}

TEST(BodyLean, WheelsThatSinkAlikeLeaveTheBodyLevel) {
  // All wheels are free of torque about the body's y axis where the load is central and the body low.
  RoverModel rover = even_wheeler(SuspensionType::kRigid, 2);
  rover.com_m.z() = 0.0;
  Soil hard = sandy_loam();
  hard.pressure.k_phi *= 1e4;
  hard.pressure.k_c *= 1e4;
  const StationState state = level(rover, PerWheel<Soil>(4, hard));
  EXPECT_NEAR(state.attitude.roll_rad, 0.0, 1e-9);
  EXPECT_NEAR(state.attitude.pitch_rad, 0.0, rad_from_deg(0.002));
}

// A rover on a slip curve, or without a balance, shows the stance's attitude.
TEST(BodyLean, IsNotMadeUpWhereSinkagesAreNotKnown) {
  const RoverModel rover = six_wheeler();
  const Stance stance = stance_on_plane(rover, {.pitch_rad = -rad_from_deg(35.0)});
  QuasiStaticSolver solver(rover, kMars);
  const StationState stuck = solver.solve(stance, loose_sand(), {.speed_m_s = 0.04});
  ASSERT_FALSE(stuck.moving());
  EXPECT_EQ(stuck.attitude.pitch_rad, stance.attitude.pitch_rad);
}

// A slope up to the east, with other ground under the left wheels of a rover that drives east.
FunctionGround divided_slope(double tilt_rad) {
  return FunctionGround([slope = std::tan(tilt_rad)](double x, double) { return slope * x; }, 1e6,
                        [](double, double y) { return std::optional<std::size_t>(y > 0.0 ? 1 : 0); });
}

struct Slope {
  const char* name;
  double tilt_deg, yaw_deg, com_x_m;
  bool half_soft;
};

class LeanOfLevels : public testing::TestWithParam<Slope> {};

// The balance's body and the one that stands on its wheels by integration in time lean alike. Stances differ
// by the loads that the lean shifts, see SlowLimit.
TEST_P(LeanOfLevels, IsTheSameInTheBalanceAndInMotion) {
  const Slope& at = GetParam();
  for (const bool rigid : {false, true}) {
    RoverModel rover = rigid ? even_wheeler(SuspensionType::kRigid, 2) : light_suspension(six_wheeler());
    rover.masses.wheel_kg = 1e-3;
    rover.com_m.x() = at.com_x_m;
    const DriveSoils soils{{sandy_loam(), at.half_soft ? loose_sand() : sandy_loam()}, sandy_loam()};
    const FunctionGround ground = divided_slope(rad_from_deg(at.tilt_deg));
    DynamicOptions options{.relative_tolerance = 1e-7, .feedback = Feedback::kNone, .sample_interval_s = 0.5};
    options.contact_points = 1;
    Driven driven;
    NoProgress progress;
    auto drive = simulate_drive(
        rover, kMars, ground, soils, {0.0, 0.0, rad_from_deg(at.yaw_deg)}, std::vector{straight(1.0)},
        options, [&](const DriveSample& sample) { driven.samples.push_back(sample); }, progress);
    ASSERT_TRUE(drive);
    const DriveSample& sample = driven.cruising();
    const auto stance = settle(rover, ground, {sample.p_MB.x(), sample.p_MB.y(), sample.attitude.yaw_rad});
    ASSERT_TRUE(stance);
    PerWheel<Soil> under(rover.wheels.size());
    for (std::size_t k = 0; k < under.size(); ++k) {
      const Eigen::Vector3d p = stance->p_MB + stance->R_MB * stance->p_B_wheel[k];
      under[k] = soils.of(ground.soil_at(p.x(), p.y()));
    }
    QuasiStaticSolver solver(rover, kMars);
    const StationState balance = solver.solve(*stance, under, straight(1.0).command);
    ASSERT_TRUE(balance.moving());
    const double lean = std::hypot(balance.attitude.roll_rad - stance->attitude.roll_rad,
                                   balance.attitude.pitch_rad - stance->attitude.pitch_rad);
    const double within = kWithin_rad + 0.03 * lean;
    EXPECT_NEAR(sample.attitude.roll_rad, balance.attitude.roll_rad, within) << rigid << " lean " << lean;
    EXPECT_NEAR(sample.attitude.pitch_rad, balance.attitude.pitch_rad, within) << rigid << " lean " << lean;
    if (at.half_soft) {
      EXPECT_GT(lean, rad_from_deg(0.3)) << rigid;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Slopes, LeanOfLevels,
    testing::Values(Slope{"level", 0.0, 0.0, 0.0, false}, Slope{"front_heavy", 0.0, 0.0, 0.2, false},
                    Slope{"up", 12.0, 0.0, 0.0, false}, Slope{"down", 12.0, 180.0, 0.0, false},
                    Slope{"across", 10.0, 90.0, 0.0, false}, Slope{"askew", 10.0, 40.0, 0.1, false},
                    Slope{"half_soft", 0.0, 0.0, 0.0, true}, Slope{"half_soft_up", 6.0, 0.0, 0.0, true}),
    [](const auto& named) { return std::string(named.param.name); });

}  // namespace
}  // namespace slipway::sim
