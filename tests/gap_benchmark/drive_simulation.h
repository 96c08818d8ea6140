#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hidden_truth.h"
#include "random_stream.h"
#include "rover_balance.h"
#include "terrain_grid.h"

namespace slipway::gap_benchmark {

struct DriveOrder {
  std::string id, terrain;
  double speed_m_s = 0.05, curvature_1_m = 0.0, duration_s = 60.0;
  bool turn_in_place = false;
  double start_x_m = 0.0, start_y_m = 0.0, start_yaw_rad = 0.0;
  double motor_temp_c = 20.0;
  double share_of_day = 0.0;  // from 0 for the first drive to 1 for the last

  // Commanded rate of the heading.
  double turn_rate_rad_s() const {
    constexpr double kTurnArm_m = 0.88;
    return turn_in_place ? speed_m_s / kTurnArm_m : speed_m_s * curvature_1_m;
  }
};

// The scatter of soils from drive to drive and along a drive, as standard deviations of logarithms.
struct SoilScatter {
  double stiffness = 0.055, friction = 0.010, shear_modulus = 0.06;
  double along = 0.5;  // of these, along a drive
  double length_m = 1.5;
};

struct WheelRow {
  double rate_rad_s = 0.0, steer_rad = 0.0, current_a = 0.0, sinkage_m = 0.0;
};

// The true motion of the rover, which no log has: its heading, and its speeds forward and to the left of the
// body.
struct RoverMotion {
  double heading_rad = 0.0, way_m = 0.0;
  double forward_m_s = 0.0, left_m_s = 0.0;
  double recorded_turn_rad_s = 0.0;        // rate of the heading as it is recorded
  double roll_rad = 0.0, pitch_rad = 0.0;  // of the ground, as the suspension lies on it
};

// A row as sensors without noise would record it.
struct DriveRow {
  double time_s = 0.0, x_m = 0.0, y_m = 0.0, z_m = 0.0, roll_rad = 0.0, pitch_rad = 0.0, yaw_rad = 0.0;
  double motor_temp_c = 0.0;
  bool surveyed = false;
  std::array<WheelRow, kWheels> wheels;
  RoverMotion motion;
};

struct World {
  RoverOnFile rover;
  double gravity_m_s2 = 3.71;
  TrueSoil soil;
  SoilScatter scatter;
  Closure closure;
  bool soil_contact_model = false;  // wheels by it, without a closure of arcs
  HiddenTruth hidden;
};

World without_hidden_causes(const World& world);

// Commanded rates and steering angles of the six wheels.
std::array<WheelRow, kWheels> commanded_wheels(const RoverOnFile& rover, const DriveOrder& order);

struct SimulatedDrive {
  std::vector<DriveRow> rows;
  bool complete = true;  // false where the rover left the map or the balance was not found
};

// Simulates a drive by explicit Euler steps of 2 s, with a row for each.
SimulatedDrive simulate_drive(const World& world, const TerrainGrid& ground, const DriveOrder& order,
                              RandomStream& random);

// The rows that a drive on the same soil (`random` as it was for that drive) would have at the poses and
// times of these rows in another world. It shows the effect of that world at each place, without the change
// of the path. Empty where the balance was not found.
std::vector<std::optional<DriveRow>> replay_drive(const World& world, const TerrainGrid& ground,
                                                  const DriveOrder& order, RandomStream& random,
                                                  std::span<const DriveRow> at);

}  // namespace slipway::gap_benchmark
