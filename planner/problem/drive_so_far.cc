#include "planner/problem/drive_so_far.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace slipway::planner {
namespace {

double distance_m(const TelemetryRow& a, const TelemetryRow& b) {
  return std::hypot(b.x_m - a.x_m, b.y_m - a.y_m);
}

// The mean of what each row has since the one before, by the way that the wheels rolled.
template <class Of>
std::optional<double> mean_over(const std::vector<TelemetryRow>& rows, std::size_t first, std::size_t last,
                                const Of& of) {
  double sum = 0.0, way_m = 0.0;
  for (std::size_t k = first + 1; k <= last; ++k) {
    const std::optional<double> value = of(rows[k]);
    const double rolled_m = rows[k].driven_m - rows[k - 1].driven_m;
    if (!value || rolled_m <= 0.0) continue;
    sum += *value * rolled_m;
    way_m += rolled_m;
  }
  if (way_m <= 0.0) return std::nullopt;
  return sum / way_m;
}

// Positions that lie well apart tell the bends of the way; nearer ones tell their noise.
std::vector<std::size_t> bends(const DriveSoFar& drive, std::size_t first, std::size_t last) {
  constexpr double kMinApart_m = 0.5, kMinApartNoises = 10.0;
  const double apart_m = std::max(kMinApart_m, kMinApartNoises * drive.position_noise_m);
  std::vector<std::size_t> rows{first};
  for (std::size_t k = first + 1; k < last; ++k)
    if (distance_m(drive.rows[rows.back()], drive.rows[k]) >= apart_m &&
        distance_m(drive.rows[k], drive.rows[last]) >= apart_m)
      rows.push_back(k);
  rows.push_back(last);
  return rows;
}

TelemetryStretch stretch(const DriveSoFar& drive, const std::vector<std::string>& wheels, std::size_t first,
                         std::size_t last) {
  const std::vector<TelemetryRow>& rows = drive.rows;
  TelemetryStretch out{rows[first].driven_m, rows[last].driven_m, bends(drive, first, last), false, {}};
  out.measured.rolled_m = out.to_m - out.from_m;
  for (std::size_t k = 1; k < out.rows.size(); ++k)
    out.measured.come_m += distance_m(rows[out.rows[k - 1]], rows[out.rows[k]]);
  const TelemetryRow &begin = rows[first], &end = rows[last];
  if (const auto yaw_rad = end.yaw_rad ? end.yaw_rad : begin.yaw_rad)
    out.backwards =
        std::cos(*yaw_rad) * (end.x_m - begin.x_m) + std::sin(*yaw_rad) * (end.y_m - begin.y_m) < 0.0;
  out.measured.current_a =
      mean_over(rows, first, last, [](const TelemetryRow& row) { return row.current_a; });
  for (const std::string& wheel : wheels)
    out.measured.wheel_currents_a.push_back(
        mean_over(rows, first, last, [&](const TelemetryRow& row) -> std::optional<double> {
          const auto found = row.currents_a.find(wheel);
          return found == row.currents_a.end() ? std::nullopt : std::optional(found->second);
        }));
  return out;
}

}  // namespace

std::vector<Fault> faults_of(const DriveSoFar& drive) {
  std::vector<Fault> faults;
  const auto fault = [&](std::size_t row, const char* key, std::string message) {
    faults.push_back({fmt::format("/rows/{}{}", row, key), std::move(message)});
  };
  // Downhill a rover may come further than its wheels roll, by less than half.
  constexpr double kMaxTravel = 1.5, kDeviations = 6.0;
  for (std::size_t k = 1; k < drive.rows.size(); ++k) {
    const TelemetryRow &before = drive.rows[k - 1], &row = drive.rows[k];
    if (before.time_s && row.time_s && *row.time_s < *before.time_s)
      fault(k, "/time_s",
            fmt::format("time_s = {:g} s, must be at least the {:g} s of the row before", *row.time_s,
                        *before.time_s));
    const double rolled_m = row.driven_m - before.driven_m;
    if (rolled_m < 0.0) {
      fault(
          k, "/driven_m",
          fmt::format("driven_m = {:g} m, must be at least the {:g} m of the row before: odometry counts all "
                      "rolling, backwards too",
                      row.driven_m, before.driven_m));
      continue;
    }
    const double come_m = distance_m(before, row);
    if (come_m > kMaxTravel * rolled_m + kDeviations * drive.position_noise_m)
      fault(k, "",
            fmt::format("({:.2f}, {:.2f}) lies {:.2f} m from the row before, while the wheels have rolled "
                        "{:.2f} m: positions and odometry do not go together",
                        row.x_m, row.y_m, come_m, rolled_m));
  }
  if (drive.rows.size() >= 2 && drive.rows.back().driven_m == drive.rows.front().driven_m)
    faults.push_back({"/rows", "the wheels have not rolled: driven_m is the same in all rows"});
  return faults;
}

std::vector<TelemetryStretch> stretches_of(const DriveSoFar& drive, const std::vector<std::string>& wheels) {
  constexpr double kMinLength_m = 2.0, kMinLengthNoises = 20.0, kMaxStretches = 40.0;
  const std::vector<TelemetryRow>& rows = drive.rows;
  const double length_m = std::max({kMinLength_m, kMinLengthNoises * drive.position_noise_m,
                                    (rows.back().driven_m - rows.front().driven_m) / kMaxStretches});
  std::vector<std::size_t> ends{0};
  for (std::size_t k = 1; k < rows.size(); ++k)
    if (rows[k].driven_m - rows[ends.back()].driven_m >= length_m) ends.push_back(k);
  // A rest that is too short belongs to the stretch before it.
  if (ends.back() + 1 < rows.size() && rows.back().driven_m > rows[ends.back()].driven_m) {
    if (ends.size() > 1 && rows.back().driven_m - rows[ends.back()].driven_m < 0.5 * length_m)
      ends.pop_back();
    ends.push_back(rows.size() - 1);
  }
  std::vector<TelemetryStretch> stretches;
  for (std::size_t k = 1; k < ends.size(); ++k)
    stretches.push_back(stretch(drive, wheels, ends[k - 1], ends[k]));
  return stretches;
}

}  // namespace slipway::planner
