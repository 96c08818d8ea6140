#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "core/progress.h"
#include "core/result.h"
#include "gap/diagnosis/held_out/held_out.h"
#include "gap/diagnosis/model/drive_resampling.h"
#include "gap/diagnosis/result/result.h"
#include "gap/diagnosis/search/diagnosis_options.h"
#include "gap/diagnosis/search/prepared_campaign.h"

namespace slipway::gap {

// How far the gap closes on drives that a fit has not seen: both explanations are fitted to the other folds,
// folds being whole drives with their repeats.
struct GapClosure {
  std::vector<ChannelClosure> channels;
  std::optional<Interval> closed_fraction;
  double log_density_gain = 0.0;  // held-out log density of the correction over the null's, a drive
  PlannersView planners_view;
  std::vector<HeldOutPoint> points;
  std::vector<WindowGap> windows;
};

// Intervals are over resamples of drives.
Result<GapClosure> close_gap_on_held_out(const PreparedCampaign& prepared, const DriveCampaign& campaign,
                                         const Correction& correction, const DriveResampling& drives,
                                         const DiagnosisOptions& options, Progress& progress);

// Whether each drive is learnt from in a fold, by the groups of drives and their repeats. Folds alternate
// along the list of drives, so that each has every kind.
std::vector<bool> learnt_from_in(std::span<const std::size_t> groups, int fold, int folds);

// The share of a gap that is closed, (rms before - rms after) / (rms before - rms of the floor), held within
// 0 and 1; of sums of squares over `count`. Nothing where no gap was left to close.
std::optional<double> closed_share(double before, double after, double floor, double count);

// Sums over all held-out drives, and over each resample of them.
struct Bootstrapped {
  HeldOutErrors all;
  std::vector<HeldOutErrors> resampled;

  // 90 % interval of a number of the sums, by percentiles of the resamples.
  Interval interval(const std::function<double(const HeldOutErrors&)>& number) const;
  // The same of a share that may not exist: a resample without one says neither end and counts for both.
  std::optional<Interval> closed_interval(
      const std::function<std::optional<double>(const HeldOutErrors&)>& number) const;
};
// `errors`: by group of drives.
Bootstrapped bootstrap_errors(std::span<const HeldOutErrors> errors,
                              std::span<const std::vector<std::size_t>> resamples);

}  // namespace slipway::gap
