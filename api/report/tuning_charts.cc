#include "api/report/tuning_charts.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "api/chart/chart.h"
#include "core/angle.h"

namespace slipway::api {
namespace {

using gap::DriveTuning;

constexpr double kChiSquare95 = 5.991;  // of two degrees of freedom

ChartAxis axis_of(const std::string& parameter) {
  const std::string unit(campaign::tuning_field(parameter).value_or(Field{}).unit);
  const bool in_name = unit.empty() || unit == "1" || parameter.ends_with("_" + unit);
  return {in_name ? parameter : parameter + ", " + unit, {}, {}, false, {}};
}

// Halfway between the values by ratio where they are laid out so, and as far beyond the ends.
std::vector<double> edges_of(const std::vector<double>& values, bool logarithmic) {
  std::vector<double> v = values;
  if (logarithmic)
    for (double& x : v) x = std::log(x);
  std::vector<double> edges{1.5 * v[0] - 0.5 * v[1]};
  for (std::size_t i = 1; i < v.size(); ++i) edges.push_back(0.5 * (v[i - 1] + v[i]));
  edges.push_back(1.5 * v.back() - 0.5 * v[v.size() - 2]);
  if (logarithmic)
    for (double& x : edges) x = std::exp(x);
  return edges;
}

ChartSeries ellipse(const gap::LeastSquaresFit& fit, std::size_t x, std::size_t y) {
  ChartSeries line{.name = "95 % of least squares", .mark = ChartMark::kLine, .x = {}, .y = {}, .colour = 1};
  const auto i = static_cast<Eigen::Index>(x), j = static_cast<Eigen::Index>(y);
  Eigen::Matrix2d covariance;
  covariance << fit.covariance(i, i), fit.covariance(i, j), fit.covariance(j, i), fit.covariance(j, j);
  const Eigen::Matrix2d root = Eigen::LLT<Eigen::Matrix2d>(covariance).matrixL();
  constexpr int kSteps = 72;
  for (int k = 0; k <= kSteps; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / kSteps;
    const Eigen::Vector2d off =
        std::sqrt(kChiSquare95) * (root * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
    line.x.push_back(fit.estimate[x] + off.x());
    line.y.push_back(fit.estimate[y] + off.y());
  }
  return line;
}

std::vector<ChartSeries> bests(const DriveTuning& tuning, std::size_t x, std::size_t y) {
  const std::vector<double>& best = tuning.sweep.points[tuning.sweep.best].x;
  std::vector<ChartSeries> series{
      {.name = "best of the sweep", .mark = ChartMark::kPoints, .x = {best[x]}, .y = {best[y]}, .colour = 3}};
  if (!tuning.fit) return series;
  const gap::LeastSquaresFit& fit = tuning.fit->fit;
  series.push_back({.name = "least squares",
                    .mark = ChartMark::kPoints,
                    .x = {fit.estimate[x]},
                    .y = {fit.estimate[y]},
                    .colour = 1});
  if (fit.correlation(x, y)) series.push_back(ellipse(fit, x, y));
  return series;
}

std::string draw_surface(const std::string& title, const campaign::TableTuning& result,
                         const gap::SweepGrid& grid, std::size_t x, std::size_t y) {
  const gap::ScoreSurface surface = gap::score_surface(result.tuning.sweep, grid, x, y);
  const std::vector<std::string>& names = result.tuning.sweep.names;
  HeatMap map;
  map.title = title;
  map.x = axis_of(names[x]);
  map.y = axis_of(names[y]);
  map.x.logarithmic = result.tuning.sweep.logarithmic[x];
  map.y.logarithmic = result.tuning.sweep.logarithmic[y];
  map.x_edges = edges_of(surface.x_values, map.x.logarithmic);
  map.y_edges = edges_of(surface.y_values, map.y.logarithmic);
  map.value_title = "score, log10";
  for (const auto& score : surface.scores)
    map.values.push_back(score ? std::optional(std::log10(std::max(*score, 1e-6))) : std::nullopt);
  map.series = bests(result.tuning, x, y);
  return draw_heat_map(map);
}

// Both grids in one, rising.
std::string draw_curve(const std::string& title, const campaign::TableTuning& result) {
  const DriveTuning& tuning = result.tuning;
  std::vector<std::size_t> order(tuning.sweep.points.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return tuning.sweep.points[a].x[0] < tuning.sweep.points[b].x[0];
  });
  Chart chart;
  chart.x = axis_of(tuning.sweep.names[0]);
  chart.x.logarithmic = tuning.sweep.logarithmic[0];
  chart.y.title = "score";
  ChartSeries all{.name = "all drives", .mark = ChartMark::kLineAndPoints, .x = {}, .y = {}, .colour = 0};
  for (const std::size_t i : order) {
    if (!tuning.sweep.points[i].score) continue;
    all.x.push_back(tuning.sweep.points[i].x[0]);
    all.y.push_back(*tuning.sweep.points[i].score);
  }
  chart.series.push_back(std::move(all));
  for (std::size_t k = 0; k < tuning.tilts.size(); ++k) {
    ChartSeries line{.name = fmt::format("tilt {:.1f} deg", deg_from_rad(tuning.tilts[k].tilt_rad)),
                     .mark = ChartMark::kDashedLine,
                     .x = {},
                     .y = {},
                     .colour = k + 1};
    for (const std::size_t i : order) {
      if (!tuning.services[i].scores[k]) continue;
      line.x.push_back(tuning.sweep.points[i].x[0]);
      line.y.push_back(*tuning.services[i].scores[k]);
    }
    chart.series.push_back(std::move(line));
  }
  return draw_charts(title, std::span(&chart, 1));
}

// "soil.friction_angle_deg" -> "friction_angle_deg".
std::string short_name(const std::string& parameter) {
  return parameter.substr(parameter.rfind('.') + 1);
}

}  // namespace

std::vector<NamedChart> draw_tuning(const std::string& title, const campaign::TableTuning& result) {
  const gap::ParameterSweep& sweep = result.tuning.sweep;
  if (sweep.names.size() == 1)
    return {{"score-" + short_name(sweep.names[0]), draw_curve(title + ": score", result)}};
  std::vector<NamedChart> charts;
  for (std::size_t x = 0; x < sweep.names.size(); ++x) {
    for (std::size_t y = x + 1; y < sweep.names.size(); ++y) {
      const std::string pair = short_name(sweep.names[x]) + "-" + short_name(sweep.names[y]);
      charts.push_back({"score-coarse-" + pair,
                        draw_surface(title + ": score, coarse sweep", result, sweep.coarse, x, y)});
      charts.push_back(
          {"score-fine-" + pair, draw_surface(title + ": score, fine sweep", result, sweep.fine, x, y)});
    }
  }
  return charts;
}

}  // namespace slipway::api
