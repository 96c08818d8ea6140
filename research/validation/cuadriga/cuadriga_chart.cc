#include "research/validation/cuadriga/cuadriga_chart.h"

#include <cmath>
#include <functional>

#include "api/chart/chart.h"
#include "core/angle.h"

namespace slipway::validation {
namespace {

using Predict = std::function<Prediction(const ClimbConditions&)>;

api::Chart chart_of(const std::string& title, const CrossValidation& answer, double CuadrigaWindow::*measured,
                    double turn_rate_rad_s, const Predict& predict, double lowest, double highest) {
  api::Chart chart;
  chart.title = title;
  chart.x.title = "path gradient, deg (positive uphill)";
  chart.y = {title, lowest, highest, false, {}};
  api::ChartSeries dots{"held-out windows", api::ChartMark::kDots, {}, {}, 5};
  for (const HeldOut& h : answer.windows) {
    if (h.window.position_jumped()) continue;
    dots.x.push_back(deg_from_rad(h.window.path_gradient_rad));
    dots.y.push_back(h.window.*measured);
  }
  api::ChartBand wide{"90 %", {}, {}, {}, 1}, narrow{"50 %", {}, {}, {}, 1};
  api::ChartSeries line{"predicted median", api::ChartMark::kLine, {}, {}, 1};
  for (double degrees = ClimbTable::kMinGradient_deg; degrees <= -ClimbTable::kMinGradient_deg;
       degrees += 1.0) {
    const Prediction p = predict({rad_from_deg(degrees), turn_rate_rad_s});
    for (auto* xs : {&wide.x, &narrow.x, &line.x}) xs->push_back(degrees);
    line.y.push_back(p.median);
    wide.lower.push_back(p.low_90);
    wide.upper.push_back(p.high_90);
    narrow.lower.push_back(p.low_50);
    narrow.upper.push_back(p.high_50);
  }
  chart.bands = {wide, narrow};
  chart.series = {dots, line};
  return chart;
}

}  // namespace

std::string draw_cuadriga_drives(const std::string& title, const CrossValidation& answer) {
  std::vector<double> turns, speeds;
  for (const HeldOut& h : answer.windows) {
    turns.push_back(std::abs(h.window.turn_rate_rad_s));
    speeds.push_back(h.window.wheel_speed_m_s);
  }
  const double turn = median(turns), speed = median(speeds);
  const CuadrigaFit& fit = answer.of_all;
  const api::Chart charts[] = {
      chart_of(
          "slip", answer, &CuadrigaWindow::slip_ratio, turn,
          [&](const ClimbConditions& at) { return predict_slip(fit, at); }, -0.4, 0.8),
      chart_of(
          "charge per metre, A s", answer, &CuadrigaWindow::charge_per_metre_as, turn,
          [&](const ClimbConditions& at) { return predict_charge(fit, at, speed); }, 0.0, 140.0)};
  return api::draw_charts(title, charts);
}

}  // namespace slipway::validation
