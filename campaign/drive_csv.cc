#include "campaign/drive_csv.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string_view>

#include "core/angle.h"

namespace slipway::campaign {
namespace {

constexpr double kMicrosecond_s = 1e-6;

std::string number(double value) {
  std::string text = fmt::format("{:.6f}", value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

// One row under way; every cell but the first puts its comma before it.
class Row {
 public:
  Row& cell(double value, bool has_reading = true) {
    if (!first_) text_ += ',';
    first_ = false;
    if (has_reading && std::isfinite(value)) text_ += number(value);
    return *this;
  }
  Row& angle(double rad, bool has_reading = true) { return cell(deg_from_rad(rad), has_reading); }
  Row& empty() { return cell(0.0, false); }
  std::string take() { return std::move(text_) + "\n"; }

 private:
  std::string text_;
  bool first_ = true;
};

constexpr std::array<std::string_view, 5> kWheelColumns{"rate_deg_s", "steer_deg", "current_a", "sinkage_m",
                                                        "motor_temp_c"};
constexpr std::array<std::string_view, 6> kMoreWheelColumns{"turned_deg",     "voltage_v", "slip_ratio",
                                                            "slip_angle_deg", "load_n",    "torque_nm"};
constexpr std::string_view kMoreColumns =
    ",left_rocker_deg,right_rocker_deg,left_bogie_deg,right_bogie_deg,gyro_x_deg_s,gyro_y_deg_s,gyro_z_deg_s,"
    "accel_x_m_s2,accel_y_m_s2,accel_z_m_s2,slip_ratio,progress_m,leg,driving\n";

std::string header(const sim::RoverModel& rover, bool more_columns) {
  std::string text = "t_s,x_m,y_m,z_m,roll_deg,pitch_deg,yaw_deg";
  for (const sim::WheelModel& wheel : rover.wheels)
    for (const std::string_view column : kWheelColumns) text += fmt::format(",{}_{}", wheel.name, column);
  text += ",bus_voltage_v";
  if (!more_columns) return text + "\n";
  for (const sim::WheelModel& wheel : rover.wheels)
    for (const std::string_view column : kMoreWheelColumns) text += fmt::format(",{}_{}", wheel.name, column);
  return text.append(kMoreColumns);
}

void add_format_cells(Row& row, const sim::SensorReading& reading, const CsvOptions& options) {
  const sim::DriveSample& s = reading.sample;
  row.cell(s.time_s);
  for (int axis = 0; axis < 3; ++axis) row.cell(s.p_MB[axis], reading.has_position);
  row.angle(s.attitude.roll_rad, reading.has_attitude).angle(s.attitude.pitch_rad, reading.has_attitude);
  row.angle(s.attitude.yaw_rad, reading.has_attitude);
  for (std::size_t k = 0; k < s.wheels.size(); ++k) {
    row.angle(s.wheels[k].rate_rad_s, reading.has_encoder);
    row.angle(s.steer_rad[k], reading.has_potentiometer);
    row.cell(s.wheels[k].current_a, reading.has_current)
        .cell(s.wheels[k].sinkage_m, reading.has_sinkage && options.sinkage);
    if (options.motor_temp_c) {
      row.cell(*options.motor_temp_c);
    } else {
      row.empty();
    }
  }
  row.cell(options.bus_voltage_v);
}

void add_more_cells(Row& row, const sim::SensorReading& reading) {
  const sim::DriveSample& s = reading.sample;
  for (std::size_t k = 0; k < s.wheels.size(); ++k) {
    const sim::WheelState& wheel = s.wheels[k];
    row.angle(s.turned_rad[k], reading.has_encoder).cell(s.voltage_v[k], reading.has_current);
    row.cell(wheel.slip_ratio).angle(wheel.slip_angle_rad).cell(wheel.load_n).cell(wheel.torque_nm);
  }
  for (const double rad : s.rocker_rad) row.angle(rad, reading.has_potentiometer);
  for (const double rad : s.bogie_rad) row.angle(rad, reading.has_potentiometer);
  for (int axis = 0; axis < 3; ++axis) row.angle(s.angular_rate_B[axis], reading.has_gyro);
  for (int axis = 0; axis < 3; ++axis) row.cell(s.specific_force_B[axis], reading.has_accelerometer);
  row.cell(s.slip_ratio).cell(s.progress_m).cell(s.leg).cell(s.driving ? 1.0 : 0.0);
}

bool is_superseded(std::span<const sim::SensorReading> readings, std::size_t i) {
  return i + 1 < readings.size() && std::round(readings[i + 1].sample.time_s / kMicrosecond_s) <=
                                        std::round(readings[i].sample.time_s / kMicrosecond_s);
}

}  // namespace

std::string drive_csv(const sim::RoverModel& rover, std::span<const sim::SensorReading> readings,
                      const CsvOptions& options) {
  std::string text = header(rover, options.more_columns);
  for (std::size_t i = 0; i < readings.size(); ++i) {
    if (is_superseded(readings, i)) continue;
    if (options.final_only && i > 0 && i + 1 < readings.size()) continue;
    Row row;
    add_format_cells(row, readings[i], options);
    if (options.more_columns) add_more_cells(row, readings[i]);
    text += row.take();
  }
  return text;
}

std::vector<sim::SensorReading> readings_of_leg(std::span<const sim::SensorReading> readings, int leg) {
  std::vector<sim::SensorReading> of_leg;
  for (const sim::SensorReading& reading : readings)
    if (reading.sample.leg == leg) of_leg.push_back(reading);
  if (of_leg.empty()) return of_leg;
  const double begin_s = of_leg.front().sample.time_s;
  for (sim::SensorReading& reading : of_leg) reading.sample.time_s -= begin_s;
  return of_leg;
}

}  // namespace slipway::campaign
