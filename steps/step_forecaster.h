#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "steps/ground_chain.h"

namespace slipway::steps {

// What a forecast knows of the ground besides the belief: nothing, the sols before it, or also the steps
// before it on its own sol.
enum class StepLearning { kNone, kSols, kDrive };

// How the steps of past sols change a belief.
struct StepMemory {
  // The belief counts as much as this many stretches of ground that were met (a Dirichlet distribution over
  // entry weights).
  double stretches = 40.0;
  // What was met is forgotten over this many drive sols, since rovers come to other ground.
  double drive_sols = 15.0;
  // The share of the next drive on which the ground at the end of the last one still holds.
  double same_ground = 0.3;
};

// What is said of a step's slip before it is known.
struct StepForecast {
  double slip_p05 = 0.0, slip_p50 = 0.0, slip_p95 = 0.0;
  double over_0_2 = 0.0, over_0_4 = 0.0;  // probabilities that the slip is above
  double log_density = 0.0;               // of the measured slip under the forecast
};

struct SolForecast {
  std::vector<StepForecast> steps;
  double any_over_0_2 = 0.0, any_over_0_4 = 0.0;  // probabilities that some step of the sol is above
};

// Forecasts sols one after another, and learns from each after it was forecast.
class StepForecaster {
 public:
  // The chain must outlive it.
  StepForecaster(const GroundChain& chain, StepLearning learning, StepMemory memory = {});

  // The steps of the next sol, in the order in which they were driven.
  SolForecast next_sol(std::span<const ChainStep> steps);
  // Learns from the steps of the next sol without a forecast; returns what they say.
  ChainPass learn_sol(std::span<const ChainStep> steps);

 private:
  // Probabilities of the soils where the next drive begins.
  Eigen::ArrayXd start(std::size_t ground, const std::vector<Eigen::ArrayXd>& now) const;
  void remember(const ChainPass& pass);
  std::vector<Eigen::ArrayXd> shares() const;  // by ground
  // Of a step with these probabilities, slips and likelihoods, by soil.
  StepForecast forecast(const Eigen::ArrayXd& probabilities, const Eigen::ArrayXd& slips,
                        const Eigen::ArrayXd& likelihoods) const;

  const GroundChain& chain_;
  StepLearning learning_;
  StepMemory memory_;
  Eigen::ArrayXXd met_;                // soil x ground: stretches met, as far as remembered
  std::optional<Eigen::ArrayXd> end_;  // probabilities of the soils where the last drive ended
};

}  // namespace slipway::steps
