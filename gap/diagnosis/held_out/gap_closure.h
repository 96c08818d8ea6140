#pragma once

#include <optional>
#include <vector>

#include "core/progress.h"
#include "core/result.h"
#include "gap/diagnosis/held_out/held_out.h"
#include "gap/diagnosis/model/drive_resampling.h"
#include "gap/diagnosis/result/result.h"
#include "gap/diagnosis/search/diagnosis_options.h"
#include "gap/diagnosis/search/prepared_campaign.h"

namespace slipway::gap {

// How far the gap shrinks on drives that a fit has not seen: both explanations are fitted to the other folds,
// folds being whole drives with their repeats.
struct Shrink {
  std::vector<ChannelClosure> channels;
  std::optional<Interval> closed_fraction;
  double log_density_gain = 0.0;  // held-out log density of the correction over the null's, a drive
  PlannersView planners_view;
  std::vector<HeldOutPoint> points;
  std::vector<WindowGap> windows;
};

// The correction that is told, [0], and those that would have been chosen had other drives been made.
struct CorrectionChoice {
  std::vector<Correction> corrections;
  std::vector<std::size_t> of_resample;  // which of them; empty: always the first
};

// Intervals are over resamples of drives, the choice repeated in each as far as `choice` says.
Result<Shrink> close_gap_on_held_out(const PreparedCampaign& prepared, const DriveCampaign& campaign,
                                     const CorrectionChoice& choice, const DriveResampling& drives,
                                     const DiagnosisOptions& options, Progress& progress);

}  // namespace slipway::gap
