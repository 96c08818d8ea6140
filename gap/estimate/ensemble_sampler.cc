#include "gap/estimate/ensemble_sampler.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/random.h"

namespace slipway::gap {
namespace {

constexpr double kStretch = 2.0;  // Goodman and Weare's a
constexpr Eigen::Index kQuarters = 4;

// The walkers where they stand. Rows are copied into `at`, since a density takes contiguous numbers.
class Walkers {
 public:
  Walkers(const Eigen::MatrixXd& starts, const LogDensity& density, std::uint64_t seed)
      : x_(starts), log_density_(static_cast<std::size_t>(starts.rows())), density_(density), seed_(seed) {}

  bool start() {
    std::vector<double> at(static_cast<std::size_t>(x_.cols()));
    for (Eigen::Index k = 0; k < x_.rows(); ++k) {
      copy_row(k, at);
      const auto value = density_(at);
      if (!value) return false;
      log_density_[static_cast<std::size_t>(k)] = *value;
    }
    return true;
  }

  // Each half moves along the lines to walkers of the other half. Returns how many moved.
  std::size_t step(std::uint64_t number) {
    const Eigen::Index half = x_.rows() / 2;
    const auto dims = static_cast<double>(x_.cols());
    std::vector<double> at(static_cast<std::size_t>(x_.cols()));
    std::size_t moved = 0;
    for (Eigen::Index k = 0; k < x_.rows(); ++k) {
      const std::uint64_t key = random_key(random_key(seed_, number), static_cast<std::uint64_t>(k));
      const auto pick = static_cast<Eigen::Index>(random_uniform(key, 0) * static_cast<double>(half));
      const Eigen::Index other = (k < half ? half : 0) + std::min(pick, half - 1);
      const double root = (kStretch - 1.0) * random_uniform(key, 1) + 1.0;
      const double stretch = root * root / kStretch;
      const Eigen::RowVectorXd proposed = x_.row(other) + stretch * (x_.row(k) - x_.row(other));
      Eigen::Map<Eigen::RowVectorXd>(at.data(), x_.cols()) = proposed;
      const auto value = density_(at);
      if (!value) continue;
      double& now = log_density_[static_cast<std::size_t>(k)];
      if (std::log(random_uniform(key, 2)) >= (dims - 1.0) * std::log(stretch) + *value - now) continue;
      x_.row(k) = proposed;
      now = *value;
      ++moved;
    }
    return moved;
  }

  const Eigen::MatrixXd& x() const { return x_; }

 private:
  void copy_row(Eigen::Index k, std::vector<double>& at) const {
    Eigen::Map<Eigen::RowVectorXd>(at.data(), x_.cols()) = x_.row(k);
  }

  Eigen::MatrixXd x_;
  std::vector<double> log_density_;
  const LogDensity& density_;
  std::uint64_t seed_;
};

double effective_samples(const Eigen::MatrixXd& samples) {
  const Eigen::Index quarter = samples.rows() / kQuarters;
  if (quarter == 0) return 0.0;
  double worst = static_cast<double>(samples.rows());
  for (Eigen::Index k = 0; k < samples.cols(); ++k) {
    const double mean = samples.col(k).mean();
    const double variance = (samples.col(k).array() - mean).square().mean();
    if (!(variance > 0.0)) continue;
    double between = 0.0;
    for (Eigen::Index q = 0; q < kQuarters; ++q)
      between += std::pow(samples.col(k).segment(q * quarter, quarter).mean() - mean, 2);
    const double of_the_mean = between / static_cast<double>((kQuarters - 1) * kQuarters);
    if (of_the_mean > 0.0) worst = std::min(worst, variance / of_the_mean);
  }
  return worst;
}

}  // namespace

Result<Ensemble> sample_ensemble(const Eigen::MatrixXd& starts, const LogDensity& density,
                                 const EnsembleOptions& options, Progress& progress) {
  const auto walkers = static_cast<Eigen::Index>(options.walkers);
  if (starts.rows() != walkers || walkers % 2 != 0 || walkers < 2 * starts.cols() || options.every == 0 ||
      options.steps < options.every)
    return fail(ErrorCode::kInvalidRequest,
                "an ensemble takes an even number of walkers, at least twice its dimensions, and a step");
  Walkers ensemble(starts, density, options.seed);
  if (!ensemble.start()) return fail(ErrorCode::kInvalidRequest, "a walker starts where nothing is believed");
  Ensemble out;
  const std::size_t kept = options.steps / options.every, all = options.burn_in + kept * options.every;
  out.samples.resize(static_cast<Eigen::Index>(kept) * walkers, starts.cols());
  std::size_t moved = 0;
  for (std::size_t step = 0; step < all; ++step) {
    if (progress.cancelled()) return fail(ErrorCode::kCancelled, "the sampling was dismissed");
    moved += ensemble.step(step);
    if (step < options.burn_in || (step - options.burn_in + 1) % options.every != 0) continue;
    const auto block = static_cast<Eigen::Index>((step - options.burn_in) / options.every);
    out.samples.middleRows(block * walkers, walkers) = ensemble.x();
  }
  out.acceptance = static_cast<double>(moved) / static_cast<double>(all * options.walkers);
  out.effective_samples = effective_samples(out.samples);
  return out;
}

}  // namespace slipway::gap
