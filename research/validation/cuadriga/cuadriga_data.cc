#include <fmt/format.h>

#include <cmath>
#include <set>

#include "api/chart/chart.h"
#include "core/angle.h"
#include "research/validation/cuadriga/comparisons.h"
#include "research/validation/cuadriga/cuadriga_windows.h"

namespace slipway::validation {
namespace {

constexpr std::size_t kMinLogs = 3;  // for an interval over logs to have a meaning
constexpr double kMinGradient_deg = -28.0, kMaxGradient_deg = 28.0, kWidth_deg = 4.0;

// Medians that are given with the data and said to be of all years, with the gradient at which each group
// begins.
struct MedianOfAllYears {
  double lowest_deg, slip, charge_as;
};
constexpr MedianOfAllYears kAllYears[] = {
    {0.0, 0.007, 21.1}, {8.0, 0.048, 28.6}, {12.0, 0.080, 37.4}, {16.0, 0.185, 54.3}};

std::vector<GradientGroup> groups_of(const std::vector<CuadrigaWindow>& windows,
                                     double CuadrigaWindow::*quantity, std::uint64_t seed) {
  return group_by_gradient(windows, quantity, rad_from_deg(kMinGradient_deg), rad_from_deg(kMaxGradient_deg),
                           rad_from_deg(kWidth_deg), seed);
}

api::Chart chart_of(const char* title, const std::vector<CuadrigaWindow>& windows,
                    double CuadrigaWindow::*quantity, const std::vector<GradientGroup>& groups, double lowest,
                    double highest) {
  api::Chart chart;
  chart.title = title;
  chart.x.title = "path gradient, deg (positive uphill)";
  chart.y = {title, lowest, highest, false, {}};
  api::ChartSeries points{"windows of 4 s", api::ChartMark::kDots, {}, {}, 5};
  for (const CuadrigaWindow& w : windows) {
    points.x.push_back(deg_from_rad(w.path_gradient_rad));
    points.y.push_back(w.*quantity);
  }
  api::ChartBand band{"95 % interval over logs", {}, {}, {}, 1};
  api::ChartSeries line{"median", api::ChartMark::kLineAndPoints, {}, {}, 1};
  for (const GradientGroup& group : groups) {
    const double middle = deg_from_rad(0.5 * (group.lowest_rad + group.highest_rad));
    if (group.logs < kMinLogs) continue;
    line.x.push_back(middle);
    line.y.push_back(group.median);
    band.x.push_back(middle);
    band.lower.push_back(group.interval.low);
    band.upper.push_back(group.interval.high);
  }
  chart.bands = {band};
  chart.series = {points, line};
  return chart;
}

std::string interval_words(const GradientGroup& group, const char* format) {
  if (group.logs < kMinLogs) return "too few logs";
  return fmt::format(fmt::runtime(format), group.interval.low, group.interval.high);
}

void add_group(const GradientGroup& slip, const GradientGroup& charge, Report& report) {
  const double lowest_deg = deg_from_rad(slip.lowest_rad);
  const std::string name = fmt::format("{:.0f} to {:.0f}", lowest_deg, deg_from_rad(slip.highest_rad));
  std::string slip_all = "-", charge_all = "-";
  for (const MedianOfAllYears& m : kAllYears)
    if (std::abs(lowest_deg - m.lowest_deg) < 0.1) {
      slip_all = fmt::format("{:.3f}", m.slip);
      charge_all = fmt::format("{:.1f}", m.charge_as);
    }
  report.rows.push_back({name, fmt::format("{}", slip.windows), fmt::format("{}", slip.logs),
                         fmt::format("{:.3f}", slip.median), interval_words(slip, "{:.3f} to {:.3f}"),
                         slip_all, fmt::format("{:.1f}", charge.median),
                         interval_words(charge, "{:.1f} to {:.1f}"), charge_all});
  report.cases.push_back({"gradient " + name + " deg", "slip", "1", slip.median, {}});
  report.cases.push_back({"gradient " + name + " deg", "charge_per_metre", "A s/m", charge.median, {}});
}

}  // namespace

Result<Report> cuadriga_data(const std::filesystem::path& data) {
  const auto windows = load_cuadriga_windows(data / "validation" / "cuadriga_windows.csv");
  if (!windows) return fail(windows.error());
  const auto slips = groups_of(*windows, &CuadrigaWindow::slip_ratio, 1);
  const auto charges = groups_of(*windows, &CuadrigaWindow::charge_per_metre_as, 2);
  Report report;
  report.title = "Slip and charge per metre of a real rover by slope: the data and their scatter";
  report.source =
      "University of Malaga (spaceuma/CAMIS_python), the skid-steered four-wheeler Cuadriga, about 83 kg, on "
      "natural slopes in 2018 and 2019: 624 windows of 4 s that overlap by half; intervals by resampling "
      "logs";
  report.columns = {"gradient deg",         "windows", "logs",     "slip, median", "95 %", "all years",
                    "charge A s/m, median", "95 %",    "all years"};
  std::set<std::string> logs;
  double slip_off = 0.0;
  std::size_t jumped = 0;
  for (const CuadrigaWindow& w : *windows) {
    logs.insert(w.log);
    const double speed_m_s = w.distance_m / w.duration_s();
    if (w.position_jumped())
      ++jumped;
    else
      slip_off = std::max(slip_off, std::abs(1.0 - speed_m_s / w.wheel_speed_m_s - w.slip_ratio));
  }
  for (std::size_t k = 0; k < slips.size(); ++k) add_group(slips[k], charges[k], report);
  report.notes = {
      "The medians given with the data, which are said to be of all years, are not those of these "
      "windows of 2018 and 2019: slip and charge are lower here on every gradient that both have. "
      "No filter on GPS error, roll, date or sign of slip was found that gives those medians, nor "
      "does the map's pitch in place of the path's gradient. Where there is an interval, they are "
      "within it.",
      "Wheel speed was calibrated on level driving, so a slip below 0.03 is noise. Voltage was not "
      "logged; charge per metre is used in place of energy. Slip is 1 - v / (r w) on both sides of "
      "zero, where v is from the distance of a window, not its mean GPS speed.",
      "In four windows the GPS positions jump (slip -0.6 to -21.7); the medians include them.",
      "The interval is that of the median over logs; where fewer than three logs reach a gradient "
      "there is none. Above 16 deg five windows are left. The soils of these sites are not known.",
      "The predictions are in the next comparison."};
  report.bands = {{"windows", static_cast<double>(windows->size()), 624, 624},
                  {"logs", static_cast<double>(logs.size()), 24, 24},
                  {"windows whose positions jump", static_cast<double>(jumped), 4, 4},
                  {"largest difference of slip to 1 - distance / (duration x wheel speed) in the others",
                   slip_off, 0.0, 0.0005}};
  const api::Chart charts[] = {
      chart_of("slip", *windows, &CuadrigaWindow::slip_ratio, slips, -0.4, 0.8),
      chart_of("charge per metre, A s", *windows, &CuadrigaWindow::charge_per_metre_as, charges, 0.0, 140.0)};
  report.plot = api::draw_charts(report.title, charts);
  return report;
}

}  // namespace slipway::validation
