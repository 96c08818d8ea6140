#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "core/result.h"

namespace slipway::sim {

enum class Side { kLeft, kRight };

// A rigid wheel. Frame B: x forward, y left, z up, origin on the ground under the wheels' centre at rest.
struct WheelModel {
  std::string name;  // lf lm lr rf rm rr
  Eigen::Vector3d position_m =
      Eigen::Vector3d::Zero();  // of the wheel's centre in B, at rest on level ground
  double radius_m = 0.125;
  double width_m = 0.16;
  bool steerable = false;
  Side side = Side::kLeft;
  bool on_bogie = false;  // carried by the side's bogie, otherwise by its rocker
};

// Rocker-bogie with a differential: the rockers turn against each other about their pivots, each carries one
// wheel and a bogie with the two others. Left side given; right mirrored in y.
struct RockerBogie {
  Eigen::Vector3d rocker_pivot_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d bogie_pivot_m = Eigen::Vector3d::Zero();
};

// Drive motor and gear of every wheel: I = T / (k_t N eta) + I_0 sign(rate).
struct DriveMotor {
  double torque_constant_nm_per_a = 0.0224;
  double gear_ratio = 1500.0;
  double gear_efficiency = 0.55;
  double no_load_current_a = 0.06;
  double max_wheel_rate_rad_s = 0.4;
  double bus_voltage_v = 28.0;
  std::optional<double> resistance_ohm;
  std::optional<double> max_current_a;  // a wheel that needs more is stalled
};

// A six-wheel rover: immutable once built, shared by pointer.
struct RoverModel {
  std::string name;
  std::string summary;
  std::vector<std::string> sources;
  std::vector<std::string> assumed;  // names of parameters that no source gives
  double mass_kg = 0.0;
  Eigen::Vector3d com_m = Eigen::Vector3d::Zero();
  std::vector<WheelModel> wheels;  // six, three a side
  RockerBogie suspension;
  DriveMotor drive;
  double belly_clearance_m = 0.3;  // lowest point of the body between the wheels, above level ground
  double body_length_m = 1.6;      // of the rectangle that must stay on the map and out of keep-outs
  double body_width_m = 1.5;
  double max_tilt_rad = 0.5;
  double cruise_speed_m_s = 0.04;  // of the body, commanded on the straight
  double turn_rate_rad_s = 0.03;   // commanded, turning in place
  double min_turn_radius_m = 1.5;  // of an arc

  double smallest_wheel_radius_m() const;
  double track_m() const;  // widest distance between left and right wheel centres
};

// Everything that a model must satisfy before it is used: six wheels named lf lm lr rf rm rr, three a side,
// two of each side on its bogie, masses, radii, efficiencies in range, the centre of mass inside the wheels.
// Returns every fault; pointers are those of the rover file ("/wheels/2/radius_m").
std::vector<Fault> faults_of(const RoverModel& rover);

}  // namespace slipway::sim
