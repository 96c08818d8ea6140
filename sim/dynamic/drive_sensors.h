#pragma once

#include <cstddef>
#include <cstdint>

#include "sim/dynamic/dynamic_drive.h"

namespace slipway::sim {

// One measured channel: reading = true + bias + noise; true where all is 0.
struct SensorError {
  double noise = 0.0;           // one standard deviation, in the channel's unit
  double relative_noise = 0.0;  // one standard deviation per unit of the true value, in quadrature
  double bias = 0.0;            // constant over a drive
  double bias_std = 0.0;        // drawn anew for each drive and each value of the channel, besides
  double interval_s = 0.0;      // of readings; 0, or less than the samples': at every sample
};

// The rover's sensors; true readings by default.
struct DriveSensors {
  SensorError position_m;          // visual odometry or survey, each axis
  SensorError attitude_rad;        // each angle
  SensorError current_a;           // of each drive motor
  SensorError sinkage_m;           // of each wheel, from images
  SensorError encoder_rad_s;       // wheel rates; turned_rad, which an encoder counts, stays true
  SensorError potentiometer_rad;   // steering, rockers, bogies
  SensorError gyro_rad_s;          // each axis
  SensorError accelerometer_m_s2;  // each axis
  std::uint64_t seed = 1;
};

// A sample with what the sensors make of it, and which channels have a reading at this instant: values of the
// others are not to be read. What no sensor measures stays true.
struct SensorReading {
  DriveSample sample;  // measured values in place of the true ones
  bool has_position = true, has_attitude = true, has_current = true, has_sinkage = true, has_encoder = true,
       has_potentiometer = true, has_gyro = true, has_accelerometer = true;
};

// Reads sample number `index` of drive `drive`, whose samples are sample_interval_s > 0 apart: a pure
// function, so that any order gives the same readings. A channel reads at the first sample and at the first
// one in each of its intervals.
SensorReading read_sensors(const DriveSensors& sensors, std::uint64_t drive, std::size_t index,
                           double sample_interval_s, const DriveSample& truth);

}  // namespace slipway::sim
