#include "steps/step_forecaster.h"

#include <cmath>

namespace slipway::steps {
namespace {

// Probability that a measured slip is below a limit, by the slip of each soil and step.
Eigen::ArrayXXd below(const StepNoise& noise, double limit, const Eigen::ArrayXXd& slips) {
  return slips.unaryExpr([&](double slip) { return noise.below(limit - slip, slip); });
}

// A mixture's quantile by bisection.
double mixture_quantile(const StepNoise& noise, const Eigen::ArrayXd& probabilities,
                        const Eigen::ArrayXd& slips, double p) {
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

StepForecast StepForecaster::forecast(const Eigen::ArrayXd& probabilities, const Eigen::ArrayXd& slips,
                                      const Eigen::ArrayXd& likelihoods) const {
  const auto over = [&](double limit) {
    return 1.0 - (probabilities * below(chain_.noise, limit, slips)).sum();
  };
  StepForecast out;
  out.slip_p05 = mixture_quantile(chain_.noise, probabilities, slips, 0.05);
  out.slip_p50 = mixture_quantile(chain_.noise, probabilities, slips, 0.5);
  out.slip_p95 = mixture_quantile(chain_.noise, probabilities, slips, 0.95);
  out.over_0_2 = over(0.2);
  out.over_0_4 = over(0.4);
  out.log_density = std::log((probabilities * likelihoods).sum());
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
  const std::vector<Eigen::ArrayXd> now = shares();
  const std::size_t ground = steps.empty() ? 0 : steps.front().ground;
  ChainPass pass = follow(chain_, steps, chain_.likelihoods(steps, chain_.predicted_slips(steps)),
                          start(ground, now), now);
  if (!steps.empty()) remember(pass);
  return pass;
}

SolForecast StepForecaster::next_sol(std::span<const ChainStep> steps) {
  SolForecast out;
  if (steps.empty()) return out;
  const std::vector<Eigen::ArrayXd> now = shares();
  const Eigen::ArrayXd first = start(steps.front().ground, now);
  const Eigen::ArrayXXd slips = chain_.predicted_slips(steps);
  const Eigen::ArrayXXd likelihoods = chain_.likelihoods(steps, slips);
  const auto after = [&](const Eigen::ArrayXXd& evidence) {
    return follow(chain_, steps, evidence, first, now);
  };
  const ChainPass pass = after(likelihoods);
  // Without this sol's steps: as with measurements that every soil makes equally likely.
  const Eigen::ArrayXXd before = learning_ == StepLearning::kDrive
                                     ? pass.before
                                     : after(Eigen::ArrayXXd::Ones(slips.rows(), slips.cols())).before;
  for (Eigen::Index t = 0; t < slips.cols(); ++t)
    out.steps.push_back(forecast(before.col(t), slips.col(t), likelihoods.col(t)));
  // The recursions' evidence of "no step is above" is its probability.
  const auto any_over = [&](double limit) {
    return 1.0 - std::exp(after(below(chain_.noise, limit, slips)).log_likelihood);
  };
  out.any_over_0_2 = any_over(0.2);
  out.any_over_0_4 = any_over(0.4);
  if (learning_ != StepLearning::kNone) remember(pass);
  return out;
}

}  // namespace slipway::steps
