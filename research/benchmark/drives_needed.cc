#include "research/benchmark/drives_needed.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/quantile.h"

namespace slipway::gap {
namespace {

// The probability that n fair coins show at most k heads.
double lower_tail_of_coins(std::size_t k, std::size_t n) {
  double sum = 0.0, term = std::pow(0.5, static_cast<double>(n));
  for (std::size_t i = 0; i <= k; ++i) {
    sum += term;
    term *= static_cast<double>(n - i) / static_cast<double>(i + 1);
  }
  return sum;
}

}  // namespace

std::optional<std::size_t> drives_needed(std::span<const AcquisitionStep> steps) {
  for (std::size_t i = 0; i < steps.size(); ++i)
    if (steps[i].right && (i + 1 == steps.size() || steps[i + 1].right)) return steps[i].drives;
  return std::nullopt;
}

std::optional<double> DrivesNeededCase::random_median() const {
  std::vector<double> values;
  for (const auto& needed : random)
    values.push_back(needed ? static_cast<double>(*needed) : std::numeric_limits<double>::infinity());
  const double middle = median(std::move(values));
  return std::isfinite(middle) ? std::optional(middle) : std::nullopt;
}

std::optional<double> DrivesNeededCase::ratio(std::size_t first) const {
  const std::optional<double> median = random_median();
  if (!designed && !median) return std::nullopt;
  const auto most = static_cast<double>(limit);
  const double ours = designed ? static_cast<double>(*designed) : most, theirs = median.value_or(most);
  const auto begun = static_cast<double>(first);
  if (ours <= begun && theirs <= begun) return std::nullopt;
  return ours / theirs;
}

DrivesNeededSummary summary_of(std::span<const DrivesNeededCase> cases, std::size_t first) {
  constexpr double kTail = 0.05;
  constexpr std::size_t kMin = 5;
  DrivesNeededSummary summary;
  std::vector<double> ratios;
  for (const DrivesNeededCase& c : cases) {
    ++summary.campaigns;
    if (!c.designed) ++summary.designed_not_found;
    for (const auto& needed : c.random) {
      ++summary.random_runs;
      if (!needed) ++summary.random_not_found;
    }
    const std::optional<double> median = c.random_median();
    if (c.designed && median && *c.designed <= first && *median <= static_cast<double>(first))
      ++summary.first_enough;
    if (const auto ratio = c.ratio(first)) ratios.push_back(*ratio);
  }
  summary.compared = ratios.size();
  if (ratios.empty()) return summary;
  summary.median_ratio = median(ratios);
  if (ratios.size() < kMin) return summary;
  std::sort(ratios.begin(), ratios.end());
  std::size_t outside = 0;  // of either end
  while (lower_tail_of_coins(outside, ratios.size()) <= kTail) ++outside;
  if (outside == 0) return summary;
  summary.ratio_low = ratios[outside - 1];
  summary.ratio_high = ratios[ratios.size() - outside];
  return summary;
}

}  // namespace slipway::gap
