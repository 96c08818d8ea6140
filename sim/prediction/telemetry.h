#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/progress.h"
#include "core/result.h"
#include "sim/prediction/drive_prediction.h"

namespace slipway::sim {

// How exactly telemetry measures, and how often a stretch tells nothing of the ground.
struct TelemetryErrors {
  double position_m = 0.05;  // standard deviation of a position along the track
  double current_a = 0.1;    // the same of a motor's current
  // The share of stretches of which the model is wrong though its ground is right: on a rock, say, that no
  // draw knows. As of drives of the past; assumed.
  double model_error = 0.05;
};

// One stretch of a drive under way, between two positions.
struct MeasuredStretch {
  double rolled_m = 0.0;            // by odometry: the way that the wheels have turned; more than 0
  double come_m = 0.0;              // between the positions
  std::optional<double> current_a;  // mean over the stretch of the sum over the motors
  std::vector<std::optional<double>> wheel_currents_a;  // the same of each wheel; empty where none is known

  double slip_ratio() const { return 1.0 - come_m / rolled_m; }
};

// The same stretch on a draw of the ground.
struct DrawnStretch {
  double slip_ratio = 0.0;
  std::vector<double> currents_a;  // mean of each wheel; empty where the ground is known by a slip curve
  double slip_error = 0.0;         // of what changes within a patch, see slip_deviation()
};

// The standard deviation of a measured slip about a draw's slip s: of two positions, and of what the draw
// leaves out,
//
//   sd^2 = 2 (sp / r)^2 + ((1 - s) ln(1 - s) e)^2 + f^2
//
//   sp  of a position, m          e  slip_error: of the logarithm of the ratio of ln(1 - slip)
//   r   way that the wheels roll, m        f = 0.02, the least error of any prediction of slip; assumed
double slip_deviation(double slip_ratio, double slip_error, double rolled_m, double position_m);

// The part of a soil's slip_error that changes within a patch and is no part of a draw: as large as that from
// patch to patch. Assumed.
double unresolved_slip_error(const SoilDistribution& belief);

// How likely a draw makes a measurement, as a density over the slip (and over the logarithm of each current):
// normal about the draw's, mixed with one that says nothing at the share of the model's error. A current's
// error is the telemetry's and 20 % of the model's, which is assumed.
double likelihood(const MeasuredStretch& measured, const DrawnStretch& drawn, const TelemetryErrors& errors);

// How well the draws knew a stretch before it was measured.
struct StretchForecast {
  DrawnSpread slip_ratio;
  double effective_draws = 0.0;  // after it
};

// Conditions draws of the ground on a stretch along a path, as condition_draws() does on a drive of the past:
// units and patches on which no drive has been are drawn `tries` times, one of the tries is kept with a
// probability that goes with its likelihood, and the draw's weight is multiplied by their mean likelihood.
// Errors as predict_drive().
Result<StretchForecast> condition_on_stretch(const RoverModel& rover, double gravity_m_s2,
                                             const Ground& ground, const SoilBeliefs& beliefs,
                                             std::span<const PathStation> path,
                                             const MeasuredStretch& measured, const TelemetryErrors& errors,
                                             const RiskOptions& risk, int tries, std::size_t threads,
                                             Progress& progress, std::vector<ConditionedDraw>& draws,
                                             const DriveConditions& conditions = {});

}  // namespace slipway::sim
