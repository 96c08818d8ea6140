#include "research/validation/cuadriga/log_scatter.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "core/angle.h"

namespace slipway::validation {
namespace {

constexpr double kMaxGrowth = 3.0, kGrowthStep = 0.05;

double growth_at(double growth, double gradient_rad) {
  const double tens = deg_from_rad(gradient_rad) / 10.0;
  return 1.0 + growth * tens * tens;
}

std::map<std::string, std::size_t> counts_of(const std::vector<std::string>& logs) {
  std::map<std::string, std::size_t> counts;
  for (const std::string& log : logs) ++counts[log];
  return counts;
}

// The scale of a Laplace distribution with h's shape is the mean of |value| / h.
double best_growth(const std::vector<LogResidual>& residuals) {
  double best = 0.0, lowest_cost = std::numeric_limits<double>::infinity();
  const auto count = static_cast<double>(residuals.size());
  for (double growth = 0.0; growth <= kMaxGrowth; growth += kGrowthStep) {
    double scale = 0.0, logs_of_h = 0.0;
    for (const LogResidual& r : residuals) {
      const double h = growth_at(growth, r.gradient_rad);
      scale += std::abs(r.value) / h / count;
      logs_of_h += std::log(h);
    }
    const double cost = count * std::log(scale) + logs_of_h;
    if (cost >= lowest_cost) continue;
    lowest_cost = cost;
    best = growth;
  }
  return best;
}

// By the expected mean squares of unequal groups [Searle et al. 1992].
void set_variances(const std::vector<std::string>& logs, const std::vector<double>& z, LogScatter& scatter) {
  struct Sum {
    double count = 0.0, sum = 0.0, squares = 0.0;
  };
  std::map<std::string, Sum> by_log;
  Sum all;
  for (std::size_t k = 0; k < z.size(); ++k)
    for (Sum* sum : {&by_log[logs[k]], &all}) {
      sum->count += 1.0;
      sum->sum += z[k];
      sum->squares += z[k] * z[k];
    }
  double inside = 0.0, among = -all.sum * all.sum / all.count, counts_squared = 0.0;
  for (const auto& [log, sum] : by_log) {
    inside += sum.squares - sum.sum * sum.sum / sum.count;
    among += sum.sum * sum.sum / sum.count;
    counts_squared += sum.count * sum.count;
  }
  const auto groups = static_cast<double>(by_log.size());
  const double within = inside / (all.count - groups);
  const double size = (all.count - counts_squared / all.count) / (groups - 1.0);
  scatter.within = std::sqrt(within);
  scatter.between = std::sqrt(std::max(0.0, (among / (groups - 1.0) - within) / size));
}

// The weighted quantile: the value at which the cumulated weights reach the share, where each weight counts
// half before and half after its value.
double weighted_quantile(const std::vector<std::pair<double, double>>& sorted, double share) {
  double total = 0.0;
  for (const auto& [value, weight] : sorted) total += weight;
  double passed = 0.0, last_place = 0.0;
  for (std::size_t k = 0; k < sorted.size(); ++k) {
    const double place = (passed + 0.5 * sorted[k].second) / total;
    if (place >= share) {
      if (k == 0) return sorted[0].first;
      const double part = (share - last_place) / (place - last_place);
      return sorted[k - 1].first + part * (sorted[k].first - sorted[k - 1].first);
    }
    passed += sorted[k].second;
    last_place = place;
  }
  return sorted.back().first;
}

}  // namespace

std::vector<int> folds_by_log(const std::vector<std::string>& logs, int folds) {
  const auto counts = counts_of(logs);
  std::vector<std::pair<std::string, std::size_t>> longest(counts.begin(), counts.end());
  std::stable_sort(longest.begin(), longest.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  std::vector<std::size_t> filled(static_cast<std::size_t>(folds), 0);
  std::map<std::string, int> fold_of_log;
  for (const auto& [log, count] : longest) {
    const auto emptiest = std::min_element(filled.begin(), filled.end());
    *emptiest += count;
    fold_of_log[log] = static_cast<int>(emptiest - filled.begin());
  }
  std::vector<int> fold_of;
  for (const std::string& log : logs) fold_of.push_back(fold_of_log.at(log));
  return fold_of;
}

double LogScatter::at(double gradient_rad) const {
  return growth_at(growth, gradient_rad);
}

double LogScatter::std_at(double gradient_rad) const {
  return at(gradient_rad) * std::hypot(between, within);
}

double LogScatter::share_between() const {
  const double all = between * between + within * within;
  return all > 0.0 ? between * between / all : 0.0;
}

std::vector<double> weights_by_log(const std::vector<std::string>& logs, double share_between) {
  const auto counts = counts_of(logs);
  std::vector<double> weights;
  for (const std::string& log : logs)
    weights.push_back(1.0 / (1.0 + (static_cast<double>(counts.at(log)) - 1.0) * share_between));
  return weights;
}

LogScatter measure_scatter(const std::vector<LogResidual>& residuals) {
  LogScatter scatter;
  scatter.growth = best_growth(residuals);
  std::vector<std::string> logs;
  std::vector<double> z;
  for (const LogResidual& r : residuals) {
    logs.push_back(r.log);
    z.push_back(r.value / scatter.at(r.gradient_rad));
  }
  set_variances(logs, z, scatter);
  const std::vector<double> weights = weights_by_log(logs, scatter.share_between());
  std::vector<std::pair<double, double>> sorted;
  for (std::size_t k = 0; k < z.size(); ++k) sorted.emplace_back(z[k], weights[k]);
  std::sort(sorted.begin(), sorted.end());
  for (std::size_t k = 0; k < LogScatter::kShares.size(); ++k)
    scatter.quantiles[k] = weighted_quantile(sorted, LogScatter::kShares[k]);
  return scatter;
}

PredictiveOffsets offsets_at(const LogScatter& scatter, double gradient_rad, double parameter_std) {
  const double scatter_std = scatter.std_at(gradient_rad);
  const double widening = scatter_std > 0.0 ? std::hypot(scatter_std, parameter_std) / scatter_std : 1.0;
  // The offsets are widened about the scatter's median, which the parameters' uncertainty does not move.
  const double middle = scatter.quantiles[2];
  const auto offset = [&](std::size_t k) {
    return scatter.at(gradient_rad) * (middle + widening * (scatter.quantiles[k] - middle));
  };
  return {offset(0), offset(1), offset(2), offset(3), offset(4)};
}

Coverage coverage_of(const std::vector<std::string>& logs, const std::vector<bool>& inside) {
  std::map<std::string, std::pair<double, double>> by_log;  // inside, all
  double hits = 0.0;
  for (std::size_t k = 0; k < logs.size(); ++k) {
    auto& [in, all] = by_log[logs[k]];
    in += inside[k] ? 1.0 : 0.0;
    all += 1.0;
    hits += inside[k] ? 1.0 : 0.0;
  }
  Coverage coverage{hits / static_cast<double>(logs.size()), 0.0, 1.0};
  for (const auto& [log, share] : by_log) {
    const double own = share.first / share.second;
    coverage.mean_over_logs += own / static_cast<double>(by_log.size());
    coverage.lowest_of_a_log = std::min(coverage.lowest_of_a_log, own);
  }
  return coverage;
}

}  // namespace slipway::validation
