#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace slipway::validation {

// The fold, in [0, folds), that predicts each item of a list of log names. Logs stay whole; the longest are
// assigned first, each to the fold with the fewest items so far.
std::vector<int> folds_by_log(const std::vector<std::string>& logs, int folds);

// The residual of a prediction in one window.
struct LogResidual {
  std::string log;
  double gradient_rad = 0.0;
  double value = 0.0;
};

// The scatter of residuals in windows of a log that was not in the fit:
//
//   value = h(gradient) z,  h = 1 + growth (gradient / 10 deg)^2,  z = z_log + z_window
//
// growth           the one with the maximum Laplace likelihood on a grid
// between, within  standard deviations of z_log and z_window, by an unbalanced one-way analysis of variance
// quantiles        of z; a window has the weight 1 / (1 + (n - 1) rho), with n windows in its log and rho the
//                  share of the variance between logs, so that a log counts by its information and not its
//                  length
//
// Quantiles are used because the scatter is skewed and has heavy tails, unlike a normal distribution.
struct LogScatter {
  static constexpr std::array<double, 5> kShares{0.05, 0.25, 0.5, 0.75, 0.95};

  double growth = 0.0;
  double between = 0.0, within = 0.0;
  std::array<double, 5> quantiles{};  // of z, at kShares

  double at(double gradient_rad) const;  // h
  double std_at(double gradient_rad) const;
  double share_between() const;  // rho; 0 where there is no scatter
};

// There must be at least two logs, one of them with two windows.
LogScatter measure_scatter(const std::vector<LogResidual>& residuals);

// The weight 1 / (1 + (n - 1) rho) of each residual, with n the number of windows in its log.
std::vector<double> weights_by_log(const std::vector<std::string>& logs, double share_between);

// Offsets that give the median and the 50 and 90 % intervals when they are added to a prediction.
struct PredictiveOffsets {
  double low_90 = 0.0, low_50 = 0.0, median = 0.0, high_50 = 0.0, high_90 = 0.0;
};
// The scatter's quantiles, widened by the variance that the parameters' uncertainty adds.
PredictiveOffsets offsets_at(const LogScatter& scatter, double gradient_rad, double parameter_std);

// The share of windows that are in their intervals: of all windows, the mean over logs of each log's own
// share, and the minimum over logs.
struct Coverage {
  double of_windows = 0.0, mean_over_logs = 0.0, lowest_of_a_log = 0.0;
};
Coverage coverage_of(const std::vector<std::string>& logs, const std::vector<bool>& inside);

}  // namespace slipway::validation
