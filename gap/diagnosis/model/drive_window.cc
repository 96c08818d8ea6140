#include "gap/diagnosis/model/drive_window.h"

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "core/angle.h"

namespace slipway::gap {
namespace {

struct Row {
  std::string_view name, unit;
  double boundary_unit;
};
constexpr double kDegPerRad = 180.0 / std::numbers::pi;
constexpr std::array<Row, kChannels> kRows{
    Row{"slip", "1", 1.0},          Row{"side_slip", "1", 1.0},      Row{"yaw_rate", "deg/s", kDegPerRad},
    Row{"roll", "deg", kDegPerRad}, Row{"pitch", "deg", kDegPerRad}, Row{"current", "A", 1.0},
    Row{"sinkage", "m", 1.0}};

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Readings of one quantity over a window.
struct Readings {
  std::vector<double> time_s, value;

  std::size_t count() const { return value.size(); }
  double mean() const {
    double sum = 0.0;
    for (const double v : value) sum += v;
    return sum / static_cast<double>(count());
  }
  // Without what lies far from its neighbours' median.
  Readings kept(double std, const WindowOptions& options) const {
    const auto neighbours = static_cast<std::size_t>(options.outlier_neighbours);
    if (count() < 5 || std <= 0.0) return *this;
    Readings left;
    for (std::size_t i = 0; i < count(); ++i) {
      std::vector<double> around;
      const std::size_t from = i < neighbours ? 0 : i - neighbours;
      for (std::size_t j = from; j <= std::min(count() - 1, i + neighbours); ++j) around.push_back(value[j]);
      if (std::abs(value[i] - median_of(std::move(around))) > options.outlier * std) continue;
      left.time_s.push_back(time_s[i]);
      left.value.push_back(value[i]);
    }
    return left.count() >= 2 ? left : *this;
  }
};

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

class WindowMaker {
 public:
  WindowMaker(const DriveCampaign& campaign, const MeasuredDriveSeries& drive, std::size_t from,
              std::size_t to, const WindowOptions& options)
      : campaign_(campaign), drive_(drive), from_(from), to_(to), options_(options) {}

  DriveWindow make(std::size_t drive) {
    window_.drive = drive;
    window_.start_s = drive_.samples[from_].time_s;
    window_.end_s = drive_.samples[to_].time_s;
    window_.command = drive_.command;
    window_.distance_m = std::abs(drive_.command.speed_m_s) * (window_.end_s - window_.start_s);
    add_pose();
    add_temperature();
    if (!drive_.final_only) add_wheels();
    return std::move(window_);
  }

 private:
  void observe(Channel channel, int wheel, double value, double std) {
    window_.observations.push_back({channel, wheel, value, std});
  }

  void add_pose() {
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
    add_motion(x, y, yaw, has_tilt ? roll.mean() : 0.0, has_tilt ? pitch.mean() : 0.0);
    if (drive_.final_only) return;
    if (roll.count() > 1)
      observe(Channel::kRoll, -1, roll.mean(), std.attitude_rad / std::sqrt(roll.count()));
    if (pitch.count() > 1)
      observe(Channel::kPitch, -1, pitch.mean(), std.attitude_rad / std::sqrt(pitch.count()));
  }

