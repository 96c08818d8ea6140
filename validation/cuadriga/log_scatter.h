#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace slipway::validation {

// Which fold predicts each item of a list of log names: logs stay whole, the longest are dealt first, each to
// the fold with the fewest items so far. fold_of[k] in [0, folds).
std::vector<int> folds_by_log(const std::vector<std::string>& logs, int folds);

// What is left over of one window by a prediction.
struct LogResidual {
  std::string log;
  double gradient_rad = 0.0;
  double value = 0.0;
};

// How far windows of a log that was not seen scatter about a prediction:
//
//   value = h(gradient) z,  h = 1 + growth (gradient / 10 deg)^2,  z = z_log + z_window
//
// growth     of the largest Laplace likelihood on a grid
// between, within   standard deviations of z_log and z_window: analysis of variance of one factor, unbalanced
// quantiles  of z itself, a window counting 1 / (1 + (n - 1) rho) with n its log's windows and rho the share
// of
//            the variance that lies between logs: what a log tells, not how long it is. Scatter here is
//            skewed and heavy in its tails; a normal distribution is not.
struct LogScatter {
  static constexpr std::array<double, 5> kShares{0.05, 0.25, 0.5, 0.75, 0.95};

  double growth = 0.0;
  double between = 0.0, within = 0.0;
  std::array<double, 5> quantiles{};  // of z, at kShares

  double at(double gradient_rad) const;  // h
  double std_at(double gradient_rad) const;
  double share_between() const;  // rho; 0 where there is no scatter
};

// Two logs at least, one of them with two windows.
LogScatter measure_scatter(const std::vector<LogResidual>& residuals);

// Of each residual: 1 / (1 + (n - 1) rho), n the number of its log's.
std::vector<double> weights_by_log(const std::vector<std::string>& logs, double share_between);

// Median, 50 and 90 % about a prediction: offsets to be added to it.
struct PredictiveOffsets {
  double low_90 = 0.0, low_50 = 0.0, median = 0.0, high_50 = 0.0, high_90 = 0.0;
};
// Scatter's quantiles, widened as the parameters' uncertainty adds to its variance.
PredictiveOffsets offsets_at(const LogScatter& scatter, double gradient_rad, double parameter_std);

// How many windows lie in their intervals: of all, the mean over logs of each log's own share, and the lowest
// of a log.
struct Coverage {
  double of_windows = 0.0, mean_over_logs = 0.0, lowest_of_a_log = 0.0;
};
Coverage coverage_of(const std::vector<std::string>& logs, const std::vector<bool>& inside);

}  // namespace slipway::validation
