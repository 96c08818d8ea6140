#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/progress.h"
#include "core/result.h"
#include "gap/diagnosis/held_out/held_out.h"
#include "gap/diagnosis/model/drive_resampling.h"
#include "gap/diagnosis/result/result.h"
#include "gap/diagnosis/search/diagnosis_options.h"

namespace slipway::gap {

// What a correction learnt from the gentle drives is worth on the harsh ones: along the slope, the cold and
// the speed of drives as far as the campaign has them, the harshest third is predicted from the rest.
Result<std::vector<Extrapolation>> extrapolate(const PreparedCampaign& prepared,
                                               const DriveCampaign& campaign, const Correction& correction,
                                               const DriveResampling& drives, const DiagnosisOptions& options,
                                               Progress& progress);

// The harshness of groups of drives beyond which they are predicted: a quantile of those that have one (not
// NaN). Nothing where there are too few of them, or where they differ by less than `min_range`.
std::optional<double> harsh_from(std::span<const double> harshness, double min_range,
                                 const ExtrapolationOptions& options);

// The mean and its standard error; two gains at least.
struct MeanGain {
  double mean = 0.0, error = 0.0;
};
MeanGain mean_gain(std::span<const double> gains);

}  // namespace slipway::gap
