#pragma once

#include <string>
#include <vector>

#include "research/validation/laboratory/wheel_tests.h"
#include "sim/soil/soil.h"

namespace slipway::validation {

struct PavlovReading {
  double pull_n = 0.0, side_n = 0.0, sinkage_m = 0.0;
  bool sunk = false;  // the soil carries the load nowhere; forces are those at the law's maximum entry angle
};

// The readings of a wheel that moves at the rig's speed along the travel direction while its rim turns at its
// own speed, under the mean load of the repeats. The side force is positive against the side motion, as on
// the rig. A locked rim is modelled as turning at a thousandth of the travel speed.
PavlovReading read_pavlov_rig(const sim::WheelGeometry& wheel, const sim::Soil& sand,
                              const WheelCondition& condition);

// Predicted less measured: forces over the load.
struct PavlovErrors {
  std::vector<double> pull, side, sinkage_mm;

  void add(const PavlovReading& predicted, const WheelCondition& condition);
  static double rms(const std::vector<double>& values);
  // "pull rms 13.8 %, median 8.7 %; side force rms ... (27 conditions)".
  std::string words() const;
};

}  // namespace slipway::validation
