#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "steps/estimate.h"
#include "steps/step_forecaster.h"

namespace slipway::steps {

// How well probabilities foretold whether a slip is above a limit.
struct ProbabilityScore {
  std::size_t cases = 0, above = 0;
  double expected = 0.0;   // the sum of the probabilities
  double log_score = 0.0;  // mean of the logarithm of the probability of what happened
  double auc = 0.0;        // that a case above has the higher probability; 0.5 where there are none
  struct Bin {
    double least = 0.0, most = 0.0, expected = 0.0;
    std::size_t cases = 0, above = 0;
  };
  std::vector<Bin> bins;  // by probability: how reliable they are
};

// Of steps that lie together: a bin of pitch, or a sol.
struct BandScore {
  std::string name;
  std::size_t steps = 0;
  double in_band = 0.0;
  double median_error = 0.0;
};

struct StepScores {
  std::size_t steps = 0, sols = 0;
  // Over sols drawn with replacement [Efron & Tibshirani 1993], since the steps of a sol are not independent.
  Estimate median_error, rms_error, in_band;  // of slip_p50; of the band from 5 to 95 %
  double mean_log_density = 0.0;
  ProbabilityScore step_over_0_2, step_over_0_4, sol_over_0_2, sol_over_0_4;
  std::vector<BandScore> by_pitch, by_sol;
};

// Steps of one sol with their forecasts.
struct ScoredSol {
  int sol = 0;
  std::vector<ChainStep> steps;
  SolForecast forecast;
};

StepScores score(std::span<const ScoredSol> sols);

}  // namespace slipway::steps
