#include <fmt/format.h>

#include <cmath>
#include <set>

#include "api/chart.h"
#include "core/angle.h"
#include "validation/comparisons.h"
#include "validation/cuadriga_windows.h"

namespace slipway::validation {
namespace {

constexpr double kLowest_deg = -28.0, kHighest_deg = 28.0, kWidth_deg = 4.0;

// Medians that were published with the windows, by the gradient a group begins at.
struct PublishedMedian {
  double lowest_deg, slip, charge_as;
};
constexpr PublishedMedian kPublished[] = {
    {0.0, 0.007, 21.1}, {8.0, 0.048, 28.6}, {12.0, 0.080, 37.4}, {16.0, 0.185, 54.3}};

std::vector<GradientGroup> groups_of(const std::vector<CuadrigaWindow>& windows,
                                     double CuadrigaWindow::*quantity, std::uint64_t seed) {
  return group_by_gradient(windows, quantity, rad_from_deg(kLowest_deg), rad_from_deg(kHighest_deg),
                           rad_from_deg(kWidth_deg), seed);
}

api::Chart chart_of(const char* title, const std::vector<CuadrigaWindow>& windows,
                    double CuadrigaWindow::*quantity, const std::vector<GradientGroup>& groups, double lowest,
                    double highest) {
  api::Chart chart;
  chart.title = title;
  chart.x.title = "path gradient, deg (positive uphill)";
  chart.y = {title, lowest, highest, false, {}};
  api::ChartSeries points{"windows of 4 s", api::ChartMark::kPoints, {}, {}, 5};
  for (const CuadrigaWindow& w : windows) {
    points.x.push_back(deg_from_rad(w.path_gradient_rad));
    points.y.push_back(w.*quantity);
  }
  api::ChartBand band{"95 % interval over logs", {}, {}, {}, 1};
  api::ChartSeries line{"median", api::ChartMark::kLineAndPoints, {}, {}, 1};
  for (const GradientGroup& group : groups) {
    const double middle = deg_from_rad(0.5 * (group.lowest_rad + group.highest_rad));
    line.x.push_back(middle);
    line.y.push_back(group.median);
    if (group.logs < 3) continue;
    band.x.push_back(middle);
    band.lower.push_back(group.interval.low);
    band.upper.push_back(group.interval.high);
  }
  chart.bands = {band};
  chart.series = {points, line};
  return chart;
}

std::string interval_words(const GradientGroup& group, const char* format) {
  if (group.logs < 3) return "too few logs";
  return fmt::format(fmt::runtime(format), group.interval.low, group.interval.high);
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
  report.columns = {"gradient deg",         "windows", "logs", "slip, median", "95 %",
                    "charge A s/m, median", "95 %"};
  std::set<std::string> logs;
  for (const CuadrigaWindow& w : *windows) logs.insert(w.log);
  double slip_off = 0.0, charge_off = 0.0;
  for (std::size_t k = 0; k < slips.size(); ++k) {
    const GradientGroup &slip = slips[k], &charge = charges[k];
    const double lowest_deg = deg_from_rad(slip.lowest_rad);
    const std::string name =
        fmt::format("{:.0f} to {:.0f}", lowest_deg + 0.0, deg_from_rad(slip.highest_rad));
    report.rows.push_back({name, fmt::format("{}", slip.windows), fmt::format("{}", slip.logs),
                           fmt::format("{:.3f}", slip.median), interval_words(slip, "{:.3f} to {:.3f}"),
                           fmt::format("{:.1f}", charge.median), interval_words(charge, "{:.1f} to {:.1f}")});
    report.cases.push_back({"gradient " + name + " deg", "slip", "1", slip.median, {}});
    report.cases.push_back({"gradient " + name + " deg", "charge_per_metre", "A s/m", charge.median, {}});
    for (const PublishedMedian& published : kPublished) {
      if (std::abs(lowest_deg - published.lowest_deg) > 0.1) continue;
      slip_off = std::max(slip_off, std::abs(slip.median - published.slip));
      charge_off = std::max(charge_off, std::abs(charge.median - published.charge_as));
    }
  }
  report.notes = {
      "Wheel speed was calibrated on level driving, so a slip below 0.03 is noise. Voltage was not logged: "
      "charge "
      "per metre stands for energy. GPS and wheel speed are averaged over windows in which the gradient "
      "changes.",
      "The interval is of the median over logs as they happened to be driven; where fewer than three logs "
      "reach "
      "a gradient there is none. The soils of these sites are not known.",
      "No prediction stands beside them yet."};
  report.bands = {{"windows", static_cast<double>(windows->size()), 624, 624},
                  {"logs", static_cast<double>(logs.size()), 24, 24},
                  {"largest difference of slip to the medians given with the data", slip_off, 0.0, 0.0006},
                  {"largest difference of charge to them, A s/m", charge_off, 0.0, 0.06}};
  const api::Chart charts[] = {
      chart_of("slip", *windows, &CuadrigaWindow::slip_ratio, slips, -0.4, 0.8),
      chart_of("charge per metre, A s", *windows, &CuadrigaWindow::charge_per_metre_as, charges, 0.0, 140.0)};
  report.plot = api::draw_charts(report.title, charts);
  return report;
}

}  // namespace slipway::validation
