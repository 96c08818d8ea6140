#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>

#include "core/progress.h"
#include "core/result.h"

namespace slipway::gap {

// The logarithm of a density that need not be normalised; nothing where it is 0.
using LogDensity = std::function<std::optional<double>(std::span<const double> x)>;

struct EnsembleOptions {
  std::size_t walkers = 64;   // even, at least twice the dimensions
  std::size_t burn_in = 200;  // steps of every walker that are left out
  std::size_t steps = 400;    // steps of every walker that are looked at
  std::size_t every = 10;     // of which every so many-th is kept
  std::uint64_t seed = 1;
};

struct Ensemble {
  Eigen::MatrixXd samples;  // a row each: walker by walker at each step that is kept
  double acceptance = 0.0;  // share of the proposals that were taken, burn-in included
  // Of the dimension that mixes worst: (standard error of its mean, by how much the means of quarters of the
  // run differ, over its deviation)^-2.
  double effective_samples = 0.0;
};

// Samples of a density by walkers that stretch towards and away from one another, which does not depend on
// how the density is scaled or sheared [Goodman & Weare 2010, Comm. Appl. Math. Comp. Sci. 5, 65]. `starts`:
// a row for each walker, where the density is not 0. The same density and seed give the same samples.
// Errors: invalid_request where starts do not fit or have no density; cancelled.
Result<Ensemble> sample_ensemble(const Eigen::MatrixXd& starts, const LogDensity& density,
                                 const EnsembleOptions& options, Progress& progress);

}  // namespace slipway::gap
