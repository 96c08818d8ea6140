#include "api/report/soil_estimate_chart.h"

#include <fmt/format.h>

#include <vector>

#include "api/chart/chart.h"

namespace slipway::api {

std::string draw_soil_estimate(const gap::SoilEstimate& estimate) {
  constexpr std::size_t kFew = 100;
  std::vector<Chart> charts;
  for (const gap::ChannelResidual& channel : estimate.channels) {
    Chart chart;
    chart.title = gap::name_of(channel.channel);
    chart.x.title = fmt::format("measured, {}", gap::unit_of(channel.channel));
    chart.y.title = fmt::format("fitted, {}", gap::unit_of(channel.channel));
    chart.diagonal = true;
    const ChartMark mark = channel.count > kFew ? ChartMark::kDots : ChartMark::kPoints;
    ChartSeries fitted{"readings", mark, {}, {}, 0}, outliers{"outliers", mark, {}, {}, 1};
    for (const gap::FittedDatum& d : estimate.data) {
      if (d.datum.channel != channel.channel) continue;
      ChartSeries& series = d.outlier ? outliers : fitted;
      series.x.push_back(d.datum.measured);
      series.y.push_back(d.fitted);
    }
    chart.series.push_back(std::move(fitted));
    if (!outliers.x.empty()) chart.series.push_back(std::move(outliers));
    charts.push_back(std::move(chart));
  }
  return draw_charts(fmt::format("Measured and fitted: {}", estimate.soil.name), charts);
}

}  // namespace slipway::api
