#include "research/benchmark/benchmark_figures.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/quantile.h"

namespace slipway::gap {
namespace {

std::optional<double> median_of(std::vector<double> values) {
  if (values.empty()) return std::nullopt;
  return median(std::move(values));
}

// P(X >= k) for n trials of probability p.
double upper_tail(std::size_t k, std::size_t n, double p) {
  if (k == 0) return 1.0;
  if (p <= 0.0) return 0.0;
  if (p >= 1.0) return 1.0;
  double sum = 0.0;
  for (std::size_t i = k; i <= n; ++i) {
    const auto x = static_cast<double>(i), m = static_cast<double>(n);
    sum += std::exp(std::lgamma(m + 1.0) - std::lgamma(x + 1.0) - std::lgamma(m - x + 1.0) + x * std::log(p) +
                    (m - x) * std::log1p(-p));
  }
  return std::min(sum, 1.0);
}

// The probability p at which P(X >= k) is `tail`.
double chance_of_tail(std::size_t k, std::size_t n, double tail) {
  double low = 0.0, high = 1.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (upper_tail(k, n, middle) < tail ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

void count(Rate& rate, bool hit) {
  ++rate.of;
  rate.hits += hit ? 1 : 0;
}

}  // namespace

RateInterval binomial_interval(const Rate& rate, double confidence) {
  if (rate.of == 0) return {};
  const double tail = 0.5 * (1.0 - confidence);
  RateInterval interval;
  if (rate.hits > 0) interval.low = chance_of_tail(rate.hits, rate.of, tail);
  if (rate.hits < rate.of) interval.high = chance_of_tail(rate.hits + 1, rate.of, 1.0 - tail);
  return interval;
}

std::optional<double> area_under_roc(std::span<const double> of_these, std::span<const double> of_those) {
  if (of_these.empty() || of_those.empty()) return std::nullopt;
  double wins = 0.0;
  for (const double a : of_these)
    for (const double b : of_those) wins += a > b ? 1.0 : a == b ? 0.5 : 0.0;
  return wins / static_cast<double>(of_these.size() * of_those.size());
}

std::optional<double> calibration_error(std::span<const Statement> statements) {
  if (statements.empty()) return std::nullopt;
  constexpr int kBins = 10;
  std::array<double, kBins> excess{};
  for (const Statement& s : statements) {
    const int bin = std::clamp(static_cast<int>(s.probability * kBins), 0, kBins - 1);
    excess[static_cast<std::size_t>(bin)] += s.probability - (s.right ? 1.0 : 0.0);
  }
  double sum = 0.0;
  for (const double e : excess) sum += std::abs(e);
  return sum / static_cast<double>(statements.size());
}

std::vector<ReliabilityBin> reliability_of(std::span<const Statement> statements) {
  constexpr std::size_t kBins = 10;
  std::vector<ReliabilityBin> bins(kBins);
  for (std::size_t b = 0; b < kBins; ++b) {
    bins[b].from = static_cast<double>(b) / kBins;
    bins[b].to = static_cast<double>(b + 1) / kBins;
  }
  for (const Statement& s : statements) {
    const double place = std::clamp(s.probability * kBins, 0.0, kBins - 1.0);
    ReliabilityBin& bin = bins[static_cast<std::size_t>(place)];
    bin.mean_probability += s.probability;
    count(bin.right, s.right);
  }
  for (ReliabilityBin& bin : bins)
    if (bin.right.of > 0) bin.mean_probability /= static_cast<double>(bin.right.of);
  return bins;
}

std::optional<double> brier_score(std::span<const Statement> statements) {
  if (statements.empty()) return std::nullopt;
  double sum = 0.0;
  for (const Statement& s : statements) sum += std::pow(s.probability - (s.right ? 1.0 : 0.0), 2);
  return sum / static_cast<double>(statements.size());
}

BenchmarkFigures figures_of(std::span<const CaseScore> cases) {
  BenchmarkFigures f;
  f.cases = cases.size();
  std::vector<double> outside, inside, closed, closed_of_oracle, overlap, slices, of_attainable, seconds;
  std::vector<Statement> statements, marginals;
  for (const CaseScore& c : cases) {
    count(f.verdict_right, c.verdict_right);
    count(f.confident_wrong, c.confident_wrong);
    count(f.wrong_name, c.wrong_name);
    marginals.insert(marginals.end(), c.marginals.begin(), c.marginals.end());
    count(f.held, c.held);
    if (c.truth_kind == TruthKind::kEffects) {
      count(f.exact, c.exact);
      count(f.names_right, c.names_right);
      count(f.alike, c.alike);
      if (c.size >= 1.0) {
        count(f.exact_sized, c.exact);
        count(f.alike_sized, c.alike);
      }
      if (c.closed_fraction) closed.push_back(*c.closed_fraction);
      if (c.oracle_closed_fraction && *c.oracle_closed_fraction > 0.0)
        closed_of_oracle.push_back(c.closed_fraction.value_or(0.0) / *c.oracle_closed_fraction);
    }
    if (c.wheel_right) count(f.wheel_right, *c.wheel_right);
    if (c.truth_kind == TruthKind::kNothing) count(f.alarm_nothing, c.false_alarm);
    if (c.truth_kind == TruthKind::kParameters) count(f.alarm_parameters, c.false_alarm);
    if (c.truth_kind == TruthKind::kOutsideLibrary) {
      count(f.unknown_reported, c.verdict_right);
      count(f.outside_unnamed, !c.wrong_name);
    }
    (c.truth_kind == TruthKind::kOutsideLibrary ? outside : inside).push_back(c.unknown_probability);
    statements.push_back({c.stated, c.exact});
    if (c.place_overlap) {
      overlap.push_back(*c.place_overlap);
      count(f.overlap, *c.place_overlap >= 0.5);
    }
    if (c.channel_right) count(f.channel_right, *c.channel_right);
    if (c.slice_overlap) {
      slices.push_back(*c.slice_overlap);
      count(f.slice_half, *c.slice_overlap >= 0.5);
      if (c.slice_attainable.value_or(0.0) > 0.0)
        of_attainable.push_back(*c.slice_overlap / *c.slice_attainable);
    }
    seconds.push_back(c.seconds);
  }
  f.unknown_auroc = area_under_roc(outside, inside);
  f.calibration = calibration_error(statements);
  f.brier = brier_score(statements);
  f.reliability = reliability_of(marginals);
  f.closed_fraction = median_of(closed);
  f.closed_of_oracle = median_of(closed_of_oracle);
  f.place_overlap = median_of(overlap);
  f.slice_overlap = median_of(slices);
  f.slice_of_attainable = median_of(of_attainable);
  f.seconds = median_of(seconds);
  return f;
}

Confusion confusion_of(std::span<const CaseScore> cases) {
  Confusion confusion;
  for (const CaseScore& c : cases) ++confusion[c.truth][c.found];
  return confusion;
}

}  // namespace slipway::gap
