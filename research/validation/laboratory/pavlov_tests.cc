#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "api/chart/chart.h"
#include "core/angle.h"
#include "research/validation/laboratory/comparisons.h"
#include "research/validation/laboratory/wheel_tests.h"
#include "research/validation/report/statistics.h"

namespace slipway::validation {
namespace {

int whole_deg(double rad) {
  return static_cast<int>(std::lround(deg_from_rad(rad)));
}

std::string with_scatter(const WheelCondition& c, double WheelTest::*quantity, double scale = 1.0) {
  return fmt::format("{:.1f} +- {:.1f}", scale * c.mean(quantity), scale * c.scatter(quantity));
}

// A chart of one quantity over slip, with a line for each slip angle.
api::Chart chart_over_slip(const char* title, const std::vector<WheelCondition>& conditions,
                           double WheelTest::*quantity, double scale) {
  api::Chart chart;
  chart.title = title;
  chart.x.title = "slip";
  chart.y.title = title;
  std::size_t colour = 0;
  for (const int angle : {0, 30, 60, 90}) {
    api::ChartSeries line{
        fmt::format("slip angle {} deg", angle), api::ChartMark::kLineAndPoints, {}, {}, colour};
    ++colour;
    for (const WheelCondition& c : conditions) {
      if (whole_deg(c.slip_angle_rad) != angle) continue;
      line.x.push_back(c.mean(&WheelTest::slip_ratio));
      line.y.push_back(scale * c.mean(quantity));
    }
    chart.series.push_back(line);
  }
  return chart;
}

// The root mean square over conditions of the scatter of repeats.
double pooled_scatter(const std::vector<WheelCondition>& conditions, double WheelTest::*quantity) {
  double sum = 0.0;
  for (const WheelCondition& c : conditions) sum += std::pow(c.scatter(quantity), 2);
  return std::sqrt(sum / static_cast<double>(conditions.size()));
}

// The report with its title, source and columns, without rows.
Report pavlov_tests_report() {
  Report report;
  report.title = "189 single-wheel tests over slip and slip angle: the data and their scatter";
  report.source =
      "Pavlov and Johnson 2022 (robomechanics/3d-terramechanics): smooth wheel, r 58 mm, b 50 mm, in dry "
      "sand, "
      "travel 10 mm/s; three repeats of 63 conditions";
  report.columns = {"slip angle deg", "slip",   "half",         "repeats",
                    "load N",         "pull N", "side force N", "sinkage mm"};
  return report;
}

}  // namespace

Result<Report> pavlov_tests(const std::filesystem::path& data) {
  const auto conditions = load_wheel_conditions(data / "validation" / "single_wheel_smooth.csv");
  if (!conditions) return fail(conditions.error());
  Report report = pavlov_tests_report();
  std::size_t tests = 0, fit = 0;
  double slip_off = 0.0, command_off = 0.0;
  std::set<double> off;
  for (const WheelCondition& c : *conditions) {
    tests += c.repeats.size();
    fit += c.half == Half::kFit ? 1 : 0;
    for (const WheelTest& t : c.repeats) {
      slip_off = std::max(slip_off, std::abs(travel_slip(t.rim_speed_m_s, kPavlovTravel_m_s) - t.slip_ratio));
      const double command = std::abs(t.rim_speed_m_s - t.commanded_rim_speed_m_s);
      if (command > 5e-4) off.insert(t.commanded_rim_speed_m_s);
      command_off = std::max(command_off, command);
    }
    const std::string name = fmt::format("slip angle {} deg, slip {:.2f}", whole_deg(c.slip_angle_rad),
                                         c.mean(&WheelTest::slip_ratio));
    report.rows.push_back({fmt::format("{}", whole_deg(c.slip_angle_rad)),
                           fmt::format("{:.2f}", c.mean(&WheelTest::slip_ratio)),
                           c.half == Half::kFit ? "fit" : "predict", fmt::format("{}", c.repeats.size()),
                           with_scatter(c, &WheelTest::load_n), with_scatter(c, &WheelTest::drawbar_pull_n),
                           with_scatter(c, &WheelTest::side_force_n),
                           with_scatter(c, &WheelTest::sinkage_m, 1e3)});
    report.cases.push_back({name, "drawbar_pull", "N", c.mean(&WheelTest::drawbar_pull_n), {}});
    report.cases.push_back({name, "side_force", "N", c.mean(&WheelTest::side_force_n), {}});
    report.cases.push_back({name, "sinkage", "mm", 1e3 * c.mean(&WheelTest::sinkage_m), {}});
  }
  std::string speeds;
  for (const double speed : off)
    speeds += fmt::format("{}{:g} mm/s", speeds.empty() ? "" : ", ", 1e3 * speed);
  report.notes = {
      fmt::format("The scatter of repeats is a lower bound for the error of any prediction: pull {:.2f} N, "
                  "side force {:.2f} N, load {:.2f} N, sinkage {:.1f} mm (root mean square over "
                  "conditions).",
                  pooled_scatter(*conditions, &WheelTest::drawbar_pull_n),
                  pooled_scatter(*conditions, &WheelTest::side_force_n),
                  pooled_scatter(*conditions, &WheelTest::load_n),
                  1e3 * pooled_scatter(*conditions, &WheelTest::sinkage_m)),
      fmt::format("Conditions are split for fitting and predicting like a chessboard over slip angle and "
                  "rim speed: {} are for fitting and {} for predicting, with all repeats of a condition "
                  "together.",
                  fit, conditions->size() - fit),
      off.empty()
          ? "Every rim ran at its commanded speed to within 0.5 mm/s."
          : fmt::format("Commanded and measured rim speed differ by up to {:.1f} mm/s, at {}; slips here are "
                        "computed from the measured ones.",
                        1e3 * command_off, speeds)};
  report.bands = {
      {"tests", static_cast<double>(tests), 189, 189},
      {"conditions", static_cast<double>(conditions->size()), 63, 63},
      {"largest difference of slip to (rim - 10 mm/s) / max(10 mm/s, rim)", slip_off, 0.0, 0.0001}};
  const api::Chart charts[] = {
      chart_over_slip("drawbar pull, N", *conditions, &WheelTest::drawbar_pull_n, 1.0),
      chart_over_slip("side force, N", *conditions, &WheelTest::side_force_n, 1.0),
      chart_over_slip("sinkage, mm", *conditions, &WheelTest::sinkage_m, 1e3)};
  report.plot = api::draw_charts(report.title, charts);
  return report;
}

}  // namespace slipway::validation