  // Constant speeds forward, leftward and of yaw that lead through the measured positions: with the heading
  // known, positions are linear in the first two and a start.
  // Those are the level parts of the motion along the body's axes, which are tilted by roll and pitch.
  void add_motion(const Readings& x, const Readings& y, const Readings& yaw, double roll_rad,
                  double pitch_rad) {
    const MeasurementStd& std = campaign_.measurement_std;
    const Line heading = line_through(yaw);
    const std::size_t n = x.count();
    Eigen::MatrixXd design = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(2 * n), 4);
    Eigen::VectorXd places(design.rows());
    for (std::size_t i = 0; i < n; ++i) {
      // Integral of the heading's direction from the window's middle.
      const double t = x.time_s[i] - heading.mid_s, turned = heading.rate * t;
      const double along = std::abs(turned) < 1e-6 ? t : std::sin(turned) / heading.rate;
      const double across =
          std::abs(turned) < 1e-6 ? 0.5 * turned * t : (1.0 - std::cos(turned)) / heading.rate;
      const double c = std::cos(heading.offset), s = std::sin(heading.offset);
      const auto row = static_cast<Eigen::Index>(2 * i);
      design.row(row) << c * along - s * across, -s * along - c * across, 1.0, 0.0;
      design.row(row + 1) << s * along + c * across, c * along - s * across, 0.0, 1.0;
      places[row] = x.value[i];
      places[row + 1] = y.value[i];
    }
    const Eigen::Matrix4d inverse = (design.transpose() * design).inverse();
    if (!inverse.allFinite()) return;
    const Eigen::Vector4d motion = inverse * (design.transpose() * places);
    for (int k = 0; k < options_.stations; ++k) {
      const double share = (k + 0.5) / options_.stations;
      const double at_s = window_.start_s + share * (window_.end_s - window_.start_s);
      const double t = at_s - heading.mid_s, turned = heading.rate * t;
      const double along = std::abs(turned) < 1e-6 ? t : std::sin(turned) / heading.rate;
      const double across =
          std::abs(turned) < 1e-6 ? 0.5 * turned * t : (1.0 - std::cos(turned)) / heading.rate;
      const double c = std::cos(heading.offset), s = std::sin(heading.offset);
      const double forward = motion[0] * along - motion[1] * across;
      const double leftward = motion[0] * across + motion[1] * along;
      window_.stations.push_back(
          {motion[2] + c * forward - s * leftward, motion[3] + s * forward + c * leftward, heading.at(at_s)});
    }
    const sim::DriveCommand& command = drive_.command;
    const double yaw_rate = heading.rate * std::cos(pitch_rad) / std::cos(roll_rad);
    if (command.turn_in_place) {
      observe(Channel::kSlip, -1, 1.0 - yaw_rate / command.turn_rate_rad_s,
              std.attitude_rad * heading.rate_error / std::abs(command.turn_rate_rad_s));
      return;
    }
    const Eigen::Vector2d travel = sim::travel_direction(command);
    const double leftward = motion[1] / std::cos(roll_rad);
    const double forward =
        (motion[0] - leftward * std::sin(pitch_rad) * std::sin(roll_rad)) / std::cos(pitch_rad);
    const double along = travel.x() * forward + travel.y() * leftward;
    const double slip = 1.0 - along / command.speed_m_s;
    const double speed_std = std.position_m * std::sqrt(inverse(0, 0));
    window_.censored = slip > kCensoredSlip;
    const double speed = std::abs(command.speed_m_s);
    // A heading that is off turns forward into sideways motion.
    const double side_std =
        std::hypot(speed_std / speed, std.attitude_rad * heading.offset_error * std::abs(along) / speed);
    observe(Channel::kSlip, -1, slip, speed_std / speed);
    observe(Channel::kSideSlip, -1, (travel.x() * leftward - travel.y() * forward) / speed, side_std);
    observe(Channel::kYawRate, -1, yaw_rate - command.speed_m_s * command.curvature_1_m,
            std.attitude_rad * heading.rate_error);
  }

  void add_temperature() {
    double sum = 0.0;
    int count = 0;
    for (std::size_t k = 0; k < campaign_.rover->wheels.size(); ++k) {
      const Readings temps =
          readings_of(drive_, from_, to_, [k](const DriveSample& s) { return s.wheels[k].motor_temp_c; });
      if (temps.count() == 0) continue;
      sum += temps.mean();
      ++count;
    }
    if (count > 0) window_.command.motor_temp_c = sum / count;
  }

