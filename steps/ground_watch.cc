#include "steps/ground_watch.h"

#include <algorithm>

#include "core/quantile.h"

namespace slipway::steps {
namespace {

constexpr double kOnIt = 0.5, kSure = 0.95, kLargeSlip = 0.2;

}  // namespace

GroundWatch::GroundWatch(const GroundChain& chain, StepMemory memory)
    : chain_(chain), memory_(chain, StepLearning::kSols, memory) {}

std::vector<LooseStretch> GroundWatch::next_sol(std::span<const ChainStep> steps) {
  const ChainPass pass = memory_.learn_sol(steps);
  std::vector<LooseStretch> found;
  std::optional<LooseStretch> open;
  std::vector<double> usual;
  const auto close = [&] {
    if (open && open->probability >= kSure && open->largest_slip > kLargeSlip) {
      open->usual_slip = median(usual);
      found.push_back(*open);
    }
    open.reset();
    usual.clear();
  };
  for (std::size_t t = 0; t < steps.size(); ++t) {
    const Eigen::ArrayXd slips = chain_.predicted_slips(steps[t]);
    double loose = 0.0, firm_share = 0.0, firm_slip = 0.0;
    for (std::size_t k = 0; k < chain_.soils.size(); ++k) {
      const auto soil = static_cast<Eigen::Index>(k);
      if (chain_.soils[k].in_patches) {
        loose += pass.smoothed(soil, static_cast<Eigen::Index>(t));
      } else {
        const double share = chain_.grounds[steps[t].ground].shares[soil];
        firm_share += share;
        firm_slip += share * slips[soil];
      }
    }
    if (loose < kOnIt) {
      close();
      continue;
    }
    if (!open) open = LooseStretch{.first = t};
    open->last = t;
    open->probability = std::max(open->probability, loose);
    open->largest_slip = std::max(open->largest_slip, steps[t].slip);
    usual.push_back(firm_slip / std::max(firm_share, 1e-12));
  }
  close();
  return found;
}

}  // namespace slipway::steps
