#include "sim/dynamic/drive_sensors.h"

#include <cmath>

#include "core/random.h"

namespace slipway::sim {
namespace {

// The readings depend on these numbers, so that new channels must go last.
enum class Channel {
  kPosition,
  kAttitude,
  kCurrent,
  kSinkage,
  kEncoder,
  kPotentiometer,
  kGyro,
  kAccelerometer
};

// One sensor channel at one sample; its values are read one after the other.
class ChannelReading {
 public:
  ChannelReading(const DriveSensors& sensors, std::uint64_t drive, Channel channel, const SensorError& error,
                 std::size_t index)
      : error_(error),
        key_(random_key(random_key(sensors.seed, drive), static_cast<std::uint64_t>(channel))),
        noise_counter_((index + 1) * kMaxValues) {}

  void read(double& value) {
    const double noise = std::hypot(error_.noise, error_.relative_noise * value);
    double wrong = error_.bias;
    if (error_.bias_std != 0.0) wrong += error_.bias_std * random_normal(key_, value_);
    if (noise != 0.0) wrong += noise * random_normal(key_, noise_counter_ + value_);
    if (wrong != 0.0) value += wrong;  // without an error, a true value of -0 stays -0
    ++value_;
  }
  void read(Eigen::Vector3d& value) {
    for (double& component : value) read(component);
  }

 private:
  static constexpr std::uint64_t kMaxValues = 64;  // of a channel at a sample; the first block is the biases'
  static_assert(kMaxValues >= kMaxWheels + 4);

  const SensorError& error_;
  std::uint64_t key_, noise_counter_, value_ = 0;
};

// Whether an interval begins between the last sample and this one.
bool due(const SensorError& error, std::size_t index, double sample_interval_s) {
  if (index == 0 || error.interval_s <= sample_interval_s) return true;
  const auto begun = [&](std::size_t sample) {
    return std::floor(static_cast<double>(sample) * sample_interval_s / error.interval_s + 1e-9);
  };
  return begun(index) > begun(index - 1);
}

}  // namespace

SensorReading read_sensors(const DriveSensors& sensors, std::uint64_t drive, std::size_t index,
                           double sample_interval_s, const DriveSample& truth) {
  SensorReading reading;
  reading.sample = truth;
  DriveSample& sample = reading.sample;
  const auto channel = [&](Channel which, const SensorError& error, bool& has, auto&& values) {
    has = due(error, index, sample_interval_s);
    ChannelReading values_of(sensors, drive, which, error, index);
    if (has) values(values_of);
  };
  channel(Channel::kPosition, sensors.position_m, reading.has_position,
          [&](ChannelReading& of) { of.read(sample.p_MB); });
  channel(Channel::kAttitude, sensors.attitude_rad, reading.has_attitude, [&](ChannelReading& of) {
    of.read(sample.attitude.roll_rad);
    of.read(sample.attitude.pitch_rad);
    of.read(sample.attitude.yaw_rad);
  });
  channel(Channel::kCurrent, sensors.current_a, reading.has_current, [&](ChannelReading& of) {
    for (WheelState& wheel : sample.wheels) of.read(wheel.current_a);
  });
  channel(Channel::kSinkage, sensors.sinkage_m, reading.has_sinkage, [&](ChannelReading& of) {
    for (WheelState& wheel : sample.wheels) of.read(wheel.sinkage_m);
  });
  channel(Channel::kEncoder, sensors.encoder_rad_s, reading.has_encoder, [&](ChannelReading& of) {
    for (WheelState& wheel : sample.wheels) of.read(wheel.rate_rad_s);
  });
  channel(Channel::kPotentiometer, sensors.potentiometer_rad, reading.has_potentiometer,
          [&](ChannelReading& of) {
            for (double& rocker : sample.rocker_rad) of.read(rocker);
            for (double& bogie : sample.bogie_rad) of.read(bogie);
            for (double& steer : sample.steer_rad) of.read(steer);
          });
  channel(Channel::kGyro, sensors.gyro_rad_s, reading.has_gyro,
          [&](ChannelReading& of) { of.read(sample.angular_rate_B); });
  channel(Channel::kAccelerometer, sensors.accelerometer_m_s2, reading.has_accelerometer,
          [&](ChannelReading& of) { of.read(sample.specific_force_B); });
  return reading;
}

}  // namespace slipway::sim
