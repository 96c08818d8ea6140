#pragma once

#include "sim/quasi_static/newton_search.h"
#include "sim/quasi_static/quasi_static.h"
#include "sim/quasi_static/rover_balance.h"

namespace slipway::sim {

constexpr double kSpinningSpeedRatio = 0.02;  // at 98 % slip a drive counts as immobilised

Primary primary_of(const DriveCommand& command);

// How a search for the rover's balance ended.
struct Attempt {
  Outcome outcome = Outcome::kMoving;
  int wheel = -1;  // that the outcome is about
};

// Finds the unknowns at which the balance's equations hold and every wheel that carries nothing hangs clear.
// `x` is where the search starts when `warm`, and the answer (without one, the last iterate) afterwards. For
// `inverse` see newton().
Attempt find_balance(RoverBalance& balance, const Primary& primary, bool warm, RoverBalance::Vector& x,
                     const RoverBalance::Matrix* inverse = nullptr,
                     Thoroughness thoroughness = Thoroughness::kSure);

}  // namespace slipway::sim
