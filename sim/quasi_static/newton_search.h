#pragma once

#include <optional>

#include "sim/quasi_static/rover_balance.h"

namespace slipway::sim {

// The motion that the driver asks for, and the equation that fixes it.
struct Primary {
  int motion = 0;     // 0 along the direction of travel, 2 yaw
  int equation = 0;   // 0 force along it, 5 moment about z
  double sign = 1.0;  // of the commanded motion
};

// Of the balance's equations: of the weight, and of the weight times half the wheelbase.
constexpr double kBalanceTolerance = 1e-9;

// Entry angles into the range that the laws know.
void keep_in_range(RoverBalance::Vector& unknowns);

// Newton's search for the unknowns at which the balance holds, from `x`, with the wheels in contact as they
// are. With `held`, its motion keeps its value and its equation is left out. False where it ends elsewhere;
// `x` is the last iterate, and the balance's contacts are those at `x`. `inverse`, where given, is that of
// the Jacobian somewhere near: a search that it serves well needs no Jacobian of its own.
bool newton(RoverBalance& balance, RoverBalance::Vector& x, const Primary* held, int max_iterations,
            const RoverBalance::Matrix* inverse = nullptr);

// Of the Jacobian at the unknowns of the last residual; nothing where it has none.
std::optional<RoverBalance::Matrix> inverse_jacobian(const RoverBalance& balance,
                                                     const RoverBalance::Vector& x);

}  // namespace slipway::sim
