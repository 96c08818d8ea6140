#include "gap/diagnosis/model/window_readings.h"

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/angle.h"
#include "core/quantile.h"

namespace slipway::gap {
namespace {

// value = offset + rate (t - mid), by least squares, and the errors of both for readings of one deviation.
struct Line {
  double mid_s = 0.0, offset = 0.0, rate = 0.0, offset_error = 1.0, rate_error = 1.0;
  double at(double time_s) const { return offset + rate * (time_s - mid_s); }
};

Line line_through(const Readings& readings) {
  Line line;
  const auto n = static_cast<double>(readings.count());
  for (const double t : readings.time_s) line.mid_s += t / n;
  line.offset = readings.mean();
  double tt = 0.0, tv = 0.0;
  for (std::size_t i = 0; i < readings.count(); ++i) {
    const double t = readings.time_s[i] - line.mid_s;
    tt += t * t;
    tv += t * readings.value[i];
  }
  line.offset_error = 1.0 / std::sqrt(n);
  if (tt > 0.0) {
    line.rate = tv / tt;
    line.rate_error = 1.0 / std::sqrt(tt);
  }
  return line;
}

template <class Value>
Readings readings_of(const MeasuredDriveSeries& drive, std::size_t from, std::size_t to, const Value& value) {
  Readings readings;
  for (std::size_t i = from; i <= to; ++i) {
    const double v = value(drive.samples[i]);
    if (std::isnan(v)) continue;
    readings.time_s.push_back(drive.samples[i].time_s);
    readings.value.push_back(v);
  }
  return readings;
}

void unwrap(Readings& angles) {
  for (std::size_t i = 1; i < angles.count(); ++i)
    angles.value[i] = angles.value[i - 1] + wrapped_rad(angles.value[i] - angles.value[i - 1]);
}

// The way forward and leftward of the heading at the line's middle that a body makes which moves forward at
// unit speed and turns along the line.
struct Way {
  double along = 0.0, across = 0.0;
};

Way way_since_middle(const Line& heading, double t) {
  const double turned = heading.rate * t;
  if (std::abs(turned) < 1e-6) return {t, 0.5 * turned * t};
  return {std::sin(turned) / heading.rate, (1.0 - std::cos(turned)) / heading.rate};
}

}  // namespace

double Readings::mean() const {
  double sum = 0.0;
  for (const double v : value) sum += v;
  return sum / static_cast<double>(count());
}

Readings Readings::kept(double std, const WindowOptions& options) const {
  if (count() < 5 || std <= 0.0) return *this;
  std::vector<double> rates;
  for (std::size_t i = 1; i < count(); ++i)
    rates.push_back((value[i] - value[i - 1]) / (time_s[i] - time_s[i - 1]));
  const double rate = median(std::move(rates));
  const auto neighbours = static_cast<std::size_t>(options.outlier_neighbours);
  Readings left;
  for (std::size_t i = 0; i < count(); ++i) {
    std::vector<double> around;
    const std::size_t from = i < neighbours ? 0 : i - neighbours;
    for (std::size_t j = from; j <= std::min(count() - 1, i + neighbours); ++j)
      around.push_back(value[j] - rate * (time_s[j] - time_s[i]));
    if (std::abs(value[i] - median(std::move(around))) > options.outlier * std) continue;
    left.time_s.push_back(time_s[i]);
    left.value.push_back(value[i]);
  }
  return left.count() >= 2 ? left : *this;
}

WindowReadings::WindowReadings(const DriveCampaign& campaign, const MeasuredDriveSeries& drive,
                               std::size_t from, std::size_t to, const WindowOptions& options)
    : campaign_(campaign),
      drive_(drive),
      from_(from),
      to_(to),
      options_(options),
      commanded_(sim::wheel_commands(*campaign.rover, drive.command)) {
  read_poses();
}

Readings WindowReadings::of_wheel(std::size_t wheel, double WheelReading::*quantity, double sense) const {
  if (drive_.final_only) return {};
  return readings_of(drive_, from_, to_,
                     [&](const DriveSample& s) { return sense * (s.wheels[wheel].*quantity); });
}

double WindowReadings::sense_of_current(std::size_t wheel) const {
  return commanded_[wheel].rate_rad_s < 0.0 && !options_.currents_in_sense_of_rate ? -1.0 : 1.0;
}

std::optional<double> WindowReadings::motor_temp_c() const {
  double sum = 0.0;
  int count = 0;
  for (std::size_t k = 0; k < campaign_.rover->wheels.size(); ++k) {
    const Readings temps =
        readings_of(drive_, from_, to_, [k](const DriveSample& s) { return s.wheels[k].motor_temp_c; });
    if (temps.count() == 0) continue;
    sum += temps.mean();
    ++count;
  }
  if (count == 0) return std::nullopt;
  return sum / count;
}

void WindowReadings::read_poses() {
  const MeasurementStd& std = campaign_.measurement_std;
  const auto angle = [&](auto member) {
    Readings angles =
        readings_of(drive_, from_, to_, [&](const DriveSample& s) { return s.attitude.*member; });
    unwrap(angles);
    return angles.kept(std.attitude_rad, options_);
  };
  const Readings x = readings_of(drive_, from_, to_, [](const DriveSample& s) { return s.p_MB.x(); });
  const Readings y = readings_of(drive_, from_, to_, [](const DriveSample& s) { return s.p_MB.y(); });
  const Readings yaw = angle(&Attitude::yaw_rad);
  const Readings roll = angle(&Attitude::roll_rad), pitch = angle(&Attitude::pitch_rad);
  if (x.count() < 2 || y.count() < 2 || yaw.count() < 2) return;
  const bool has_tilt = roll.count() > 0 && pitch.count() > 0;
  read_motion(x, y, yaw, has_tilt ? roll.mean() : 0.0, has_tilt ? pitch.mean() : 0.0);
  if (drive_.final_only) return;
  if (roll.count() > 1) motion_.roll = {roll.mean(), std.attitude_rad / std::sqrt(roll.count())};
  if (pitch.count() > 1) motion_.pitch = {pitch.mean(), std.attitude_rad / std::sqrt(pitch.count())};
}

// Constant speeds forward, leftward and of yaw that lead through the measured positions: with the heading
// known, positions are linear in the first two and a start.
// Those are the level parts of the motion along the body's axes, which are tilted by roll and pitch.
void WindowReadings::read_motion(const Readings& x, const Readings& y, const Readings& yaw, double roll_rad,
                                 double pitch_rad) {
  const double start_s = drive_.samples[from_].time_s, end_s = drive_.samples[to_].time_s;
  const MeasurementStd& std = campaign_.measurement_std;
  const Line heading = line_through(yaw);
  const std::size_t n = x.count();
  Eigen::MatrixXd design = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(2 * n), 4);
  Eigen::VectorXd places(design.rows());
  for (std::size_t i = 0; i < n; ++i) {
    const auto [along, across] = way_since_middle(heading, x.time_s[i] - heading.mid_s);
    const double c = std::cos(heading.offset), s = std::sin(heading.offset);
    const auto row = static_cast<Eigen::Index>(2 * i);
    design.row(row) << c * along - s * across, -s * along - c * across, 1.0, 0.0;
    design.row(row + 1) << s * along + c * across, c * along - s * across, 0.0, 1.0;
    places[row] = x.value[i];
    places[row + 1] = y.value[i];
  }
  const Eigen::Matrix4d inverse = (design.transpose() * design).inverse();
  if (!inverse.allFinite()) return;
  const Eigen::Vector4d found = inverse * (design.transpose() * places);
  motion_.first_yaw_rad = heading.at(start_s);
  for (int k = 0; k < options_.stations; ++k) {
    const double share = (k + 0.5) / options_.stations;
    const double at_s = start_s + share * (end_s - start_s);
    const auto [along, across] = way_since_middle(heading, at_s - heading.mid_s);
    const double c = std::cos(heading.offset), s = std::sin(heading.offset);
    const double forward = found[0] * along - found[1] * across;
    const double leftward = found[0] * across + found[1] * along;
    motion_.stations.push_back(
        {found[2] + c * forward - s * leftward, found[3] + s * forward + c * leftward, heading.at(at_s)});
  }
  const sim::DriveCommand& command = drive_.command;
  const double yaw_rate = heading.rate * std::cos(pitch_rad) / std::cos(roll_rad);
  if (command.turn_in_place) {
    motion_.slip = {1.0 - yaw_rate / command.turn_rate_rad_s,
                    std.attitude_rad * heading.rate_error / std::abs(command.turn_rate_rad_s)};
    motion_.censored = motion_.slip->value > kCensoredSlip;
    return;
  }
  const Eigen::Vector2d travel = sim::travel_direction(command);
  const double leftward = found[1] / std::cos(roll_rad);
  const double forward =
      (found[0] - leftward * std::sin(pitch_rad) * std::sin(roll_rad)) / std::cos(pitch_rad);
  const double along = travel.x() * forward + travel.y() * leftward;
  const double slip = 1.0 - along / command.speed_m_s;
  const double speed_std = std.position_m * std::sqrt(inverse(0, 0));
  motion_.censored = slip > kCensoredSlip;
  const double speed = std::abs(command.speed_m_s);
  // A heading that is off turns forward into sideways motion.
  const double side_std =
      std::hypot(speed_std / speed, std.attitude_rad * heading.offset_error * std::abs(along) / speed);
  motion_.slip = {slip, speed_std / speed};
  motion_.side_slip = {(travel.x() * leftward - travel.y() * forward) / speed, side_std};
  motion_.yaw_rate = {yaw_rate - command.speed_m_s * command.curvature_1_m,
                      std.attitude_rad * heading.rate_error};
}

}  // namespace slipway::gap
