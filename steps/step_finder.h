#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "steps/spice_spk.h"
#include "steps/steps_from_spice.h"

namespace slipway::steps {

// Where the rover was thought to be, and how it stood where that is known.
struct PlacedState {
  double et_s = 0.0;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  // north, east, down
  std::optional<Eigen::Quaterniond> attitude;
};

// A drive by the wheels, the rest that followed, and the correction of the position.
struct FoundStep {
  PlacedState start, end;
  Eigen::Vector3d driven_m = Eigen::Vector3d::Zero();  // the sum of its moves
  Eigen::Vector3d correction_m = Eigen::Vector3d::Zero();
  double drive_s = 0.0;
};

// The steps of the states of one site in file order, some of which have equal times. With attitudes a state
// without one starts anew; without attitudes drives and corrections are told apart by their lengths.
std::vector<FoundStep> find_steps(const std::vector<PlacedState>& states, bool with_attitudes,
                                  const SpiceStepOptions& options, SpiceStepSummary& summary);

}  // namespace slipway::steps
