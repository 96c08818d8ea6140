#include "steps/step_forecaster.h"

#include <cmath>

namespace slipway::steps {
namespace {

// A mixture's quantile by bisection.
double quantile(const StepNoise& noise, const Eigen::ArrayXd& probabilities, const Eigen::ArrayXd& slips,
                double p) {
  constexpr int kHalvings = 40;
  double low = -4.0, high = 2.0;
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = 0.5 * (low + high);
    double below = 0.0;
    for (Eigen::Index j = 0; j < slips.size(); ++j)
      below += probabilities[j] * noise.below(middle - slips[j], slips[j]);
    (below < p ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

StepForecaster::StepForecaster(const GroundChain& chain, StepLearning learning, StepMemory memory)
    : chain_(chain),
      learning_(learning),
      memory_(memory),
      met_(Eigen::ArrayXXd::Zero(static_cast<Eigen::Index>(chain.soils.size()),
                                 static_cast<Eigen::Index>(chain.grounds.size()))) {}

std::vector<Eigen::ArrayXd> StepForecaster::shares() const {
  std::vector<Eigen::ArrayXd> all;
  for (std::size_t g = 0; g < chain_.grounds.size(); ++g) {
    const Eigen::ArrayXd counts = memory_.stretches * chain_.entry_weights(chain_.grounds[g].shares) +
                                  met_.col(static_cast<Eigen::Index>(g));
    all.push_back(chain_.shares_of_entries(counts / counts.sum()));
  }
  return all;
}

StepForecast StepForecaster::forecast(const Eigen::ArrayXd& probabilities, const ChainStep& step) const {
  const Eigen::ArrayXd slips = chain_.predicted_slips(step);
  const auto over = [&](double limit) {
    double sum = 0.0;
    for (Eigen::Index j = 0; j < slips.size(); ++j)
      sum += probabilities[j] * (1.0 - chain_.noise.below(limit - slips[j], slips[j]));
    return sum;
  };
  StepForecast out;
  out.slip_p05 = quantile(chain_.noise, probabilities, slips, 0.05);
  out.slip_p50 = quantile(chain_.noise, probabilities, slips, 0.5);
  out.slip_p95 = quantile(chain_.noise, probabilities, slips, 0.95);
  out.over_0_2 = over(0.2);
  out.over_0_4 = over(0.4);
  out.log_density = std::log((probabilities * chain_.likelihoods(step)).sum());
  return out;
}

Eigen::ArrayXd StepForecaster::start(std::size_t ground, const std::vector<Eigen::ArrayXd>& now) const {
  Eigen::ArrayXd start = now[ground];
  // The ground where the last drive ended holds on at the beginning of this one.
  if (end_) start += memory_.same_ground * (*end_ - start);
  return start;
}

void StepForecaster::remember(const ChainPass& pass) {
  met_ = std::exp(-1.0 / memory_.drive_sols) * met_ + pass.entries;
  end_ = pass.last;
}

ChainPass StepForecaster::learn_sol(std::span<const ChainStep> steps) {
  const auto soils = static_cast<Eigen::Index>(chain_.soils.size());
  Eigen::ArrayXXd likelihoods(soils, static_cast<Eigen::Index>(steps.size()));
  for (std::size_t t = 0; t < steps.size(); ++t)
    likelihoods.col(static_cast<Eigen::Index>(t)) = chain_.likelihoods(steps[t]);
  const std::vector<Eigen::ArrayXd> now = shares();
  const std::size_t ground = steps.empty() ? 0 : steps.front().ground;
  ChainPass pass = follow(chain_, steps, likelihoods, start(ground, now), now);
  if (!steps.empty()) remember(pass);
  return pass;
}

SolForecast StepForecaster::next_sol(std::span<const ChainStep> steps) {
  SolForecast out;
  if (steps.empty()) return out;
  const std::vector<Eigen::ArrayXd> now = shares();
  const Eigen::ArrayXd first = start(steps.front().ground, now);
  const auto soils = static_cast<Eigen::Index>(chain_.soils.size());
  const auto count = static_cast<Eigen::Index>(steps.size());
  Eigen::ArrayXXd likelihoods(soils, count), below_0_2(soils, count), below_0_4(soils, count);
  for (Eigen::Index t = 0; t < count; ++t) {
    const ChainStep& step = steps[static_cast<std::size_t>(t)];
    const Eigen::ArrayXd slips = chain_.predicted_slips(step);
    likelihoods.col(t) = chain_.likelihoods(step);
    for (Eigen::Index j = 0; j < soils; ++j) {
      below_0_2(j, t) = chain_.noise.below(0.2 - slips[j], slips[j]);
      below_0_4(j, t) = chain_.noise.below(0.4 - slips[j], slips[j]);
    }
  }
  const ChainPass pass = follow(chain_, steps, likelihoods, first, now);
  // Without this sol's steps: as with measurements that every soil makes equally likely.
  const ChainPass unseen = follow(chain_, steps, Eigen::ArrayXXd::Ones(soils, count), first, now);
  const ChainPass& known = learning_ == StepLearning::kDrive ? pass : unseen;
  for (Eigen::Index t = 0; t < count; ++t)
    out.steps.push_back(forecast(known.before.col(t), steps[static_cast<std::size_t>(t)]));
  // The recursions' evidence of "no step is above" is its probability.
  out.any_over_0_2 = 1.0 - std::exp(follow(chain_, steps, below_0_2, first, now).log_likelihood);
  out.any_over_0_4 = 1.0 - std::exp(follow(chain_, steps, below_0_4, first, now).log_likelihood);
  if (learning_ != StepLearning::kNone) remember(pass);
  return out;
}

}  // namespace slipway::steps
