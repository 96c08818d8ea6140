#pragma once

#include <optional>

#include "sim/quasi_static/rover_balance.h"

namespace slipway::sim {

// The commanded motion, and the equation that determines its speed.
struct Primary {
  int motion = 0;     // index of the unknown: 0 is along the direction of travel, 2 is yaw
  int equation = 0;   // index of the equation: 0 is the force along the travel, 5 the moment about z
  double sign = 1.0;  // of the commanded motion
};

// The tolerance of the balance's equations, relative to the weight for forces and to the weight times half
// the wheelbase for moments.
constexpr double kBalanceTolerance = 1e-9;

// Moves the entry angles into the range of the laws.
void keep_in_range(RoverBalance::Vector& unknowns);

// What a search is given of the one before it, and leaves to the one after.
struct NewtonMemory {
  // The inverse Jacobian at a point nearby: no Jacobian is needed where it serves well. Used up.
  std::optional<RoverBalance::Matrix> inverse = {};
  // Whether the search is made with a slope of each wheel's loads, which each step corrects, in place of an
  // inverse Jacobian that it corrects as a whole: half the evaluations. It starts with `slopes`, where there
  // are some, and leaves its own where it ends with every wheel in contact.
  bool by_wheel = false;
  std::optional<RoverBalance::WheelSlopes> slopes = {};
  double tolerance = kBalanceTolerance;
  int max_iterations = 0;  // of each search; 0: as many as may help
};

// Newton's search, from `x`, for the unknowns at which the balance holds. It does not change which wheels are
// in contact. With `held`, that motion keeps its value and its equation is left out. Returns false where it
// does not converge; `x` is then the last iterate, and the balance's contacts are those at `x`.
bool newton(RoverBalance& balance, RoverBalance::Vector& x, const Primary* held, int max_iterations,
            NewtonMemory* memory = nullptr);

// The inverse of the Jacobian at the unknowns of the last residual; empty where it is singular.
std::optional<RoverBalance::Matrix> inverse_jacobian(const RoverBalance& balance,
                                                     const RoverBalance::Vector& x);

}  // namespace slipway::sim
