#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sim/dynamic/drive_sensors.h"
#include "sim/dynamic/dynamic_drive.h"
#include "sim/rover/rover_model.h"

namespace slipway::campaign {

struct CsvOptions {
  bool final_only = false;  // the first and the last row
  double bus_voltage_v = 0.0;
  std::optional<double> motor_temp_c = {};
  bool sinkage = true;       // false: no wheel's was measured
  bool more_columns = true;  // false: those of the format alone
};

// Readings as a drive's file of a drive campaign: its columns in its order, those of a rover of these wheels,
// then, unless they are not wanted, what the format does not know (encoders, joints, IMU and, as true values,
// slip and loads of the wheels). Where a channel has no reading the cell is empty. A row whose time is that
// of the row before, to the microsecond that is printed, takes its place.
std::string drive_csv(const sim::RoverModel& rover, std::span<const sim::SensorReading> readings,
                      const CsvOptions& options);

// The readings of one leg, their times from its beginning; none where it was never begun.
std::vector<sim::SensorReading> readings_of_leg(std::span<const sim::SensorReading> readings, int leg);

}  // namespace slipway::campaign
