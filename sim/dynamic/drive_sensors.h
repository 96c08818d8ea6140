#pragma once

#include <cstddef>
#include <cstdint>

#include "sim/dynamic/drive_sample.h"

namespace slipway::sim {

// The errors of one measured channel: reading = true value + bias + noise.
struct SensorError {
  double noise = 0.0;           // standard deviation, in the channel's unit
  double relative_noise = 0.0;  // standard deviation per unit of the true value, added in quadrature
  double bias = 0.0;            // the same in all drives
  double bias_std = 0.0;    // of a further bias that is drawn for each drive and each value of the channel
  double interval_s = 0.0;  // between readings; at or below the sample interval, every sample is read
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

// A sample as the sensors read it. The flags state which channels have a reading at this instant; the values
// of the others must not be used. Values that no sensor measures stay true.
struct SensorReading {
  DriveSample sample;  // has measured values in place of the true ones
  bool has_position = true, has_attitude = true, has_current = true, has_sinkage = true, has_encoder = true,
       has_potentiometer = true, has_gyro = true, has_accelerometer = true;
};

// Reads sample number `index` of drive `drive`, whose samples are sample_interval_s > 0 apart. This is a pure
// function, so that any order gives the same readings. A channel has a reading at the first sample and at the
// first sample of each of its intervals.
SensorReading read_sensors(const DriveSensors& sensors, std::uint64_t drive, std::size_t index,
                           double sample_interval_s, const DriveSample& truth);

}  // namespace slipway::sim
