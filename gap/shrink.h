#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "core/progress.h"
#include "core/result.h"
#include "gap/diagnosis.h"
#include "gap/prepared_campaign.h"

namespace slipway::gap {

// How far the gap shrinks on drives that a fit has not seen: both explanations are fitted to the other folds,
// folds being whole drives with their repeats.
struct Shrink {
  std::vector<ChannelShrink> channels;
  std::optional<Interval> closed_fraction;
  double log_density_gain = 0.0;  // held-out log density of `with` over the null's, a drive
  double gain_error = 0.0;        // its standard error over drives
  std::vector<HeldOutPoint> points;
  std::vector<WindowGap> windows;
};

// Residuals of all observations by what was learnt from those that were `seen`, to which `retuned` was
// fitted.
using Correction =
    std::function<Eigen::VectorXd(const FittedExplanation& retuned, const std::vector<bool>& seen)>;
// `explanation` fitted again to what was seen; both must outlive it.
Correction refitted(const PreparedCampaign& prepared, const FittedExplanation& explanation,
                    std::size_t threads);

Result<Shrink> shrink_on_held_out(const PreparedCampaign& prepared, const DriveCampaign& campaign,
                                  const Correction& with, const DiagnosisOptions& options,
                                  Progress& progress);

}  // namespace slipway::gap
