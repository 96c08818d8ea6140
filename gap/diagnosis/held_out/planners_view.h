#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "gap/diagnosis/held_out/held_out.h"
#include "gap/diagnosis/result/result.h"

namespace slipway::gap {

// Counts, over windows held out of the fit, what a planner asks of a model: whether its intervals hold,
// whether it calls the place where the rover stays, and which of two drives slips more.
class PlannersTally {
 public:
  // `prepared` must outlive it.
  PlannersTally(const PreparedCampaign& prepared, std::size_t drives);
  void add(std::size_t window, const HeldOutComparison& comparison);
  PlannersView view() const;

 private:
  static constexpr std::size_t kModels = 3;  // nominal, re-tuned, corrected
  // Sums of slip over a drive's windows.
  struct DriveSlip {
    double measured = 0.0, windows = 0.0;
    std::array<double, kModels> predicted{};
  };

  const PreparedCampaign& prepared_;
  std::vector<DriveSlip> drives_;
  PlannersView view_;  // `within_90` as a count
};

}  // namespace slipway::gap
