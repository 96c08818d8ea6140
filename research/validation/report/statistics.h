#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/quantile.h"

namespace slipway::validation {

// The median of absolute values; 0 where there are no values.
double median_abs(std::vector<double> values);

struct Agreement {
  double r = 0.0;     // Pearson's correlation
  double rms = 0.0;   // of predicted - measured
  double bias = 0.0;  // mean of predicted - measured
};
Agreement agreement(const std::vector<double>& predicted, const std::vector<double>& measured);

struct Interval {
  double low = 0.0, high = 0.0;
};

// Percentile bootstrap of the median with whole groups resampled [Efron 1979; Cameron, Gelbach and Miller
// 2008], so that values correlated within a drive are not counted as independent. groups has the values of
// each drive, at least one each; level is in (0, 1). The same seed gives the same interval.
Interval median_interval_by_group(const std::vector<std::vector<double>>& groups, double level, int draws,
                                  std::uint64_t seed);

// Percentile bootstrap of a statistic of `count` things, resampled with replacement: it is given the numbers
// of those that were drawn. Things that were compared in pairs are one thing each. count is at least 1.
Interval bootstrap_interval(std::size_t count,
                            const std::function<double(std::span<const std::size_t>)>& statistic,
                            double level, int draws, std::uint64_t seed);

// The same of the mean of values, which are for example differences between pairs.
Interval mean_interval(std::span<const double> values, double level, int draws, std::uint64_t seed);

}  // namespace slipway::validation
