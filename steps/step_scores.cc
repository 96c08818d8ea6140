#include "steps/step_scores.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/angle.h"
#include "core/quantile.h"
#include "core/random.h"

namespace slipway::steps {
namespace {

constexpr int kResamples = 400;

struct Chance {
  double probability;
  bool above;
};

// The share of pairs of one case above and one not above that are in the right order; ties count half.
double area_under_curve(std::vector<Chance> cases) {
  std::stable_sort(cases.begin(), cases.end(),
                   [](const Chance& a, const Chance& b) { return a.probability < b.probability; });
  double pairs = 0.0, below = 0.0, above = 0.0;
  for (std::size_t i = 0; i < cases.size();) {
    std::size_t end = i;
    double here_above = 0.0;
    for (; end < cases.size() && cases[end].probability == cases[i].probability; ++end)
      here_above += cases[end].above ? 1.0 : 0.0;
    const double here_below = static_cast<double>(end - i) - here_above;
    pairs += here_above * (below + 0.5 * here_below);
    above += here_above;
    below += here_below;
    i = end;
  }
  return above > 0.0 && below > 0.0 ? pairs / (above * below) : 0.5;
}

ProbabilityScore score_of(const std::vector<Chance>& cases) {
  constexpr std::array kEdges{0.0, 0.001, 0.01, 0.03, 0.1, 0.3, 1.0};
  constexpr double kLeast = 1e-6;
  ProbabilityScore out{.cases = cases.size(), .auc = area_under_curve(cases), .bins = {}};
  for (std::size_t b = 0; b + 1 < kEdges.size(); ++b)
    out.bins.push_back({.least = kEdges[b], .most = kEdges[b + 1]});
  for (const Chance& each : cases) {
    out.above += each.above ? 1 : 0;
    out.expected += each.probability;
    const double p = std::clamp(each.probability, kLeast, 1.0 - kLeast);
    out.log_score += std::log(each.above ? p : 1.0 - p) / static_cast<double>(cases.size());
    std::size_t b = 0;
    while (b + 1 < out.bins.size() && each.probability >= out.bins[b].most) ++b;
    out.bins[b].cases += 1;
    out.bins[b].expected += each.probability;
    out.bins[b].above += each.above ? 1 : 0;
  }
  return out;
}

struct Errors {
  std::vector<double> absolute;
  double squares = 0.0;
  std::size_t in_band = 0;

  void add(const ScoredSol& sol, std::size_t i) {
    const StepForecast& f = sol.forecast.steps[i];
    const double slip = sol.steps[i].slip, error = slip - f.slip_p50;
    absolute.push_back(std::abs(error));
    squares += error * error;
    in_band += slip >= f.slip_p05 && slip <= f.slip_p95 ? 1 : 0;
  }
  double rms() const { return std::sqrt(squares / static_cast<double>(absolute.size())); }
  double share_in_band() const { return static_cast<double>(in_band) / static_cast<double>(absolute.size()); }
  BandScore as(std::string name) const {
    return {std::move(name), absolute.size(), share_in_band(), median(absolute)};
  }
};

Estimate with_interval(double value, const std::vector<double>& resampled) {
  return {value, quantile(resampled, 0.05), quantile(resampled, 0.95)};
}

void add_errors(std::span<const ScoredSol> sols, StepScores& out) {
  Errors all;
  for (const ScoredSol& sol : sols)
    for (std::size_t i = 0; i < sol.steps.size(); ++i) all.add(sol, i);
  constexpr std::uint64_t kKey = 1993;  // any
  std::vector<double> medians, rms, in_band;
  for (std::uint64_t k = 0; k < kResamples; ++k) {
    Errors drawn;
    for (std::size_t s = 0; s < sols.size(); ++s) {
      const ScoredSol& sol = sols[random_bits(random_key(kKey, k), s) % sols.size()];
      for (std::size_t i = 0; i < sol.steps.size(); ++i) drawn.add(sol, i);
    }
    medians.push_back(median(drawn.absolute));
    rms.push_back(drawn.rms());
    in_band.push_back(drawn.share_in_band());
  }
  out.steps = all.absolute.size();
  out.median_error = with_interval(median(all.absolute), medians);
  out.rms_error = with_interval(all.rms(), rms);
  out.in_band = with_interval(all.share_in_band(), in_band);
}

void add_bins(std::span<const ScoredSol> sols, StepScores& out) {
  constexpr std::array kEdges_deg{-90.0, -10.0, -6.0, -3.0, 0.0, 3.0, 6.0, 10.0, 15.0, 90.0};
  std::array<Errors, kEdges_deg.size() - 1> bins;
  for (const ScoredSol& sol : sols) {
    Errors of_sol;
    for (std::size_t i = 0; i < sol.steps.size(); ++i) {
      const double pitch_deg = deg_from_rad(sol.steps[i].pitch_rad);
      std::size_t b = 0;
      while (b + 1 < bins.size() && pitch_deg >= kEdges_deg[b + 1]) ++b;
      bins[b].add(sol, i);
      of_sol.add(sol, i);
    }
    out.by_sol.push_back(of_sol.as(fmt::format("{}", sol.sol)));
  }
  for (std::size_t b = 0; b < bins.size(); ++b)
    if (!bins[b].absolute.empty())
      out.by_pitch.push_back(bins[b].as(fmt::format("{:g} to {:g} deg", kEdges_deg[b], kEdges_deg[b + 1])));
}

}  // namespace

StepScores score(std::span<const ScoredSol> sols) {
  StepScores out;
  out.sols = sols.size();
  if (sols.empty()) return out;
  add_errors(sols, out);
  add_bins(sols, out);
  std::vector<Chance> step_0_2, step_0_4, sol_0_2, sol_0_4;
  for (const ScoredSol& sol : sols) {
    bool any_0_2 = false, any_0_4 = false;
    for (std::size_t i = 0; i < sol.steps.size(); ++i) {
      const StepForecast& f = sol.forecast.steps[i];
      const double slip = sol.steps[i].slip;
      step_0_2.push_back({f.over_0_2, slip > 0.2});
      step_0_4.push_back({f.over_0_4, slip > 0.4});
      any_0_2 = any_0_2 || slip > 0.2;
      any_0_4 = any_0_4 || slip > 0.4;
      out.mean_log_density += f.log_density / static_cast<double>(out.steps);
    }
    sol_0_2.push_back({sol.forecast.any_over_0_2, any_0_2});
    sol_0_4.push_back({sol.forecast.any_over_0_4, any_0_4});
  }
  out.step_over_0_2 = score_of(step_0_2);
  out.step_over_0_4 = score_of(step_0_4);
  out.sol_over_0_2 = score_of(sol_0_2);
  out.sol_over_0_4 = score_of(sol_0_4);
  return out;
}

}  // namespace slipway::steps
