#pragma once

#include "core/progress.h"
#include "core/result.h"
#include "gap/diagnosis/diagnosis.h"
#include "gap/diagnosis/model/drive_campaign.h"

namespace slipway::gap {

// What simpler methods say of the same drives, for the diagnosis to be compared with. They fill in of the
// Diagnosis what a benchmark scores: verdict, effects, candidates, closed fraction.

// The catalogue's effects as terms of a linear regression of the re-tuned null's residuals, added one after
// the other while the Bayesian information criterion falls [Schwarz 1978]: no second fit, nothing else
// competes.
Result<Diagnosis> diagnose_by_sparse_regression(const DriveCampaign& campaign,
                                                const DiagnosisOptions& options, Progress& progress);

// A Gaussian process over slope, slip, direction, ... for each channel and wheel, learnt from the re-tuned
// null's residuals [Rasmussen & Williams 2006]: it closes the gap and explains nothing, so its verdict is
// "unknown".
Result<Diagnosis> diagnose_by_gaussian_process(const DriveCampaign& campaign, const DiagnosisOptions& options,
                                               Progress& progress);

// The diagnosis as if samples were independent: every window is taken for a drive of its own, so that windows
// of one drive stand on both sides of a fold, and what they share counts as often as there are windows.
Result<Diagnosis> diagnose_sample_by_sample(const DriveCampaign& campaign, const DiagnosisOptions& options,
                                            Progress& progress);

// Each window of each drive as a drive that repeats no other.
DriveCampaign each_window_a_drive(const DriveCampaign& campaign, const WindowOptions& options);

}  // namespace slipway::gap
