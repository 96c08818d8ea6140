#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/result.h"
#include "research/validation/report/statistics.h"

namespace slipway::validation {

// Four seconds of a drive of the rover Cuadriga on slopes. Neighbouring windows of a log overlap by half, so
// that whole logs must be held out and resampled.
struct CuadrigaWindow {
  std::string log;
  double time_s = 0.0;
  double east_m = 0.0, north_m = 0.0;              // EPSG:32630
  double heading_rad = 0.0;                        // counter-clockwise from east
  double distance_m = 0.0;                         // driven within the window
  double path_gradient_rad = 0.0;                  // of the ground along the path, positive uphill
  double dem_pitch_rad = 0.0, dem_roll_rad = 0.0;  // of the 1 m elevation model; pitch positive uphill
  // From the headings of the windows before and after in the log, at most 2.6 s away; from one of them where
  // the other is missing, and 0 where both are.
  double turn_rate_rad_s = 0.0;
  double wheel_speed_m_s = 0.0, gps_speed_m_s = 0.0;
  double slip_ratio = 0.0;  // 1 - distance / (duration x wheel speed), also where negative; noise below 0.03
  double total_current_a = 0.0;      // of all motors
  double charge_per_metre_as = 0.0;  // A s per metre of distance

  double duration_s() const { return charge_per_metre_as * distance_m / total_current_a; }
  // Whether the GPS positions jumped, so that slip and charge per metre are worthless: the distance between
  // them is more than 1.4 times the receiver's own speed times the duration. In the other windows this ratio
  // is at most 1.31, in these at least 1.49.
  bool position_jumped() const { return distance_m > 1.4 * gps_speed_m_s * duration_s(); }
};

// Errors: unreadable_data.
Result<std::vector<CuadrigaWindow>> load_cuadriga_windows(const std::filesystem::path& csv);

// The windows of a range of gradients, [lowest, highest), and a median of theirs.
struct GradientGroup {
  double lowest_rad = 0.0, highest_rad = 0.0;
  std::size_t windows = 0, logs = 0;
  double median = 0.0;
  Interval interval;  // bootstrap over logs, 95 %; without meaning for one log, where it is the median itself
};

// Groups of equal width over [lowest, highest); those without windows are left out.
std::vector<GradientGroup> group_by_gradient(const std::vector<CuadrigaWindow>& windows,
                                             double CuadrigaWindow::*quantity, double lowest_rad,
                                             double highest_rad, double width_rad, std::uint64_t seed);

}  // namespace slipway::validation
