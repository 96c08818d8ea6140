#include "api/steps/step_chart.h"

#include <cmath>
#include <map>
#include <span>

#include "api/chart/chart.h"
#include "core/angle.h"
#include "core/quantile.h"

namespace slipway::api {
std::string step_chart(const StepComparison& comparison) {
  struct Forecasts {
    std::vector<double> p05, p50, p95;
  };
  std::map<int, Forecasts> by_degree;
  ChartSeries measured{"measured, below 0.2", ChartMark::kDots, {}, {}, 0};
  ChartSeries large{"measured, above 0.2", ChartMark::kPoints, {}, {}, 1};
  for (const steps::ScoredSol& sol : comparison.sols) {
    for (std::size_t i = 0; i < sol.steps.size(); ++i) {
      const double climb_deg = deg_from_rad(sol.steps[i].pitch_rad);
      ChartSeries& series = sol.steps[i].slip > 0.2 ? large : measured;
      series.x.push_back(climb_deg);
      series.y.push_back(sol.steps[i].slip);
      Forecasts& here = by_degree[static_cast<int>(std::lround(climb_deg))];
      here.p05.push_back(sol.forecast.steps[i].slip_p05);
      here.p50.push_back(sol.forecast.steps[i].slip_p50);
      here.p95.push_back(sol.forecast.steps[i].slip_p95);
    }
  }
  ChartBand band{"90 % of forecasts", {}, {}, {}, 2};
  ChartSeries middle{"median of forecasts", ChartMark::kLine, {}, {}, 2};
  for (const auto& [degree, forecasts] : by_degree) {
    band.x.push_back(degree);
    band.lower.push_back(median(forecasts.p05));
    band.upper.push_back(median(forecasts.p95));
    middle.x.push_back(degree);
    middle.y.push_back(median(forecasts.p50));
  }
  Chart chart;
  chart.x.title = "climb along the step, deg";
  chart.y.title = "slip of the step";
  chart.bands = {std::move(band)};
  chart.series = {std::move(middle), std::move(measured), std::move(large)};
  return draw_charts("Slip measured on Mars and forecast", std::span(&chart, 1));
}

}  // namespace slipway::api
