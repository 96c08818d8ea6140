#include "gap/estimate/between_soils.h"

#include <algorithm>
#include <cmath>

#include "core/quantile.h"
#include "core/random.h"

namespace slipway::gap {
namespace {

constexpr Eigen::Index kMaxSamples = 250;  // of each soil that are looked at
constexpr std::uint64_t kMaxTries = 200;   // to draw a soil within the bounds
constexpr std::uint64_t kNextPerSample = 4;

// Mean, deviations and the Cholesky factor of the covariance between soils.
struct Population {
  Eigen::VectorXd mean, std;
  Eigen::MatrixXd factor;

  // The logarithms of the densities of numbers of soils, a column each, without the factor of 2 pi.
  Eigen::ArrayXd log_densities(const Eigen::MatrixXd& columns) const {
    Eigen::MatrixXd z = columns.colwise() - mean;
    factor.triangularView<Eigen::Lower>().solveInPlace(z);
    return -0.5 * z.colwise().squaredNorm().transpose().array() - factor.diagonal().array().log().sum();
  }
  double correlation() const { return factor.rows() < 2 ? 0.0 : factor(1, 0) / factor.row(1).norm(); }
};

// What is sampled: the means, the logarithms of the deviations, and of each canonical partial correlation the
// inverse hyperbolic tangent, row by row of the lower triangle.
class Hierarchy {
 public:
  Hierarchy(std::span<const SoilSamples> soils, std::span<const BetweenNumber> numbers)
      : numbers_(numbers), dims_(static_cast<Eigen::Index>(numbers.size())) {
    for (const SoilSamples& soil : soils) {
      const Eigen::Index step = std::max<Eigen::Index>(1, soil.values.rows() / kMaxSamples);
      const Eigen::Index count = soil.values.rows() / step;
      Eigen::MatrixXd& kept = soils_.emplace_back(dims_, count);
      for (Eigen::Index k = 0; k < count; ++k) kept.col(k) = soil.values.row(k * step).transpose();
    }
  }

  Eigen::Index dims() const { return 2 * dims_ + dims_ * (dims_ - 1) / 2; }
  // The samples of each soil that are looked at, a column each.
  const std::vector<Eigen::MatrixXd>& soils() const { return soils_; }

  Population population(std::span<const double> x) const {
    const Eigen::Map<const Eigen::VectorXd> all(x.data(), dims());
    Population p{all.head(dims_), all.segment(dims_, dims_).array().exp(),
                 Eigen::MatrixXd::Zero(dims_, dims_)};
    Eigen::Index place = 2 * dims_;
    for (Eigen::Index i = 0; i < dims_; ++i) {
      double left = 1.0;  // of the row's squares
      for (Eigen::Index j = 0; j < i; ++j) {
        p.factor(i, j) = std::tanh(all[place++]) * std::sqrt(left);
        left -= p.factor(i, j) * p.factor(i, j);
      }
      p.factor(i, i) = std::sqrt(std::max(left, 1e-12));
      p.factor.row(i) *= p.std[i];
    }
    return p;
  }

  std::optional<double> log_density(std::span<const double> x) const {
    const Population p = population(x);
    const auto prior = log_prior(x, p);
    if (!prior) return std::nullopt;
    double sum = *prior;
    for (const Eigen::MatrixXd& soil : soils_) sum += log_mean_density(p, soil);
    return sum;
  }

  // Walkers around what the soils have in the mean.
  Eigen::MatrixXd starts(std::size_t walkers, std::uint64_t seed) const {
    Eigen::MatrixXd x(static_cast<Eigen::Index>(walkers), dims());
    for (Eigen::Index w = 0; w < x.rows(); ++w) {
      const std::uint64_t key = random_key(seed, static_cast<std::uint64_t>(w));
      for (Eigen::Index k = 0; k < dims(); ++k) {
        constexpr double kAround = 0.3;
        const double z = kAround * random_normal(key, static_cast<std::uint64_t>(k));
        x(w, k) = z;
        if (k >= 2 * dims_) continue;
        const BetweenNumber& number = numbers_[static_cast<std::size_t>(k % dims_)];
        if (k >= dims_)
          x(w, k) = std::log(number.usual_spread) + z;
        else
          x(w, k) = std::clamp(mean_of_soils(k) + number.usual_spread * z, number.lowest, number.highest);
      }
    }
    return x;
  }

 private:
  double mean_of_soils(Eigen::Index number) const {
    double sum = 0.0;
    for (const Eigen::MatrixXd& soil : soils_) sum += soil.row(number).mean();
    return sum / static_cast<double>(soils_.size());
  }

  std::optional<double> log_prior(std::span<const double> x, const Population& p) const {
    double sum = 0.0;
    for (Eigen::Index k = 0; k < dims_; ++k) {
      const BetweenNumber& number = numbers_[static_cast<std::size_t>(k)];
      if (p.mean[k] < number.lowest || p.mean[k] > number.highest) return std::nullopt;
      const double ratio = p.std[k] / number.usual_spread;
      sum += -0.5 * ratio * ratio + std::log(p.std[k]);
    }
    std::size_t place = static_cast<std::size_t>(2 * dims_);
    for (Eigen::Index i = 0; i < dims_; ++i)
      for (Eigen::Index j = 0; j < i; ++j) {
        const double partial = std::tanh(x[place++]);
        sum += (1.0 + 0.5 * static_cast<double>(dims_ - 2 - j)) *
               std::log(std::max(1.0 - partial * partial, 1e-300));
      }
    return sum;
  }

  static double log_mean_density(const Population& p, const Eigen::MatrixXd& soil) {
    const Eigen::ArrayXd logs = p.log_densities(soil);
    const double most = logs.maxCoeff();
    return most + std::log((logs - most).exp().mean());
  }

