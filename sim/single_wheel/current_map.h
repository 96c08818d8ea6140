#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/single_wheel/wheel_sweep.h"

namespace slipway::sim {

// How the entry angle under a load is found, and what turns torque into current.
enum class CurrentModel {
  // As the Zhurong paper prints it: A18 and A19 give the entry angle, A16 the torque, and the current is
  // T / (k_I 79.3), the gear that its printed 0.114 A implies (zhurong_literal.h).
  kLiteral,
  // The soil carries the load, and the rover's own motor turns the torque into current.
  kBalanced,
};

// Current and sinkage of one wheel. Where the wheel is sunk to its axle there is only the reason.
struct CurrentPoint {
  SweepPoint place;
  std::optional<double> current_a;
  double sinkage_m = 0.0;
  double torque_nm = 0.0;
  std::string reason;
};

// The current over the axes of a sweep, as run_wheel_sweep has its rows. The sweep has no faults; the literal
// model reads load, slip, soil and wheel, nothing else of the rig.
std::vector<CurrentPoint> run_current_map(const WheelSweep& sweep, CurrentModel model);

// The range over which the paper varies a parameter [Zhurong Table 3, last row; slip: section 3.2], sampled
// `count` times, k_s in equal ratios; nothing where the paper does not vary it.
std::optional<SweepAxis> paper_axis(std::string_view parameter, std::size_t count);

}  // namespace slipway::sim
