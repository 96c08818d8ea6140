#include "gap/diagnosis/held_out/planners_view.h"

#include <cmath>

#include "core/normal_interval.h"

namespace slipway::gap {
namespace {

// Drives whose mean slips are nearer than this are not told apart by any sensor here.
constexpr double kClearlyMore = 0.05;

std::array<PlannersFigures*, 3> models_of(PlannersView& view) {
  return {&view.nominal, &view.retuned, &view.with_effects};
}

}  // namespace

PlannersTally::PlannersTally(const PreparedCampaign& prepared, std::size_t drives)
    : prepared_(prepared), drives_(drives) {}

void PlannersTally::add(std::size_t window, const HeldOutComparison& comparison) {
  const DriveWindow& of = prepared_.windows[window];
  const auto models = models_of(view_);
  for (std::size_t i = 0; i < of.observations.size(); ++i) {
    const std::size_t row = prepared_.model->offset(window) + i;
    const auto at = static_cast<Eigen::Index>(row);
    const std::array<double, kModels> residuals{prepared_.nominal_residuals[at], comparison.retuned(row),
                                                comparison.corrected(row)};
    const Observation& o = of.observations[i];
    if (comparison.compares(window, i)) {
      ++view_.observations;
      for (std::size_t m = 0; m < kModels; ++m)
        models[m]->within_90 +=
            std::abs(residuals[m]) <= kReach90 * prepared_.noise->deviation()[at] ? 1.0 : 0.0;
    }
    if (o.channel != Channel::kSlip || !prepared_.noise->used()[row]) continue;
    ++view_.windows;
    view_.immobilised += of.censored ? 1 : 0;
    DriveSlip& drive = drives_[of.drive];
    drive.measured += o.value;
    drive.windows += 1.0;
    for (std::size_t m = 0; m < kModels; ++m) {
      const double predicted = o.value - residuals[m];
      drive.predicted[m] += predicted;
      if (predicted > kCensoredSlip) ++(of.censored ? models[m]->called : models[m]->false_calls);
    }
  }
}

PlannersView PlannersTally::view() const {
  PlannersView view = view_;
  const auto models = models_of(view);
  for (std::size_t a = 0; a < drives_.size(); ++a)
    for (std::size_t b = a + 1; b < drives_.size(); ++b) {
      const DriveSlip &one = drives_[a], &other = drives_[b];
      if (one.windows == 0.0 || other.windows == 0.0) continue;
      const double apart = one.measured / one.windows - other.measured / other.windows;
      if (std::abs(apart) < kClearlyMore) continue;
      ++view.pairs;
      for (std::size_t m = 0; m < kModels; ++m)
        models[m]->in_order +=
            apart * (one.predicted[m] / one.windows - other.predicted[m] / other.windows) > 0.0 ? 1.0 : 0.0;
    }
  for (PlannersFigures* figures : models) {
    if (view.observations > 0) figures->within_90 /= static_cast<double>(view.observations);
    if (view.pairs > 0) figures->in_order /= static_cast<double>(view.pairs);
  }
  return view;
}

}  // namespace slipway::gap
