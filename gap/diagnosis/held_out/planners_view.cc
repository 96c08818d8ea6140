#include "gap/diagnosis/held_out/planners_view.h"

#include <cmath>

#include "core/normal_interval.h"

namespace slipway::gap {
namespace {

std::array<PlannersFigures*, 3> models_of(PlannersView& view) {
  return {&view.nominal, &view.retuned, &view.with_effects};
}

}  // namespace

RankedPairs rank_pairs(std::span<const DriveSlip> drives, double clearly_more) {
  RankedPairs ranked;
  for (std::size_t a = 0; a < drives.size(); ++a)
    for (std::size_t b = a + 1; b < drives.size(); ++b) {
      const DriveSlip &one = drives[a], &other = drives[b];
      if (one.windows == 0.0 || other.windows == 0.0) continue;
      const double apart = one.measured / one.windows - other.measured / other.windows;
      if (std::abs(apart) < clearly_more) continue;
      ++ranked.pairs;
      for (std::size_t m = 0; m < kPlannersModels; ++m)
        ranked.in_order[m] +=
            apart * (one.predicted[m] / one.windows - other.predicted[m] / other.windows) > 0.0 ? 1.0 : 0.0;
    }
  return ranked;
}

PlannersTally::PlannersTally(const PreparedCampaign& prepared, std::size_t drives,
                             const HeldOutOptions& options)
    : prepared_(prepared), clearly_more_(options.clearly_more_slip), drives_(drives) {}

void PlannersTally::add(std::size_t window, const HeldOutComparison& comparison) {
  const DriveWindow& of = prepared_.windows[window];
  const auto models = models_of(view_);
  for (std::size_t i = 0; i < of.observations.size(); ++i) {
    const std::size_t row = prepared_.model->offset(window) + i;
    const auto at = static_cast<Eigen::Index>(row);
    const std::array<double, kPlannersModels> residuals{prepared_.nominal_residuals[at],
                                                        comparison.retuned(row), comparison.corrected(row)};
    const Observation& o = of.observations[i];
    if (comparison.compares(window, i)) {
      ++view_.observations;
      for (std::size_t m = 0; m < kPlannersModels; ++m)
        models[m]->within_90 +=
            std::abs(residuals[m]) <= kReach90 * prepared_.noise->deviation()[at] ? 1.0 : 0.0;
    }
    if (o.channel != Channel::kSlip || !prepared_.noise->used()[row]) continue;
    ++view_.windows;
    view_.immobilised += of.censored ? 1 : 0;
    DriveSlip& drive = drives_[of.drive];
    drive.measured += o.value;
    drive.windows += 1.0;
    for (std::size_t m = 0; m < kPlannersModels; ++m) {
      const double predicted = o.value - residuals[m];
      drive.predicted[m] += predicted;
      if (predicted > kCensoredSlip) ++(of.censored ? models[m]->called : models[m]->false_calls);
    }
  }
}

PlannersView PlannersTally::view() const {
  PlannersView view = view_;
  const auto models = models_of(view);
  const RankedPairs ranked = rank_pairs(drives_, clearly_more_);
  view.pairs = ranked.pairs;
  for (std::size_t m = 0; m < kPlannersModels; ++m) models[m]->in_order = ranked.in_order[m];
  for (PlannersFigures* figures : models) {
    if (view.observations > 0) figures->within_90 /= static_cast<double>(view.observations);
    if (view.pairs > 0) figures->in_order /= static_cast<double>(view.pairs);
  }
  return view;
}

}  // namespace slipway::gap
