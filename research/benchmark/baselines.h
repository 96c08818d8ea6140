#pragma once

#include "core/progress.h"
#include "core/result.h"
#include "gap/diagnosis/diagnosis.h"
#include "gap/diagnosis/model/drive_campaign.h"

namespace slipway::gap {

// Simpler methods on the same drives, with which the diagnosis is compared. They fill in the parts of a
// Diagnosis that a benchmark scores: verdict, effects, candidates, closed fraction. Errors: those of the
// diagnosis.

// Adds the catalogue's effects as terms of a linear regression of the re-tuned null model's residuals, one
// after the other while the Bayesian information criterion falls [Schwarz 1978]. There is no second fit and
// no unknown cause.
Result<Diagnosis> diagnose_by_sparse_regression(const DriveCampaign& campaign,
                                                const DiagnosisOptions& options, Progress& progress);

// A Gaussian process over slope, slip, direction, ... for each channel and wheel, trained on the re-tuned
// null model's residuals [Rasmussen & Williams 2006]. It closes the gap and explains nothing, so that its
// verdict is "unknown".
Result<Diagnosis> diagnose_by_gaussian_process(const DriveCampaign& campaign, const DiagnosisOptions& options,
                                               Progress& progress);

// The diagnosis as if samples were independent: every window is treated as a drive of its own, so that
// windows of one drive are on both sides of a fold, and their common errors count as often as there are
// windows.
Result<Diagnosis> diagnose_sample_by_sample(const DriveCampaign& campaign, const DiagnosisOptions& options,
                                            Progress& progress);

// The campaign with each window of each drive as a drive of its own, which repeats no other.
DriveCampaign each_window_a_drive(const DriveCampaign& campaign, const WindowOptions& options);

}  // namespace slipway::gap
