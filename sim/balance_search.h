#pragma once

#include "sim/quasi_static.h"
#include "sim/rover_balance.h"

namespace slipway::sim {

// The motion that the driver asks for, and the equation that fixes it.
struct Primary {
  int motion = 0;     // 0 along the direction of travel, 2 yaw
  int equation = 0;   // 0 force along it, 5 moment about z
  double sign = 1.0;  // of the commanded motion
};

Primary primary_of(const DriveCommand& command);

// How a search for the rover's balance ended.
struct Attempt {
  Outcome outcome = Outcome::kMoving;
  int wheel = -1;  // that the outcome is about
};

// Finds the unknowns at which the balance's equations hold and every wheel that carries nothing hangs clear.
// `x` is where the search starts when `warm`, and the answer (without one, the last iterate) afterwards.
Attempt find_balance(RoverBalance& balance, const Primary& primary, bool warm, RoverBalance::Vector& x);

}  // namespace slipway::sim
