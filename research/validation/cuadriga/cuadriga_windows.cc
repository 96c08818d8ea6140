#include "research/validation/cuadriga/cuadriga_windows.h"

#include <cmath>
#include <map>

#include "core/angle.h"
#include "core/random.h"
#include "research/validation/report/csv_table.h"

namespace slipway::validation {
namespace {

constexpr int kDraws = 2000;
constexpr double kLevel = 0.95;
constexpr double kMaxNeighbour_s = 2.6;

void set_turn_rates(std::vector<CuadrigaWindow>& windows) {
  const auto follows = [&](std::size_t k) {
    return k < windows.size() && windows[k].log == windows[k - 1].log &&
           windows[k].time_s - windows[k - 1].time_s < kMaxNeighbour_s;
  };
  for (std::size_t k = 0; k < windows.size(); ++k) {
    const std::size_t before = k > 0 && follows(k) ? k - 1 : k, after = follows(k + 1) ? k + 1 : k;
    if (before == after) continue;
    windows[k].turn_rate_rad_s = wrapped_rad(windows[after].heading_rad - windows[before].heading_rad) /
                                 (windows[after].time_s - windows[before].time_s);
  }
}

}  // namespace

Result<std::vector<CuadrigaWindow>> load_cuadriga_windows(const std::filesystem::path& csv) {
  const auto table = CsvTable::read(
      csv, {.numbers = {"t_s", "utm30n_e_m", "utm30n_n_m", "heading_deg_ccw_from_east", "distance_m",
                        "path_gradient_deg", "dem_pitch_deg", "dem_roll_deg", "wheel_speed_mps",
                        "gps_speed_mps", "slip_ratio", "total_current_A", "charge_per_metre_As"},
            .numbers_or_empty = {},
            .texts = {"log"}});
  if (!table) return fail(table.error());
  std::vector<CuadrigaWindow> windows;
  for (std::size_t row = 0; row < table->rows(); ++row) {
    const auto number = [&](std::string_view column) { return table->number(row, column); };
    CuadrigaWindow w;
    w.log = table->text(row, "log");
    w.time_s = number("t_s");
    w.east_m = number("utm30n_e_m");
    w.north_m = number("utm30n_n_m");
    w.heading_rad = rad_from_deg(number("heading_deg_ccw_from_east"));
    w.distance_m = number("distance_m");
    w.path_gradient_rad = rad_from_deg(number("path_gradient_deg"));
    w.dem_pitch_rad = rad_from_deg(number("dem_pitch_deg"));
    w.dem_roll_rad = rad_from_deg(number("dem_roll_deg"));
    w.wheel_speed_m_s = number("wheel_speed_mps");
    w.gps_speed_m_s = number("gps_speed_mps");
    w.slip_ratio = number("slip_ratio");
    w.total_current_a = number("total_current_A");
    w.charge_per_metre_as = number("charge_per_metre_As");
    windows.push_back(w);
  }
  set_turn_rates(windows);
  return windows;
}

std::vector<GradientGroup> group_by_gradient(const std::vector<CuadrigaWindow>& windows,
                                             double CuadrigaWindow::*quantity, double lowest_rad,
                                             double highest_rad, double width_rad, std::uint64_t seed) {
  std::vector<GradientGroup> groups;
  const auto count = static_cast<int>(std::lround((highest_rad - lowest_rad) / width_rad));
  for (int k = 0; k < count; ++k) {
    GradientGroup group;
    group.lowest_rad = lowest_rad + k * width_rad;
    group.highest_rad = lowest_rad + (k + 1) * width_rad;
    std::map<std::string, std::vector<double>> by_log;
    std::vector<double> all;
    for (const CuadrigaWindow& w : windows) {
      if (w.path_gradient_rad < group.lowest_rad || w.path_gradient_rad >= group.highest_rad) continue;
      by_log[w.log].push_back(w.*quantity);
      all.push_back(w.*quantity);
    }
    if (all.empty()) continue;
    std::vector<std::vector<double>> logs;
    for (auto& [name, values] : by_log) logs.push_back(std::move(values));
    group.windows = all.size();
    group.logs = logs.size();
    group.median = median(std::move(all));
    group.interval =
        median_interval_by_group(logs, kLevel, kDraws, random_key(seed, static_cast<std::uint64_t>(k)));
    groups.push_back(group);
  }
  return groups;
}

}  // namespace slipway::validation
