#pragma once

#include <cstdint>

#include "sim/dynamic_drive.h"

namespace slipway::sim {

// One measured channel: reading = true + bias + noise; true where all is 0.
struct SensorError {
  double noise = 0.0;           // one standard deviation, in the channel's unit
  double relative_noise = 0.0;  // one standard deviation per unit of the true value, in quadrature
  double bias = 0.0;            // constant over a drive
  double bias_std = 0.0;        // drawn anew for each drive, besides
  double interval_s = 0.0;      // of readings; 0: at every sample
};

// The rover's sensors; true readings by default. Angles in rad.
struct DriveSensors {
  SensorError position_m;    // visual odometry or survey, each axis
  SensorError attitude_rad;  // each angle
  SensorError current_a;
  SensorError sinkage_m;
  SensorError encoder_rad_s;      // wheel rates
  SensorError potentiometer_rad;  // steering, rockers, bogies
  SensorError gyro_rad_s;         // IMU, each axis
  SensorError accelerometer_m_s2;
  double sinkage_interval_s = 0.0;  // images: 0, at every sample
  std::uint64_t seed = 1;
};

// A sample with what the sensors make of it; which channels have a reading at this instant.
struct SensorReading {
  DriveSample sample;  // measured values in place of the true ones
  bool has_pose = true, has_current = true, has_sinkage = true, has_encoder = true, has_potentiometer = true,
       has_imu = true;
};

// Reads sample number `index` of drive `drive`: a pure function, so that any order gives the same readings.
SensorReading read_sensors(const DriveSensors& sensors, std::uint64_t drive, std::size_t index,
                           const DriveSample& truth);

}  // namespace slipway::sim
