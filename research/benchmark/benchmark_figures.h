#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "research/benchmark/benchmark_score.h"

namespace slipway::gap {

// A share and its 90 % interval [Clopper & Pearson 1934].
struct Rate {
  std::size_t hits = 0, of = 0;
  double value() const { return of == 0 ? 0.0 : static_cast<double>(hits) / static_cast<double>(of); }
};
struct RateInterval {
  double low = 0.0, high = 1.0;
};
RateInterval binomial_interval(const Rate& rate, double confidence = 0.9);

// The probability that one of `of_these` is above one of `of_those`, with ties counting half; empty where
// either list is empty.
std::optional<double> area_under_roc(std::span<const double> of_these, std::span<const double> of_those);

// The mean distance of stated probability and frequency over ten bins of equal width, weighted by their
// counts.
std::optional<double> calibration_error(std::span<const Statement> statements);
std::optional<double> brier_score(std::span<const Statement> statements);

// A bin of a reliability curve: how probable its statements were on average, and how many were right.
struct ReliabilityBin {
  double from = 0.0, to = 0.0, mean_probability = 0.0;
  Rate right;
};
std::vector<ReliabilityBin> reliability_of(std::span<const Statement> statements);

// The figures of some of the cases.
struct BenchmarkFigures {
  Rate exact, alike, exact_sized,
      alike_sized;  // of campaigns with effects; "sized" are those of size 1 and above
  Rate held, verdict_right;
  Rate alarm_nothing, alarm_parameters;
  Rate unknown_reported;  // verdict "unknown" where the cause is outside the library
  Rate confident_wrong;
  // Of campaigns with effects: exactly, or partially with exactly the right names; of all campaigns: a name
  // that is not hidden; of causes outside the library alone: no effect of the library named.
  Rate names_right, wrong_name, outside_unnamed;
  Rate wheel_right;
  Rate overlap;  // soft patches whose disc overlaps by half or more
  Rate channel_right;
  Rate slice_half;  // of slices that were scored, those that overlap by half or more
  std::optional<double> slice_of_attainable;  // median of the overlaps over the attainable overlaps
  std::optional<double> unknown_auroc, calibration, brier, closed_fraction, place_overlap, slice_overlap,
      seconds;
  std::optional<double>
      closed_of_oracle;  // median share of what an oracle closes; 0 where no effect is named
  std::size_t cases = 0;
  std::vector<ReliabilityBin> reliability;  // of the marginal probabilities, by tenths; empty bins too
};
BenchmarkFigures figures_of(std::span<const CaseScore> cases);

// Counts by hidden and found causes.
using Confusion = std::map<std::string, std::map<std::string, int>>;
Confusion confusion_of(std::span<const CaseScore> cases);

}  // namespace slipway::gap
