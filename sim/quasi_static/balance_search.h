#pragma once

#include "sim/quasi_static/newton_search.h"
#include "sim/quasi_static/quasi_static.h"
#include "sim/quasi_static/rover_balance.h"

namespace slipway::sim {

constexpr double kSpinningSpeedRatio = 0.02;  // a drive with more than 98 % slip counts as immobilised

Primary primary_of(const DriveCommand& command);

// How a search for the rover's balance ended.
struct Attempt {
  Outcome outcome = Outcome::kMoving;
  int wheel = -1;  // index of the wheel that the outcome concerns, -1 where it concerns none
};

// Finds the unknowns at which the balance's equations hold and every unloaded wheel is clear of the ground.
// When `warm` is true the search starts from `x`; afterwards `x` is the answer, or the last iterate where
// there is none. `memory` is for all wheels in contact, and comes back empty where they are not; see
// newton().
Attempt find_balance(RoverBalance& balance, const Primary& primary, bool warm, RoverBalance::Vector& x,
                     NewtonMemory* memory = nullptr, Thoroughness thoroughness = Thoroughness::kSure);

}  // namespace slipway::sim
