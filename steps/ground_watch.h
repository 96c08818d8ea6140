#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "steps/ground_chain.h"
#include "steps/step_forecaster.h"

namespace slipway::steps {

// A stretch of one sol on which the rover came onto loose ground.
struct LooseStretch {
  std::size_t first = 0, last = 0;  // steps of the sol, from 0
  double probability = 0.0;         // that it is loose, where that is surest
  double largest_slip = 0.0;        // measured on it
  double usual_slip = 0.0;          // what firm ground would have had there, median over its steps
};

// Watches the ground under measured steps, sol after sol. The place is loose, no wheel is at fault: the slip
// of the whole rover is all that is measured.
class GroundWatch {
 public:
  // The chain must outlive it.
  explicit GroundWatch(const GroundChain& chain, StepMemory memory = {});

  // The stretches of the next sol that raise an alarm: where a soil that lies in patches has a probability of
  // at least one half on every step and 0.95 on some, by all steps of the sol, and some slip is above 0.2,
  // from which on a drive is planned with care.
  std::vector<LooseStretch> next_sol(std::span<const ChainStep> steps);

 private:
  const GroundChain& chain_;
  StepForecaster memory_;
};

}  // namespace slipway::steps
