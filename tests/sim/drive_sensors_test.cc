#include "sim/dynamic/drive_sensors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <vector>

namespace slipway::sim {
namespace {

DriveSample a_sample() {
  DriveSample sample;
  sample.time_s = 12.0;
  sample.p_MB = {3.25, -1.5, 0.4};
  sample.attitude = {.roll_rad = 0.05, .pitch_rad = -0.12, .yaw_rad = 7.0};
  sample.velocity_B = {0.04, -0.001, -0.0};
  sample.angular_rate_B = {-0.0, 0.002, 0.01};
  sample.specific_force_B = {0.3, -0.1, 3.7};
  sample.rocker_rad = {0.1, -0.1};
  sample.bogie_rad = {-0.03, 0.04};
  sample.wheels = PerWheel<WheelState>(6);
  sample.steer_rad = sample.commanded_rate_rad_s = sample.turned_rad = sample.voltage_v =
      PerWheel<double>(6, 0.3);
  for (int k = 0; k < 6; ++k) {
    sample.wheels[k].current_a = 0.5 + 0.1 * k;
    sample.wheels[k].sinkage_m = 0.01 + 0.002 * k;
    sample.wheels[k].rate_rad_s = 0.32;
  }
  return sample;
}

// Every value that a sensor reads, a channel after the other in DriveSensors' order.
std::vector<std::vector<double>> measured(const DriveSample& s) {
  std::vector<double> current, sinkage, rate,
      angles{s.rocker_rad[0], s.rocker_rad[1], s.bogie_rad[0], s.bogie_rad[1]};
  for (const WheelState& wheel : s.wheels) {
    current.push_back(wheel.current_a);
    sinkage.push_back(wheel.sinkage_m);
    rate.push_back(wheel.rate_rad_s);
  }
  angles.insert(angles.end(), s.steer_rad.begin(), s.steer_rad.end());
  const auto axes = [](const Eigen::Vector3d& v) { return std::vector<double>(v.begin(), v.end()); };
  return {axes(s.p_MB),
          {s.attitude.roll_rad, s.attitude.pitch_rad, s.attitude.yaw_rad},
          current,
          sinkage,
          rate,
          angles,
          axes(s.angular_rate_B),
          axes(s.specific_force_B)};
}

constexpr SensorError DriveSensors::*kChannels[] = {
    &DriveSensors::position_m, &DriveSensors::attitude_rad,      &DriveSensors::current_a,
    &DriveSensors::sinkage_m,  &DriveSensors::encoder_rad_s,     &DriveSensors::potentiometer_rad,
    &DriveSensors::gyro_rad_s, &DriveSensors::accelerometer_m_s2};
constexpr bool SensorReading::*kHas[] = {&SensorReading::has_position, &SensorReading::has_attitude,
                                         &SensorReading::has_current,  &SensorReading::has_sinkage,
                                         &SensorReading::has_encoder,  &SensorReading::has_potentiometer,
                                         &SensorReading::has_gyro,     &SensorReading::has_accelerometer};

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

TEST(DriveSensors, WithoutErrorsReadTheTruthToTheBit) {
  const SensorReading reading = read_sensors({}, 4, 17, 1.0, a_sample());
  const auto found = measured(reading.sample), truth = measured(a_sample());
  for (std::size_t c = 0; c < std::size(kChannels); ++c) {
    EXPECT_TRUE(same_bits(found[c], truth[c])) << c;
    EXPECT_TRUE(reading.*kHas[c]) << c;
  }
}

TEST(DriveSensors, AnErrorOfOneChannelTouchesNoOther) {
  const auto truth = measured(a_sample());
  for (std::size_t wrong = 0; wrong < std::size(kChannels); ++wrong) {
    DriveSensors sensors;
    sensors.*kChannels[wrong] = {.noise = 0.01, .bias = 0.5};
    const auto found = measured(read_sensors(sensors, 1, 3, 1.0, a_sample()).sample);
    for (std::size_t c = 0; c < std::size(kChannels); ++c) {
      for (std::size_t i = 0; i < truth[c].size(); ++i)
        EXPECT_EQ(found[c][i] != truth[c][i], c == wrong) << wrong << " " << c << " " << i;
    }
  }
}

TEST(DriveSensors, NoiseHasItsSpreadAndIsNewAtEverySampleAndValue) {
  DriveSensors sensors;
  sensors.current_a = {.noise = 0.03, .relative_noise = 0.08};
  const DriveSample truth = a_sample();
  const int count = 20000;
  for (const int k : {0, 5}) {
    double sum = 0.0, squares = 0.0, with_next_wheel = 0.0, with_next_sample = 0.0, last = 0.0;
    for (int i = 0; i < count; ++i) {
      const DriveSample sample = read_sensors(sensors, 2, i, 1.0, truth).sample;
      const double wrong = sample.wheels[k].current_a - truth.wheels[k].current_a;
      const int other = (k + 1) % 6;
      sum += wrong;
      squares += wrong * wrong;
      with_next_wheel += wrong * (sample.wheels[other].current_a - truth.wheels[other].current_a);
      with_next_sample += wrong * last;
      last = wrong;
    }
    const double variance = 0.03 * 0.03 + std::pow(0.08 * truth.wheels[k].current_a, 2);
    EXPECT_NEAR(sum / count, 0.0, 4.0 * std::sqrt(variance / count)) << k;
    EXPECT_NEAR(squares / count / variance, 1.0, 4.0 * std::sqrt(2.0 / count)) << k;
    EXPECT_NEAR(with_next_wheel / count / variance, 0.0, 6.0 / std::sqrt(count)) << k;
    EXPECT_NEAR(with_next_sample / count / variance, 0.0, 4.0 / std::sqrt(count)) << k;
  }
}

TEST(DriveSensors, ABiasIsConstantInADriveAndDrawnAnewForTheNext) {
  DriveSensors sensors;
  sensors.gyro_rad_s = {.bias = 0.1, .bias_std = 0.02};
  const DriveSample truth = a_sample();
  const auto bias = [&](std::uint64_t drive, std::size_t index) -> Eigen::Vector3d {
    return read_sensors(sensors, drive, index, 1.0, truth).sample.angular_rate_B - truth.angular_rate_B;
  };
  double sum = 0.0, squares = 0.0;
  const int drives = 4000;
  for (int drive = 0; drive < drives; ++drive) {
    const Eigen::Vector3d first = bias(drive, 0);
    EXPECT_EQ(first, bias(drive, 1));
    EXPECT_EQ(first, bias(drive, 977));
    sum += (first.array() - 0.1).sum();
    squares += (first.array() - 0.1).square().sum();
  }
  EXPECT_NEAR(sum / (3 * drives), 0.0, 4.0 * 0.02 / std::sqrt(3 * drives));
  EXPECT_NEAR(squares / (3 * drives) / (0.02 * 0.02), 1.0, 4.0 * std::sqrt(2.0 / (3 * drives)));
  EXPECT_NE(bias(0, 0).x(), bias(0, 0).y()) << "each axis has its own";
}

TEST(DriveSensors, IntervalsThinReadings) {
  DriveSensors sensors;
  sensors.sinkage_m.interval_s = 5.0;
  sensors.position_m.interval_s = 2.5;
  sensors.current_a.interval_s = 0.2;
  std::vector<int> sinkage, position, current;
  for (int i = 0; i <= 11; ++i) {
    const SensorReading reading = read_sensors(sensors, 1, i, 1.0, a_sample());
    if (reading.has_sinkage) sinkage.push_back(i);
    if (reading.has_position) position.push_back(i);
    if (reading.has_current) current.push_back(i);
    EXPECT_TRUE(reading.has_encoder);
  }
  EXPECT_EQ(sinkage, (std::vector<int>{0, 5, 10}));
  EXPECT_EQ(position, (std::vector<int>{0, 3, 5, 8, 10}));
  EXPECT_EQ(current.size(), 12u);
  // Whole numbers of samples are not missed by rounding.
  sensors.sinkage_m.interval_s = 0.3;
  int readings = 0;
  for (int i = 0; i < 3000; ++i) readings += read_sensors(sensors, 1, i, 0.1, a_sample()).has_sinkage ? 1 : 0;
  EXPECT_EQ(readings, 1000);
}

TEST(DriveSensors, TheSameArgumentsGiveTheSameReadingsInAnyOrder) {
  DriveSensors sensors;
  for (const auto channel : kChannels)
    sensors.*channel = {.noise = 0.02, .relative_noise = 0.1, .bias_std = 0.05};
  std::vector<std::vector<std::vector<double>>> forth(20);
  for (std::size_t i = 0; i < 20; ++i)
    forth[i] = measured(read_sensors(sensors, 3, i, 1.0, a_sample()).sample);
  for (std::size_t i = 20; i-- > 0;) {
    const auto again = measured(read_sensors(sensors, 3, i, 1.0, a_sample()).sample);
    for (std::size_t c = 0; c < std::size(kChannels); ++c) EXPECT_TRUE(same_bits(again[c], forth[i][c]));
  }
  DriveSensors other = sensors;
  other.seed = 2;
  EXPECT_NE(measured(read_sensors(other, 3, 0, 1.0, a_sample()).sample)[0], forth[0][0]);
  EXPECT_NE(measured(read_sensors(sensors, 4, 0, 1.0, a_sample()).sample)[0], forth[0][0]);
}

}  // namespace
}  // namespace slipway::sim