  std::span<const BetweenNumber> numbers_;
  Eigen::Index dims_;
  std::vector<Eigen::MatrixXd> soils_;
};

SpreadInterval spread_interval(const std::vector<double>& values) {
  return {quantile(values, 0.5), quantile(values, 0.05), quantile(values, 0.95)};
}

// One soil of a population; nothing where hardly any is within the bounds.
std::optional<Eigen::RowVectorXd> next_soil(const Population& p, std::span<const BetweenNumber> numbers,
                                            std::uint64_t key) {
  const Eigen::Index dims = p.mean.size();
  for (std::uint64_t tried = 0; tried < kMaxTries; ++tried) {
    Eigen::VectorXd z(dims);
    for (Eigen::Index k = 0; k < dims; ++k)
      z[k] = random_normal(random_key(key, tried), static_cast<std::uint64_t>(k));
    const Eigen::VectorXd values = p.mean + p.factor * z;
    bool within = true;
    for (Eigen::Index k = 0; k < dims; ++k) {
      const BetweenNumber& number = numbers[static_cast<std::size_t>(k)];
      within = within && values[k] >= number.lowest && values[k] <= number.highest;
    }
    if (within) return values.transpose();
  }
  return std::nullopt;
}

void fill_next(const std::vector<Population>& populations, std::span<const BetweenNumber> numbers,
               std::uint64_t seed, BetweenSoils& out) {
  std::vector<Eigen::RowVectorXd> rows;
  for (std::size_t p = 0; p < populations.size(); ++p)
    for (std::uint64_t k = 0; k < kNextPerSample; ++k)
      if (auto soil = next_soil(populations[p], numbers, random_key(random_key(seed, p), k)))
        rows.push_back(std::move(*soil));
  out.next_samples.resize(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(numbers.size()));
  for (std::size_t k = 0; k < rows.size(); ++k) out.next_samples.row(static_cast<Eigen::Index>(k)) = rows[k];
  out.next = numbers_of(out.next_samples);
}

// A soil's samples weighted by how likely each is among the soils, in the mean over the populations.
NumbersOfSoil among_soils(const std::vector<Population>& populations, const Eigen::MatrixXd& soil) {
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(soil.cols());
  for (const Population& p : populations) {
    const Eigen::ArrayXd logs = p.log_densities(soil);
    const Eigen::ArrayXd likely = (logs - logs.maxCoeff()).exp();
    weights += (likely / likely.sum()).matrix();
  }
  return numbers_of(soil.transpose(), weights / static_cast<double>(populations.size()));
}

}  // namespace

NumbersOfSoil numbers_of(const Eigen::MatrixXd& samples, const Eigen::VectorXd& weights) {
  const Eigen::VectorXd w =
      weights.size() > 0
          ? weights
          : Eigen::VectorXd::Constant(samples.rows(), 1.0 / static_cast<double>(samples.rows()));
  NumbersOfSoil out;
  out.mean = samples.transpose() * w;
  const Eigen::MatrixXd off = samples.rowwise() - out.mean.transpose();
  const Eigen::MatrixXd covariance = off.transpose() * w.asDiagonal() * off;
  out.std = covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  const Eigen::VectorXd scale = out.std.cwiseMax(1e-300).cwiseInverse();
  out.correlation = scale.asDiagonal() * covariance * scale.asDiagonal();
  out.correlation.diagonal().setOnes();
  return out;
}

Result<BetweenSoils> between_soils(std::span<const SoilSamples> soils, std::span<const BetweenNumber> numbers,
                                   const EnsembleOptions& options, Progress& progress) {
  for (const SoilSamples& soil : soils)
    if (soil.values.rows() == 0 || soil.values.cols() != static_cast<Eigen::Index>(numbers.size()))
      return fail(ErrorCode::kInvalidRequest, "the samples of soil " + soil.name + " have another size");
  if (soils.empty() || numbers.empty())
    return fail(ErrorCode::kInvalidRequest, "a belief about soils takes soils and numbers");
  const Hierarchy hierarchy(soils, numbers);
  const LogDensity density = [&](std::span<const double> x) { return hierarchy.log_density(x); };
  const auto ensemble = sample_ensemble(hierarchy.starts(options.walkers, random_key(options.seed, 1)),
                                        density, options, progress);
  if (!ensemble) return fail(ensemble.error());

  BetweenSoils out;
  const auto dims = static_cast<Eigen::Index>(numbers.size());
  std::vector<Population> populations;
  std::vector<double> at(static_cast<std::size_t>(hierarchy.dims()));
  for (Eigen::Index k = 0; k < ensemble->samples.rows(); ++k) {
    Eigen::Map<Eigen::RowVectorXd>(at.data(), hierarchy.dims()) = ensemble->samples.row(k);
    populations.push_back(hierarchy.population(at));
  }
  const NumbersOfSoil means = numbers_of(ensemble->samples.leftCols(dims));
  out.mean = means.mean;
  out.mean_std = means.std;
  for (Eigen::Index k = 0; k < dims; ++k) {
    std::vector<double> values;
    for (const Population& p : populations) values.push_back(p.std[k]);
    out.spread.push_back(spread_interval(values));
  }
  std::vector<double> correlations;
  for (const Population& p : populations) correlations.push_back(p.correlation());
  out.correlation = spread_interval(correlations);
  fill_next(populations, numbers, random_key(options.seed, 2), out);
  for (const Eigen::MatrixXd& soil : hierarchy.soils())
    out.of_tested.push_back(among_soils(populations, soil));
  return out;
}

}  // namespace slipway::gap
