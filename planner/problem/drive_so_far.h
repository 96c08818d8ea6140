#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/result.h"
#include "sim/prediction/telemetry.h"

namespace slipway::planner {

// One row of a drive's telemetry: where the rover was on the map when its wheels had rolled so far.
struct TelemetryRow {
  std::optional<double> time_s;
  double driven_m = 0.0;  // by odometry: the way that the wheels have rolled since the drive's start
  double x_m = 0.0, y_m = 0.0;
  std::optional<double> yaw_rad;    // of the body
  std::optional<double> current_a;  // sum over the drive motors, mean since the row before
  std::map<std::string, double, std::less<>> currents_a;  // the same by wheel
};

// A drive under way, as far as it has come.
struct DriveSoFar {
  std::vector<TelemetryRow> rows;  // in driving order, at least two
  double position_noise_m = sim::TelemetryErrors{}.position_m;
  double current_noise_a = sim::TelemetryErrors{}.current_a;
};

// What is wrong between the rows: time or odometry that goes back, a rover that comes further than its wheels
// roll by more than half and the noise, wheels that do not roll at all. Places are "/rows/3/driven_m".
std::vector<Fault> faults_of(const DriveSoFar& drive);

// A stretch of it over which slip and currents are measured, along the positions.
struct TelemetryStretch {
  double from_m = 0.0, to_m = 0.0;  // by odometry
  std::vector<std::size_t> rows;  // its positions: the first and the last, and those between that tell a bend
  bool backwards = false;
  sim::MeasuredStretch measured;
};

// Stretches of at least 2 m of rolling, or 20 times the position's noise, or a fortieth of the drive.
// `wheels` are the names of the rover's wheels.
std::vector<TelemetryStretch> stretches_of(const DriveSoFar& drive, const std::vector<std::string>& wheels);

}  // namespace slipway::planner
