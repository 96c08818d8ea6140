#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/angle.h"
#include "core/pose.h"
#include "core/progress.h"
#include "core/result.h"
#include "gap/estimate/least_squares.h"
#include "gap/estimate/parameter_sweep.h"

namespace slipway::gap {

// A drive whose end was measured, once or in several repeats.
struct MeasuredDrive {
  std::string name;
  double tilt_rad = 0.0;  // of the ground it was made on
  std::vector<Pose2> finals;
};

// The simulated end of a drive at a parameter vector; nothing where the model has none. Called from several
// threads at once.
using FinalPose = std::function<std::optional<Pose2>(std::size_t drive, std::span<const double> x)>;

struct ScoreScales {
  double position_m = 0.1;  // a place that is so far off counts 1
  double heading_rad = rad_from_deg(5.0);
};

// sqrt((d / position_m)^2 + (h / heading_rad)^2), with d the distance of the simulated from the measured
// final place and h the difference of the headings, wrapped. The score of a drive is the root mean square
// over its repeats, that of several drives over all of theirs.
double final_score(const Pose2& simulated, const Pose2& measured, const ScoreScales& scales);

struct TunedParameter {
  SweptParameter sweep;
  std::optional<Prior> prior;  // read by least squares alone
};

struct TuningOptions {
  ScoreScales scales = {};
  // True: the scales are the standard deviations of model and measurement together, and uncertainties follow
  // from them. False: they are weights, and the common variance is that of what is left over.
  bool scales_are_errors = false;
  // A set serves a tilt where its score there is at most `within` times the tilt's own best, or at most
  // `good_enough`.
  double within = 1.5;
  double good_enough = 0.1;
  double same_tilt_rad = rad_from_deg(0.5);  // tilts of a group are no more than this above its lowest
  bool least_squares = true;
  // Of least squares alone. With a loss the noise is 1 in units of the scales where those are errors, and
  // otherwise estimated by the median of the differences, which outliers leave alone.
  RobustLoss loss = RobustLoss::kNone;
  std::optional<double> loss_scale = {};  // in multiples of the noise, > 0; nothing: usual_loss_scale()
  bool fit_each_tilt = false;             // also by the drives of each tilt alone
  std::size_t threads = 0;                // 0: as many as the machine has
};

// An estimate by least squares.
struct TuningFit {
  LeastSquaresFit fit;  // residuals in units of the scales
  double score = 0.0;   // of its drives there, all counted in full, to compare with the sweep's
  // Standard deviation of a difference in units of its scale; residual_variance is in units of its square.
  double noise = 1.0;
  std::vector<std::size_t> beyond;  // drives with an end beyond the scale of the loss, rising; none without
};

// The drives of one tilt and the parameter set of the sweep that serves them best.
struct TiltGroup {
  double tilt_rad = 0.0;            // mean
  std::vector<std::size_t> drives;  // indices
  std::size_t best = 0;             // index into ParameterSweep::points
  double best_score = 0.0;
  std::optional<TuningFit> fit;
};

struct TiltRange {
  double lowest_rad = 0.0, highest_rad = 0.0;
};

// Which tilts one parameter set serves.
struct SlopeService {
  std::vector<std::optional<double>> scores;  // of each tilt group
  std::vector<bool> served;
  int count = 0;  // of tilts served
  std::optional<TiltRange>
      range;  // the longest run of neighbouring tilts that are served, the lowest of such
};

struct DriveTuning {
  ParameterSweep sweep;
  std::vector<TiltGroup> tilts;        // rising
  std::vector<SlopeService> services;  // of each of ParameterSweep::points
  std::size_t widest = 0;              // the point that serves most tilts, of those the one of the best score
  std::optional<TuningFit> fit;        // by all drives, started from the sweep's best
};

// Tunes parameters to measured final poses as ROAMS was to FIDO: a coarse and a fine sweep, the slopes that
// one set serves [Huntsberger et al. 2008, section 3]; and by least squares over the same differences with
// priors and the sweep's ranges as bounds. Where the noise is known, or estimated beneath a loss, and
// differences scatter more than it says, uncertainties are widened by as much (LeastSquaresOptions::widen).
//
// Errors: those of sweep_coarse_then_fine and fit_least_squares; invalid_request for options out of range.
Result<DriveTuning> tune_drives(std::span<const TunedParameter> parameters,
                                std::span<const MeasuredDrive> drives, const FinalPose& model,
                                const TuningOptions& options, Progress& progress);

}  // namespace slipway::gap
