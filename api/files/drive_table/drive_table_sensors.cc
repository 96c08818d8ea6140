#include <array>
#include <string>

#include "api/files/drive_table/drive_table_file.h"
#include "core/angle.h"

namespace slipway::api::json {
namespace {

struct SensedChannel {
  std::string_view key, unit;
  sim::SensorError sim::DriveSensors::*error;
  bool in_degrees;
};

constexpr std::array kChannels{
    SensedChannel{"position_m", "m", &sim::DriveSensors::position_m, false},
    SensedChannel{"attitude_deg", "deg", &sim::DriveSensors::attitude_rad, true},
    SensedChannel{"current_a", "A", &sim::DriveSensors::current_a, false},
    SensedChannel{"sinkage_m", "m", &sim::DriveSensors::sinkage_m, false},
    SensedChannel{"encoder_deg_s", "deg/s", &sim::DriveSensors::encoder_rad_s, true},
    SensedChannel{"potentiometer_deg", "deg", &sim::DriveSensors::potentiometer_rad, true},
    SensedChannel{"gyro_deg_s", "deg/s", &sim::DriveSensors::gyro_rad_s, true},
    SensedChannel{"accelerometer_m_s2", "m/s^2", &sim::DriveSensors::accelerometer_m_s2, false}};

void read_channel(ObjectReader& sensors, const SensedChannel& channel, sim::SensorError& error) {
  auto object = sensors.object(channel.key, kOptional);
  if (!object) return;
  constexpr double kMax = 1e3;
  object->number("noise", kOptional, {channel.unit, 0.0, kMax}, error.noise);
  object->number("relative_noise", kOptional, {"1", 0.0, 10.0}, error.relative_noise);
  object->number("bias", kOptional, {channel.unit, -kMax, kMax}, error.bias);
  object->number("bias_std", kOptional, {channel.unit, 0.0, kMax}, error.bias_std);
  object->number("interval_s", kOptional, {"s", 0.0, 1e5}, error.interval_s);
  object->refuse_unknown();
  if (!channel.in_degrees) return;
  for (double* const value : {&error.noise, &error.bias, &error.bias_std}) *value = rad_from_deg(*value);
}

}  // namespace

void read_table_sensors(ObjectReader& table, sim::DriveSensors& sensors) {
  auto object = table.object("sensors", kOptional);
  if (!object) return;
  for (const SensedChannel& channel : kChannels) read_channel(*object, channel, sensors.*channel.error);
  object->refuse_unknown();
}

}  // namespace slipway::api::json
