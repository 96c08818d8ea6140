#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/progress.h"
#include "core/result.h"
#include "gap/estimate/between_soils.h"
#include "gap/estimate/free_parameter.h"
#include "gap/estimate/soil_estimation_options.h"
#include "gap/estimate/soil_observation.h"
#include "sim/soil/soil.h"

namespace slipway::gap {

// The tests of wheels on one soil, and what is free there: the numbers of the hierarchy, with flat priors
// between their bounds, and others, which have the options' priors. A loss is not used.
struct TestedSoilData {
  std::string name;
  sim::SoilDistribution nominal;
  SoilData data;
  SoilEstimationOptions options;
};

struct SoilBeliefOptions {
  std::vector<FreeParameter> between;     // c1, c2, ...: numbers that each soil has its own of
  std::vector<double> usual_spread = {};  // of each before any test; empty: what soils of all kinds have
  EnsembleOptions of_soil = {};           // of each soil's own posterior
  EnsembleOptions of_hierarchy = {.walkers = 32, .burn_in = 300, .steps = 1000, .every = 20};
};

// How readings lie in what is predicted of them, each with its own noise: the soil's numbers as its file has
// them but for those of the hierarchy, which are the other soils' belief or the file's own.
struct ReadingsHeld {
  std::size_t all = 0, by_belief = 0, by_file = 0;  // in the 90 % interval
};

// A soil that is predicted by the others alone.
struct SoilLeftOut {
  NumbersOfSoil predicted;
  std::vector<double> rank;  // of each number: share of the predicted soils that lie below its own median
  ReadingsHeld readings;

  bool held(std::size_t number) const { return rank[number] >= 0.05 && rank[number] <= 0.95; }
};

struct TestedSoilBelief {
  std::string name;
  std::size_t readings = 0;
  double residual_variance = 0.0;  // of the best fit, in deviations; where above 1 the posterior is widened
  double effective_samples = 0.0;
  NumbersOfSoil alone;  // by its own tests
  NumbersOfSoil among;  // and by those of the others
  SoilLeftOut left_out;
};

// Of numbers that span decades (n, K) the natural logarithm is believed to be normal, of a friction angle
// that of its tangent, of all others the number itself.
struct SoilBelief {
  std::vector<FreeParameter> between;
  std::vector<bool> logarithm;
  BetweenSoils all;
  std::vector<TestedSoilBelief> soils;
};

// The hierarchy of all soils that were tested: each soil's posterior, by an ensemble around its best fit, the
// spread between them, and each soil predicted by the others.
//
// Errors: invalid_request where a soil does not leave a number of the hierarchy free, or leaves it with other
// bounds, or with fewer than two soils; no_data and not_converged as estimate_soil; cancelled.
Result<SoilBelief> believe_soils(std::span<const TestedSoilData> soils, const SoilBeliefOptions& options,
                                 Progress& progress);

}  // namespace slipway::gap
