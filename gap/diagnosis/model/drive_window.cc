#include "gap/diagnosis/model/drive_window.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "core/angle.h"
#include "core/quantile.h"
#include "gap/diagnosis/model/window_readings.h"

namespace slipway::gap {
namespace {

// The rover's channels, then those of each wheel.
std::vector<Observation> observations_of(const WindowReadings& readings) {
  std::vector<Observation> observations;
  const std::span<const ChannelRow> rows = channel_catalogue();
  const auto observe = [&](bool per_wheel, std::size_t wheel) {
    for (std::size_t c = 0; c < rows.size(); ++c) {
      if (rows[c].per_wheel != per_wheel) continue;
      if (const std::optional<Measured> measured = rows[c].observe(readings, wheel))
        observations.push_back({static_cast<Channel>(c),
                                per_wheel && !measured->mean_of_wheels ? static_cast<int>(wheel) : -1,
                                measured->value, measured->sensor_std});
    }
  };
  observe(false, 0);
  for (std::size_t k = 0; k < readings.campaign().rover->wheels.size(); ++k) observe(true, k);
  return observations;
}

DriveWindow window_of(const WindowReadings& readings, std::size_t drive, double start_s, double end_s) {
  DriveWindow window;
  window.drive = drive;
  window.start_s = start_s;
  window.end_s = end_s;
  window.command = readings.drive().command;
  if (const auto temp_c = readings.motor_temp_c()) window.command.motor_temp_c = temp_c;
  window.distance_m = std::abs(window.command.speed_m_s) * (end_s - start_s);
  window.stations = readings.motion().stations;
  window.first_yaw_rad = readings.motion().first_yaw_rad;
  window.censored = readings.motion().censored;
  window.observations = observations_of(readings);
  return window;
}

// From one row to the next, s: the median.
double interval_s(const MeasuredDriveSeries& drive) {
  std::vector<double> intervals;
  for (std::size_t i = 1; i < drive.samples.size(); ++i)
    intervals.push_back(drive.samples[i].time_s - drive.samples[i - 1].time_s);
  return median(std::move(intervals));
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

// Wheels whose rates were measured turn at half of the commanded rates or more, taken together; none
// measured: nothing says that they don't.
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
// end after it halts, and what the wheels do then is not what was commanded. All rows where there is no such
// row.
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

// Windows begin with their own first headings; then all of a drive have that of its first window. From one
// window's middle to the next the rover turns by less than half a turn.
void share_first_headings(std::vector<DriveWindow>& windows) {
  for (std::size_t w = 1; w < windows.size(); ++w) {
    const DriveWindow& before = windows[w - 1];
    DriveWindow& now = windows[w];
    if (before.drive != now.drive) continue;
    const double turned = before.middle().yaw_rad - before.first_yaw_rad +
                          wrapped_rad(now.middle().yaw_rad - before.middle().yaw_rad);
    now.first_yaw_rad = now.middle().yaw_rad - turned;
  }
}

int windows_in(const MeasuredDriveSeries& drive, const Stretch& stretch, double lasting_s) {
  if (drive.final_only) return 1;
  const double duration_s = drive.samples[stretch.to].time_s - drive.samples[stretch.from].time_s;
  return std::max(1, static_cast<int>(std::lround(duration_s / lasting_s)));
}

}  // namespace

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
        DriveWindow window = window_of(WindowReadings(campaign, drive, from, to, options), d,
                                       drive.samples[from].time_s, drive.samples[to].time_s);
        if (!window.stations.empty() && !window.observations.empty()) windows.push_back(std::move(window));
        from = to;
      }
    }
  }
  share_first_headings(windows);
  return windows;
}

}  // namespace slipway::gap
