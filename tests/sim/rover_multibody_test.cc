#include "sim/dynamic/rover_multibody.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.h"
#include "sim/rover/suspension.h"
#include "tests/sim/reference_models.h"

namespace slipway::sim {
namespace {

std::vector<RoverModel> vehicles() {
  return {six_wheeler(),
          all_steered(six_wheeler()),
          four_wheeler(SuspensionType::kAveraging),
          four_wheeler(SuspensionType::kRigid),
          three_wheeler(),
          even_wheeler(SuspensionType::kRigid, 6)};
}

TEST(RoverMultibody, HasTheRoversMassAndCentreOfMass) {
  for (const RoverModel& rover : vehicles()) {
    const RoverMultibody bodies = rover_multibody(rover);
    MultibodyDynamics dynamics(bodies.tree);
    const std::vector<double> zero(bodies.tree.joint_count(), 0.0);
    dynamics.set_state(Eigen::Matrix3d::Identity(), SpatialVector::Zero(), zero.data(), zero.data());
    EXPECT_NEAR(bodies.tree.mass_kg(), rover.mass_kg, 1e-9 * rover.mass_kg);
    EXPECT_NEAR((dynamics.com_B() - rover.com_m).norm(), 0.0, 1e-12) << rover.name;
  }
}

// The joints are those of the other fidelity levels: wheel centres agree with the suspension's at any angles.
TEST(RoverMultibody, PutsItsWheelsWhereTheSuspensionDoes) {
  for (const RoverModel& rover : vehicles()) {
    const RoverMultibody bodies = rover_multibody(rover);
    MultibodyDynamics dynamics(bodies.tree);
    for (std::uint64_t n = 0; n < 20; ++n) {
      Stance stance;
      const auto angle = [&](std::uint64_t i) { return random_uniform(random_key(3, n), i) - 0.5; };
      if (bodies.rocker[0] >= 0) stance.rocker_rad = angle(0);
      if (bodies.bogie[0] >= 0) stance.bogie_rad = {angle(1), angle(2)};
      place_wheels(rover, stance);
      std::vector<double> angles(bodies.tree.joint_count(), 0.0), rates(angles);
      for (int s = 0; s < 2; ++s) {
        if (bodies.rocker[s] >= 0) angles[bodies.rocker[s]] = s == 0 ? stance.rocker_rad : -stance.rocker_rad;
        if (bodies.bogie[s] >= 0) angles[bodies.bogie[s]] = stance.bogie_rad[s];
      }
      for (const int joint : bodies.steering)
        if (joint >= 0) angles[joint] = angle(5);
      dynamics.set_state(Eigen::Matrix3d::Identity(), SpatialVector::Zero(), angles.data(), rates.data());
      for (std::size_t k = 0; k < rover.wheels.size(); ++k)
        EXPECT_NEAR((dynamics.pivot_B(bodies.wheel[k]) - stance.p_B_wheel[k]).norm(), 0.0, 1e-12);
    }
  }
}

TEST(RoverMultibody, WeldsALockedWheel) {
  RoverModel rover = six_wheeler();
  rover.wheels[3].drive = WheelDrive::kLocked;
  const RoverMultibody bodies = rover_multibody(rover);
  MultibodyDynamics dynamics(bodies.tree);
  const std::vector<double> zero(bodies.tree.joint_count(), 0.0);
  dynamics.set_state(Eigen::Matrix3d::Identity(), SpatialVector::Zero(), zero.data(), zero.data());
  dynamics.add_torque(bodies.wheel[3], 100.0);
  dynamics.add_torque(bodies.wheel[0], 100.0);
  SpatialVector base;
  std::vector<double> accelerations(zero);
  dynamics.accelerations(Eigen::Vector3d(0.0, 0.0, -3.71), base, accelerations.data());
  EXPECT_EQ(accelerations[bodies.wheel[3]], 0.0);
  EXPECT_GT(accelerations[bodies.wheel[0]], 1.0);
}

TEST(RoverMultibody, TakesGivenMassesInPlaceOfItsShares) {
  RoverModel rover = six_wheeler();
  rover.masses.wheel_kg = 4.0;
  rover.masses.rocker_kg = 5.0;
  rover.masses.bogie_kg = 2.0;
  EXPECT_NEAR(rover.body_mass_kg(), 174.0 - 24.0 - 10.0 - 4.0, 1e-12);
  rover.masses.wheel_kg = 40.0;
  EXPECT_THROW(rover_multibody(rover), std::invalid_argument);
}

}  // namespace
}  // namespace slipway::sim
