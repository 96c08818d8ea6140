#include "research/validation/report/statistics.h"

#include <algorithm>
#include <cmath>

#include "core/random.h"

namespace slipway::validation {

double median_abs(std::vector<double> values) {
  if (values.empty()) return 0.0;
  for (double& v : values) v = std::abs(v);
  return median(std::move(values));
}

Agreement agreement(const std::vector<double>& predicted, const std::vector<double>& measured) {
  const double n = static_cast<double>(predicted.size());
  double mp = 0, mm = 0, pp = 0, mmm = 0, pm = 0, d2 = 0;
  for (std::size_t k = 0; k < predicted.size(); ++k) {
    mp += predicted[k] / n;
    mm += measured[k] / n;
    d2 += std::pow(predicted[k] - measured[k], 2) / n;
  }
  for (std::size_t k = 0; k < predicted.size(); ++k) {
    pp += std::pow(predicted[k] - mp, 2);
    mmm += std::pow(measured[k] - mm, 2);
    pm += (predicted[k] - mp) * (measured[k] - mm);
  }
  return {pm / std::sqrt(pp * mmm), std::sqrt(d2), mp - mm};
}

Interval median_interval_by_group(const std::vector<std::vector<double>>& groups, double level, int draws,
                                  std::uint64_t seed) {
  std::vector<double> medians;
  for (int draw = 0; draw < draws; ++draw) {
    const std::uint64_t key = random_key(seed, static_cast<std::uint64_t>(draw));
    std::vector<double> values;
    for (std::size_t k = 0; k < groups.size(); ++k) {
      const double at = random_uniform(key, k) * static_cast<double>(groups.size());
      const std::vector<double>& group = groups[std::min(static_cast<std::size_t>(at), groups.size() - 1)];
      values.insert(values.end(), group.begin(), group.end());
    }
    medians.push_back(median(std::move(values)));
  }
  return {quantile(medians, 0.5 - 0.5 * level), quantile(medians, 0.5 + 0.5 * level)};
}

Interval bootstrap_interval(std::size_t count,
                            const std::function<double(std::span<const std::size_t>)>& statistic,
                            double level, int draws, std::uint64_t seed) {
  std::vector<double> values;
  std::vector<std::size_t> drawn(count);
  for (int draw = 0; draw < draws; ++draw) {
    const std::uint64_t key = random_key(seed, static_cast<std::uint64_t>(draw));
    for (std::size_t k = 0; k < count; ++k)
      drawn[k] =
          std::min(static_cast<std::size_t>(random_uniform(key, k) * static_cast<double>(count)), count - 1);
    values.push_back(statistic(drawn));
  }
  return {quantile(values, 0.5 - 0.5 * level), quantile(values, 0.5 + 0.5 * level)};
}

Interval mean_interval(std::span<const double> values, double level, int draws, std::uint64_t seed) {
  const auto mean = [&](std::span<const std::size_t> drawn) {
    double sum = 0.0;
    for (const std::size_t k : drawn) sum += values[k];
    return sum / static_cast<double>(drawn.size());
  };
  return bootstrap_interval(values.size(), mean, level, draws, seed);
}

}  // namespace slipway::validation
