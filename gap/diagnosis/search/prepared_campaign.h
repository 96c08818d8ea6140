#pragma once

#include <array>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/progress.h"
#include "core/result.h"
#include "gap/diagnosis/model/noise_model.h"
#include "gap/diagnosis/model/window_model.h"
#include "gap/diagnosis/search/discrepancy_term.h"
#include "gap/diagnosis/search/explanation.h"

namespace slipway::gap {

// The rover stands as its suspension does on the map, with its wheels sunk or before they sink, or on the
// plane under its wheels, whichever the recorded attitudes show. Campaign and windows must outlive the model.
std::unique_ptr<WindowModel> window_model_of(const DriveCampaign& campaign,
                                             std::span<const DriveWindow> windows,
                                             const PreparationOptions& options, std::size_t threads);

// What a noise model asks for: derivatives of every observation by the logarithms of all soils' stiffness,
// tan(friction) and shear modulus, of a hypothesis' scaled jacobian, and by the levers of the map's detail.
Eigen::MatrixXd scatter_response(const Hypothesis& hypothesis, const Eigen::MatrixXd& jacobian,
                                 const Eigen::MatrixXd& levers);

// Lets soils scatter as they do around a fit, with its effects at work. Takes effect with the noise's next
// scales.
void scatter_around(const FittedExplanation& fit, const WindowModel& model, NoiseModel& noise);

// A campaign cut into windows, the null fitted to it, and what its drives scatter by.
struct PreparedCampaign {
  std::vector<DriveWindow> windows;
  std::unique_ptr<WindowModel> model;
  std::unique_ptr<NoiseModel> noise;
  std::optional<FittedExplanation> null;
  DiscrepancyTerm discrepancy;
  Eigen::VectorXd nominal_residuals;  // measured less predicted before any re-tuning; NaN without an answer

  // Number of windows that a diagnosis can use.
  std::size_t used_windows() const;
};

// Estimates the drives' scatter anew around an explanation that was found, and fits the null under it: with
// an effect missing, what it does was in part taken for scatter.
void prepare_around(PreparedCampaign& prepared, const DriveCampaign& campaign, const FittedExplanation& found,
                    const DiagnosisOptions& options);

// As much as needs no look at how prediction and drives differ: windows, the model as it was believed before
// (by a reference, where there is one) and the scatter likewise. No null, no discrepancy term. Work that is
// cancelled ends early with numbers that nobody looks at. Errors: payload_too_large beyond
// PreparationOptions::max_observations, with how to thin the drives.
Result<PreparedCampaign> prepare_as_believed(const DriveCampaign& campaign, const DiagnosisOptions& options,
                                             Progress& progress, const std::vector<bool>& looked_at = {});

// What a first look says, before anything was fitted: which channel is furthest off what was predicted, in
// what it usually scatters by.
std::string first_look_words(const PreparedCampaign& prepared, const sim::RoverModel& rover);

// Campaign and progress must outlive what is made of them. Channels that are not `looked_at` (empty: all are)
// are not used. Errors: payload_too_large as above; cancelled.
Result<PreparedCampaign> prepare(const DriveCampaign& campaign, const DiagnosisOptions& options,
                                 Progress& progress, const std::vector<bool>& looked_at = {});

}  // namespace slipway::gap
