#include "planner/problem/ranking.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

#include "core/normal_interval.h"

namespace slipway::planner {
namespace {

double sum_of_weights(const std::vector<WeightedCost>& costs) {
  double sum = 0.0;
  for (const WeightedCost& each : costs) sum += each.weight;
  return sum;
}

// Half the width of Student's central interval in standard errors, from the normal's [Abramowitz & Stegun
// 26.7.5].
double student_reach(double z, double freedom) {
  const double v = std::max(freedom, 1.0);
  return z + (z * z * z + z) / (4.0 * v) +
         (5.0 * std::pow(z, 5) + 16.0 * z * z * z + 3.0 * z) / (96.0 * v * v);
}

// Each cost's share in Rockafellar & Uryasev's sum; the costs themselves where the tail is 1.
std::vector<double> shares_in_tail(const std::vector<WeightedCost>& costs, double tail) {
  const std::vector<double> in_tail = tail_weights(costs, tail);
  double value_at_risk = -1e300;
  for (const WeightedCost& each : costs) value_at_risk = std::max(value_at_risk, each.cost);
  for (std::size_t k = 0; k < costs.size(); ++k)
    if (in_tail[k] > 0.0) value_at_risk = std::min(value_at_risk, costs[k].cost);
  std::vector<double> shares;
  for (const WeightedCost& each : costs)
    shares.push_back(value_at_risk + std::max(0.0, each.cost - value_at_risk) / tail);
  return shares;
}

}  // namespace

std::string_view describe(RankBy by) {
  return by == RankBy::kCvar ? "cvar" : "expected";
}

std::string Ranking::in_words(int draws) const {
  if (by == RankBy::kExpected) return fmt::format("in the mean of {} draws", draws);
  return fmt::format("in the mean of the worst {:.3g} % of {} draws", 100.0 * tail, draws);
}

std::vector<double> tail_weights(const std::vector<WeightedCost>& costs, double tail) {
  std::vector<std::size_t> order(costs.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return costs[a].cost > costs[b].cost; });
  const double mass = tail * sum_of_weights(costs);
  std::vector<double> weights(costs.size(), 0.0);
  double left = mass;
  for (const std::size_t k : order) {
    weights[k] = std::min(costs[k].weight, left) / mass;
    left = std::max(0.0, left - costs[k].weight);
  }
  return weights;
}

double conditional_value_at_risk(const std::vector<WeightedCost>& costs, double tail) {
  const std::vector<double> weights = tail_weights(costs, tail);
  double sum = 0.0;
  for (std::size_t k = 0; k < costs.size(); ++k)
    if (weights[k] > 0.0) sum += weights[k] * costs[k].cost;  // a cost may be infinite
  return sum;
}

CostDifference difference_of(const std::vector<WeightedCost>& a, const std::vector<WeightedCost>& b,
                             double tail) {
  const auto common = static_cast<std::ptrdiff_t>(std::min(a.size(), b.size()));
  if (common == 0) return {};
  const std::vector<WeightedCost> of_a(a.begin(), a.begin() + common), of_b(b.begin(), b.begin() + common);
  const std::vector<double> shares_a = shares_in_tail(of_a, tail), shares_b = shares_in_tail(of_b, tail);
  const double all = sum_of_weights(of_a);
  double mean = 0.0, squares = 0.0, spread = 0.0;
  for (std::size_t k = 0; k < of_a.size(); ++k) mean += of_a[k].weight / all * (shares_a[k] - shares_b[k]);
  for (std::size_t k = 0; k < of_a.size(); ++k) {
    const double weight = of_a[k].weight / all, off = shares_a[k] - shares_b[k] - mean;
    squares += weight * weight;
    spread += weight * weight * off * off;
  }
  const double effective = 1.0 / squares;
  const double few = effective > 1.0 ? effective / (effective - 1.0) : 1.0;
  const double error = std::sqrt(few * spread), freedom = tail * effective - 1.0;
  const double reach = student_reach(kReach90, freedom) * error;
  return {mean, mean - reach, mean + reach, static_cast<int>(common)};
}

}  // namespace slipway::planner
