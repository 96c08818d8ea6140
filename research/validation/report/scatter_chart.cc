#include "research/validation/report/scatter_chart.h"

#include <algorithm>

namespace slipway::validation {

api::Chart scatter_chart(const std::string& quantity, const std::vector<double>& measured,
                         const std::vector<double>& predicted) {
  api::Chart chart;
  chart.title = quantity;
  chart.x.title = "measured";
  chart.y.title = "predicted";
  chart.diagonal = true;
  chart.series.push_back({"", api::ChartMark::kPoints, measured, predicted, 0});
  if (!measured.empty() && !predicted.empty()) {
    // The same ticks on both axes.
    const auto [x0, x1] = std::minmax_element(measured.begin(), measured.end());
    const auto [y0, y1] = std::minmax_element(predicted.begin(), predicted.end());
    const auto ticks = api::nice_ticks(std::min(*x0, *y0), std::max(*x1, *y1), 6);
    chart.x.lowest = chart.y.lowest = ticks.front();
    chart.x.highest = chart.y.highest = ticks.back();
  }
  return chart;
}

}  // namespace slipway::validation
