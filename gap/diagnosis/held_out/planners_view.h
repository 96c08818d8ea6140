#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "gap/diagnosis/held_out/held_out.h"
#include "gap/diagnosis/result/result.h"

namespace slipway::gap {

constexpr std::size_t kPlannersModels = 3;  // nominal, re-tuned, corrected

// Sums of slip over a drive's windows.
struct DriveSlip {
  double measured = 0.0, windows = 0.0;
  std::array<double, kPlannersModels> predicted{};
};

// Pairs of drives, of which one slipped more by `clearly_more` on average, and of how many of them each model
// says rightly which.
struct RankedPairs {
  std::size_t pairs = 0;
  std::array<double, kPlannersModels> in_order{};
};
RankedPairs rank_pairs(std::span<const DriveSlip> drives, double clearly_more);

// Counts, over windows held out of the fit, what a planner asks of a model: whether its intervals hold,
// whether it calls the place where the rover stays, and which of two drives slips more.
class PlannersTally {
 public:
  // `prepared` must outlive it.
  PlannersTally(const PreparedCampaign& prepared, std::size_t drives, const HeldOutOptions& options);
  void add(std::size_t window, const HeldOutComparison& comparison);
  PlannersView view() const;

 private:
  const PreparedCampaign& prepared_;
  double clearly_more_;
  std::vector<DriveSlip> drives_;
  PlannersView view_;  // `within_90` as a count
};

}  // namespace slipway::gap
