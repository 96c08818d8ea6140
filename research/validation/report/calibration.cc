#include "research/validation/report/calibration.h"

#include <algorithm>
#include <cmath>

namespace slipway::validation {

Calibration calibration_of(std::span<const PredictedShare> shares, std::span<const double> edges) {
  std::vector<ReliabilityBin> bins;
  for (std::size_t k = 0; k + 1 < edges.size(); ++k) bins.push_back({edges[k], edges[k + 1]});
  Calibration all;
  double trials = 0.0;
  for (const PredictedShare& s : shares) {
    const auto above = std::upper_bound(edges.begin() + 1, edges.end() - 1, s.predicted);
    ReliabilityBin& bin = bins[static_cast<std::size_t>(above - edges.begin() - 1)];
    ++bin.predictions;
    bin.trials += s.trials;
    bin.predicted += s.trials * s.predicted;
    bin.came_about += s.came_about;
    trials += s.trials;
    all.share += s.came_about;
    all.brier +=
        s.came_about * std::pow(1.0 - s.predicted, 2) + (s.trials - s.came_about) * std::pow(s.predicted, 2);
  }
  all.share /= trials;
  all.brier /= trials;
  all.constant_brier = all.share * (1.0 - all.share);
  for (ReliabilityBin bin : bins) {
    if (bin.trials <= 0.0) continue;
    all.expected_error += std::abs(bin.predicted - bin.came_about) / trials;
    bin.predicted /= bin.trials;
    bin.came_about /= bin.trials;
    all.bins.push_back(bin);
  }
  return all;
}

api::Chart reliability_chart(const std::string& title, const Calibration& calibration) {
  api::Chart chart;
  chart.title = title;
  chart.x = {"predicted share", 0.0, 1.0, false, {}};
  chart.y = {"executed share", 0.0, 1.0, false, {}};
  chart.diagonal = true;
  api::ChartSeries series{"routes, binned", api::ChartMark::kLineAndPoints, {}, {}, 0};
  for (const ReliabilityBin& bin : calibration.bins) {
    series.x.push_back(bin.predicted);
    series.y.push_back(bin.came_about);
  }
  chart.series.push_back(std::move(series));
  return chart;
}

}  // namespace slipway::validation
