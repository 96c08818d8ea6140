#include "sim/wheel/sliced_wheel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/angle.h"
#include "sim/quasi_static/quasi_static.h"
#include "tests/sim/reference_models.h"

namespace slipway::sim {
namespace {

constexpr WheelGeometry kWheel{0.125, 0.16, {0.01, 24.0}, 0.9};
constexpr WheelMotion kMotion{0.8, 0.1};
constexpr double kSinkage_m = 0.02;

Soil soil_with_effects() {
  Soil soil = sandy_loam();
  soil.exit_angle_ratio = 0.2;
  soil.bulldozing = soil.side_bulldozing = 0.7;
  return soil;
}

// The ground rises by `rise_m` from the right face to the left one.
std::vector<double> tilted(int slices, double rise_m) {
  std::vector<double> height;
  for (int s = 0; s < slices; ++s) height.push_back(rise_m * ((s + 0.5) / slices - 0.5));
  return height;
}

TEST(SlicedWheel, OnLevelGroundTheSlicesTogetherAreTheWholeWheel) {
  for (const double leftward : {-0.1, 0.0, 0.1}) {
    const WheelMotion motion{0.8, leftward};
    const WheelForces whole =
        wheel_forces(kWheel, soil_with_effects(), entry_angle_rad(kWheel.radius_m, kSinkage_m), motion);
    for (int slices = 1; slices <= kMaxSlices; ++slices) {
      const SlicedWheelForces cut =
          sliced_wheel_forces(kWheel, soil_with_effects(), tilted(slices, 0.0), kSinkage_m, motion);
      EXPECT_NEAR(cut.total.drawbar_pull_n, whole.drawbar_pull_n, 1e-11 * whole.vertical_n);
      EXPECT_NEAR(cut.total.lateral_n, whole.lateral_n, 1e-11 * whole.vertical_n);
      EXPECT_NEAR(cut.total.vertical_n, whole.vertical_n, 1e-11 * whole.vertical_n);
      EXPECT_NEAR(cut.total.torque_nm, whole.torque_nm, 1e-11 * whole.vertical_n);
      EXPECT_NEAR(cut.overturning_nm, 0.0, 1e-12 * whole.vertical_n);
    }
  }
}

TEST(SlicedWheel, OnCamberedGroundItsHighSideCarriesMoreAndIsPressedUp) {
  const SlicedWheelForces up =
      sliced_wheel_forces(kWheel, sandy_loam(), tilted(5, 0.02), kSinkage_m, kMotion);
  EXPECT_GT(up.slices[4].vertical_n, 2.0 * up.slices[0].vertical_n);
  EXPECT_GT(up.slices[4].entry_angle_rad, up.slices[0].entry_angle_rad);
  EXPECT_GT(up.overturning_nm, 0.0);
  const SlicedWheelForces mirrored = sliced_wheel_forces(kWheel, sandy_loam(), tilted(5, -0.02), kSinkage_m,
                                                         {kMotion.forward, -kMotion.leftward});
  EXPECT_NEAR(mirrored.overturning_nm, -up.overturning_nm, 1e-12 * up.total.vertical_n);
  EXPECT_NEAR(mirrored.total.lateral_n, -up.total.lateral_n, 1e-11 * up.total.vertical_n);
}

TEST(SlicedWheel, TwiceAsManySlicesComeAQuarterAsFarFromTheManySlicedWheel) {
  const auto moment = [](int slices) {
    return sliced_wheel_forces(kWheel, sandy_loam(), tilted(slices, 0.02), kSinkage_m, kMotion)
        .overturning_nm;
  };
  // The midpoint rule's error falls with the square of the number: this is its limit from 4 and 8 slices.
  const double limit = (4.0 * moment(8) - moment(4)) / 3.0;
  EXPECT_NEAR((moment(2) - limit) / (moment(4) - limit), 4.0, 0.2);
  EXPECT_NEAR(moment(9), limit, 0.02 * limit);
}

TEST(SlicedWheel, HalfOverAStepOnlyTheHalfOnItCarries) {
  const std::vector<double> step{-0.05, -0.05, -0.05, -0.05, 0.0, 0.0, 0.0, 0.0};
  const Soil soil = soil_with_effects();
  const SlicedWheelForces half = sliced_wheel_forces(kWheel, soil, step, kSinkage_m, {0.8, 0.0});
  const SlicedWheelForces level = sliced_wheel_forces(kWheel, soil, tilted(8, 0.0), kSinkage_m, {0.8, 0.0});
  EXPECT_NEAR(half.total.vertical_n, 0.5 * level.total.vertical_n, 1e-11 * level.total.vertical_n);
  EXPECT_NEAR(half.overturning_nm, 0.25 * kWheel.width_m * half.total.vertical_n,
              1e-12 * level.total.vertical_n);
  EXPECT_EQ(half.slices[0].vertical_n, 0.0);
  EXPECT_EQ(half.slices[0].entry_angle_rad, 0.0);
  EXPECT_NEAR(half.slices[7].exit_angle_rad, -0.2 * half.slices[7].entry_angle_rad, 1e-15);
}

TEST(SlicedWheel, OnlyTheFaceThatLeadsIntoTheSoilMeetsItsResistance) {
  // The left half hangs: sliding left there is no wall in the soil, sliding right there is.
  const std::vector<double> right_half{0.0, 0.0, -0.05, -0.05};
  Soil walls = sandy_loam(), none = sandy_loam();
  walls.side_bulldozing = 0.7;
  const auto lateral = [&](const Soil& soil, double leftward) {
    return sliced_wheel_forces(kWheel, soil, right_half, kSinkage_m, {0.8, leftward}).total.lateral_n;
  };
  EXPECT_NEAR(lateral(walls, 0.1), lateral(none, 0.1), 1e-12);
  EXPECT_GT(lateral(walls, -0.1), lateral(none, -0.1) + 0.1);
}

RoverModel sliced(int slices) {
  RoverModel rover = six_wheeler();
  rover.wheel_slices = slices;
  return rover;
}

StationState on(const RoverModel& rover, const Stance& stance) {
  QuasiStaticSolver solver(rover, 3.71);
  return solver.solve(stance, sandy_loam(), {.speed_m_s = 0.04});
}

TEST(SlicedWheelsOfARover, OnAPlaneAreItsWheels) {
  for (const Attitude& attitude : {Attitude{0.0, 0.0, 0.0}, Attitude{0.15, -0.2, 0.3}}) {
    const StationState one = on(sliced(1), stance_on_plane(sliced(1), attitude));
    const StationState five = on(sliced(5), stance_on_plane(sliced(5), attitude));
    EXPECT_NEAR(five.slip_ratio, one.slip_ratio, 1e-7);
    for (std::size_t k = 0; k < one.wheels.size(); ++k)
      EXPECT_NEAR(five.wheels[k].load_n, one.wheels[k].load_n, 1e-5);
  }
}

TEST(SlicedWheelsOfARover, SettledOnAPlaneHaveLevelGroundAcrossThem) {
  const FunctionGround ramp([](double x, double y) { return 0.1 * x + 0.15 * y; });
  const auto stance = settle(sliced(5), ramp, {1.0, 2.0, 0.4});
  ASSERT_TRUE(stance);
  ASSERT_EQ(stance->slice_height_m.size(), 6u);
  for (const auto& heights : stance->slice_height_m)
    for (const double height : heights) EXPECT_NEAR(height, 0.0, 1e-6);
}

TEST(SlicedWheelsOfARover, AcrossARidgeAlongItsTrackCarryOnTheirMiddle) {
  // Both tracks run along the crest of a ridge 2 cm high and 8 cm to either side.
  const auto ridge = [](double, double y) {
    const double off = std::abs(std::abs(y) - 0.53);
    return std::max(0.0, 0.02 * (1.0 - off / 0.08));
  };
  RoverModel one = sliced(1);
  for (WheelModel& wheel : one.wheels) wheel.position_m.y() = wheel.side == Side::kLeft ? 0.53 : -0.53;
  RoverModel five = one;
  five.wheel_slices = 5;
  const auto whole = settle(one, FunctionGround(ridge), {0.0, 0.0, 0.0});
  const auto cut = settle(five, FunctionGround(ridge), {0.0, 0.0, 0.0});
  ASSERT_TRUE(whole && cut);
  EXPECT_LT(cut->slice_height_m[0][0], cut->slice_height_m[0][2] - 0.005);
  const StationState on_whole = on(one, *whole), on_cut = on(five, *cut);
  ASSERT_TRUE(on_whole.moving() && on_cut.moving());
  // On the narrow part of the wheel that carries it sinks deeper.
  EXPECT_GT(on_cut.wheels[0].sinkage_m, 1.1 * on_whole.wheels[0].sinkage_m);
}

TEST(SlicedWheelsOfARover, OnRoughGroundChangeTheAnswerByTheStatedAmount) {
  const FunctionGround rough([](double x, double y) {
    return 0.03 * std::sin(5.0 * x) * std::cos(7.0 * y) + 0.01 * std::sin(23.0 * y + 3.0 * x);
  });
  const RoverModel one = sliced(1), five = sliced(5);
  double slip = 0.0, current = 0.0, largest = 0.0;
  int moving = 0;
  for (int k = 0; k < 60; ++k) {
    const Pose2 pose{0.11 * k, 0.07 * k, 0.05 * k};
    const auto whole = settle(one, rough, pose), cut = settle(five, rough, pose);
    if (!whole || !cut) continue;
    const StationState a = on(one, *whole), b = on(five, *cut);
    if (!a.moving() || !b.moving()) continue;
    ++moving;
    slip = std::max(slip, std::abs(a.slip_ratio - b.slip_ratio));
    for (std::size_t w = 0; w < a.wheels.size(); ++w) {
      current = std::max(current, std::abs(a.wheels[w].current_a - b.wheels[w].current_a));
      largest = std::max(largest, a.wheels[w].current_a);
    }
  }
  std::cout << "five slices instead of one on rough ground, " << moving << " stations: slip differs by up to "
            << slip << ", a wheel's current by up to " << current << " A of " << largest << " A\n";
  EXPECT_GT(moving, 40);
  EXPECT_GT(slip, 1e-4);
  EXPECT_LT(slip, 0.2);
}

}  // namespace
}  // namespace slipway::sim
