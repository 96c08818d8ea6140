#pragma once

#include <Eigen/Core>
#include <array>

#include "hidden_truth.h"
#include "wheel_contact.h"

namespace slipway::gap_benchmark {

constexpr int kWheels = 6;
constexpr std::array<const char*, kWheels> kWheelNames{"lf", "lm", "lr", "rf", "rm", "rr"};

// The rover as its operators know it, with x forward, y left and z up from the ground under the centre.
struct RoverOnFile {
  double mass_kg = 174.0;
  Eigen::Vector3d com_m{-0.03, 0.0, 0.38};
  std::array<Eigen::Vector2d, kWheels> wheel_m{Eigen::Vector2d{0.7, 0.53},  {0.0, 0.61},  {-0.7, 0.53},
                                               Eigen::Vector2d{0.7, -0.53}, {0.0, -0.61}, {-0.7, -0.53}};
  double radius_m = 0.125, width_m = 0.16;
  Eigen::Vector3d rocker_pivot_m{0.12, 0.45, 0.42}, bogie_pivot_m{-0.35, 0.55, 0.30};
  double torque_constant_nm_a = 0.0224, gear_ratio = 1500.0, gear_efficiency = 0.55, no_load_a = 0.06;
};

// The ground under a wheel, and the wheel's commands.
struct WheelPlace {
  double height_m = 0.0;                // of the ground above the body's ground plane
  double grade_x = 0.0, grade_y = 0.0;  // of the ground, in the body's frame
  double rate_rad_s = 0.0, steer_rad = 0.0;
  double pull_n = 0.0;  // along the body, at the axle, from outside
  ContactSoil soil;
};

struct BalanceTask {
  Eigen::Vector3d gravity_m_s2{0.0, 0.0, -3.71};  // in the body's frame
  Eigen::Vector3d pull_n = Eigen::Vector3d::Zero(), pull_at_m = Eigen::Vector3d::Zero();
  std::array<WheelPlace, kWheels> wheels;
};

struct BalanceState {
  double forward_m_s = 0.0, left_m_s = 0.0, yaw_rate_rad_s = 0.0;
  std::array<double, kWheels> depth_m{0.012, 0.012, 0.012, 0.012, 0.012, 0.012};
  std::array<WheelLoads, kWheels> loads;
  bool held = false;  // true where no motion balances the forces, so that the rover stands
};

// Finds the motion and sinkages at which the soil's forces by a wheel law, the weight and the linkage
// balance: three forces, three moments, both bogies and the differential, by Newton's method on nine
// unknowns. It starts from `state`.
bool balance_rover(const RoverOnFile& rover, const BalanceTask& task, const WheelLaw& law,
                   const Closure& closure, const HiddenTruth& hidden, BalanceState& state);

}  // namespace slipway::gap_benchmark