  void add_wheels() {
    const MeasurementStd& std = campaign_.measurement_std;
    const auto commanded = sim::wheel_commands(*campaign_.rover, drive_.command);
    for (std::size_t k = 0; k < commanded.size(); ++k) {
      const int wheel = static_cast<int>(k);
      const int bearer = options_.currents_split_evenly ? -1 : wheel;
      const double sense = commanded[k].rate_rad_s < 0.0 && !options_.currents_in_sense_of_rate ? -1.0 : 1.0;
      Readings current = readings_of(drive_, from_, to_,
                                     [&](const DriveSample& s) { return sense * s.wheels[k].current_a; });
      if (current.count() > 0 && (k == 0 || bearer == wheel)) {
        const double scatter = std::hypot(std.current_a, std.current_relative * current.mean());
        current = current.kept(2.0 * scatter, options_);
        observe(Channel::kCurrent, bearer, current.mean(), scatter / std::sqrt(current.count()));
      }
      const Readings sinkage =
          readings_of(drive_, from_, to_, [&](const DriveSample& s) { return s.wheels[k].sinkage_m; });
      if (sinkage.count() > 0)
        observe(Channel::kSinkage, wheel, sinkage.mean(), std.sinkage_m / std::sqrt(sinkage.count()));
    }
  }

  const DriveCampaign& campaign_;
  const MeasuredDriveSeries& drive_;
  std::size_t from_, to_;
  const WindowOptions& options_;
  DriveWindow window_;
};

// From one row to the next, s: the median.
double interval_s(const MeasuredDriveSeries& drive) {
  std::vector<double> intervals;
  for (std::size_t i = 1; i < drive.samples.size(); ++i)
    intervals.push_back(drive.samples[i].time_s - drive.samples[i - 1].time_s);
  return median_of(std::move(intervals));
}

// How long a window lasts, s: three rows at least.
double window_s(const MeasuredDriveSeries& drive, const WindowOptions& options) {
  const double asked = drive.command.turn_in_place
                           ? options.turn_rad / std::abs(drive.command.turn_rate_rad_s)
                           : options.length_m / std::abs(drive.command.speed_m_s);
  return std::max(asked, 2.0 * interval_s(drive));
}

// Rows [from, to] without a pause: what was done in one nobody knows.
struct Stretch {
  std::size_t from = 0, to = 0;
};

// Wheels whose rates were measured turn at half of the told rates or more, taken together; none measured:
// nothing says that they don't.
bool under_way(const DriveSample& sample, const sim::PerWheel<sim::WheelCommand>& commanded) {
  double turned = 0.0, asked = 0.0;
  for (std::size_t k = 0; k < commanded.size(); ++k) {
    if (!std::isfinite(sample.wheels[k].rate_rad_s)) continue;
    turned += std::abs(sample.wheels[k].rate_rad_s);
    asked += std::abs(commanded[k].rate_rad_s);
  }
  return turned >= 0.5 * asked;
}

// From the first row to the last in which the rover is under way: a record may begin before it sets off and
// end after it halts, and what the wheels do then is not what was told. All rows where there is no such row.
Stretch driven_rows(const DriveCampaign& campaign, const MeasuredDriveSeries& drive) {
  Stretch rows{0, drive.samples.size() - 1};
  if (drive.final_only) return rows;
  const auto commanded = sim::wheel_commands(*campaign.rover, drive.command);
  while (rows.from < rows.to && !under_way(drive.samples[rows.from], commanded)) ++rows.from;
  while (rows.from < rows.to && !under_way(drive.samples[rows.to], commanded)) --rows.to;
  return rows.from < rows.to ? rows : Stretch{0, drive.samples.size() - 1};
}

std::vector<Stretch> stretches_of(const MeasuredDriveSeries& drive, const Stretch& rows, double lasting_s,
                                  const WindowOptions& options) {
  const double longest_s = std::max(options.pause_share * lasting_s, 1.5 * interval_s(drive));
  std::vector<Stretch> stretches{{rows.from, rows.from}};
  for (std::size_t i = rows.from + 1; i <= rows.to; ++i) {
    if (drive.samples[i].time_s - drive.samples[i - 1].time_s > longest_s && !drive.final_only)
      stretches.push_back({i, i});
    stretches.back().to = i;
  }
  return stretches;
}

int windows_in(const MeasuredDriveSeries& drive, const Stretch& stretch, double lasting_s) {
  if (drive.final_only) return 1;
  const double duration_s = drive.samples[stretch.to].time_s - drive.samples[stretch.from].time_s;
  return std::max(1, static_cast<int>(std::lround(duration_s / lasting_s)));
}

}  // namespace

