#pragma once

#include <span>

#include "core/progress.h"
#include "core/result.h"
#include "gap/estimate/least_squares.h"

namespace slipway::gap {

// An interval by profile likelihood [Venzon & Moolgavkar 1988]: all values of one unknown at which the cost,
// every other unknown refitted and no prior on this one, is at most `rise` above its least. An end that meets
// the unknown's bound is open.
struct ProfileInterval {
  double low = 0.0, high = 0.0;
  bool low_open = false, high_open = false;
};

struct ProfileOptions {
  LeastSquaresOptions fit;  // of the refits
  double rise = 1.3528;     // of 1/2 chi^2: 2.706 / 2, 90 %
};

// `around`: the estimate to start from, with the unknown's prior; `deviation`: a guess of the unknown's
// standard deviation, the first step. Errors: cancelled.
Result<ProfileInterval> profile_interval(std::span<const Unknown> unknowns, std::size_t profiled,
                                         std::size_t residual_count, const ResidualFunction& residuals,
                                         std::span<const double> around, double deviation,
                                         const ProfileOptions& options, Progress& progress);

}  // namespace slipway::gap