std::string_view name_of(Channel channel) {
  return kRows[static_cast<std::size_t>(channel)].name;
}

std::string_view unit_of(Channel channel) {
  return kRows[static_cast<std::size_t>(channel)].unit;
}

double boundary_unit(Channel channel) {
  return kRows[static_cast<std::size_t>(channel)].boundary_unit;
}

// Wheels that turn backwards draw a negative current by the format; some record it in the sense of the rate.
bool currents_in_sense_of_rate(const DriveCampaign& campaign) {
  double sum = 0.0;
  for (const MeasuredDriveSeries& drive : campaign.drives) {
    const auto commanded = sim::wheel_commands(*campaign.rover, drive.command);
    for (const DriveSample& sample : drive.samples)
      for (std::size_t k = 0; k < commanded.size(); ++k)
        if (commanded[k].rate_rad_s < 0.0 && std::isfinite(sample.wheels[k].current_a))
          sum += sample.wheels[k].current_a;
  }
  return sum > 0.0;
}

bool currents_split_evenly(const DriveCampaign& campaign) {
  constexpr double kAlike = 1e-3;  // A, and of the current: as rounded
  bool any = false;
  for (const MeasuredDriveSeries& drive : campaign.drives)
    for (const DriveSample& sample : drive.samples) {
      const double first = sample.wheels[0].current_a;
      for (const WheelReading& wheel : sample.wheels) {
        const bool measured = std::isfinite(wheel.current_a);
        if (measured != std::isfinite(first)) return false;
        if (measured && std::abs(wheel.current_a - first) > kAlike * (1.0 + std::abs(first))) return false;
      }
      any = any || std::isfinite(first);
    }
  return any && campaign.rover->wheels.size() > 1;
}

std::vector<DriveWindow> cut_windows(const DriveCampaign& campaign, const WindowOptions& asked) {
  WindowOptions options = asked;
  options.currents_in_sense_of_rate = currents_in_sense_of_rate(campaign);
  options.currents_split_evenly = currents_split_evenly(campaign);
  std::vector<DriveWindow> windows;
  for (std::size_t d = 0; d < campaign.drives.size(); ++d) {
    const MeasuredDriveSeries& drive = campaign.drives[d];
    const double lasting_s = window_s(drive, options);
    for (const Stretch& stretch : stretches_of(drive, driven_rows(campaign, drive), lasting_s, options)) {
      const int count = windows_in(drive, stretch, lasting_s);
      const double start_s = drive.samples[stretch.from].time_s;
      const double step_s = (drive.samples[stretch.to].time_s - start_s) / count;
      std::size_t from = stretch.from;
      for (int w = 0; w < count; ++w) {
        std::size_t to = from;
        const double end_s = start_s + (w + 1) * step_s;
        while (to < stretch.to && drive.samples[to].time_s < end_s - 1e-9) ++to;
        if (to <= from) continue;
        DriveWindow window = WindowMaker(campaign, drive, from, to, options).make(d);
        if (!window.stations.empty() && !window.observations.empty()) windows.push_back(std::move(window));
        from = to;
      }
    }
  }
  return windows;
}

}  // namespace slipway::gap
