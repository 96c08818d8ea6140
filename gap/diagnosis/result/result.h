#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/pose.h"
#include "gap/diagnosis/decide/decision.h"
#include "gap/diagnosis/decide/search_record.h"
#include "gap/diagnosis/model/drive_campaign.h"
#include "gap/diagnosis/model/drive_window.h"
#include "gap/diagnosis/model/noise_model.h"
#include "gap/diagnosis/model/nuisance_catalogue.h"
#include "gap/diagnosis/model/window_model.h"
#include "gap/diagnosis/model/window_variables.h"
#include "gap/diagnosis/search/diagnosis_options.h"
#include "gap/diagnosis/search/parameter_posterior.h"
#include "gap/estimate/interval.h"
#include "sim/rover/effect_setting.h"

namespace slipway::gap {

struct FoundParameter {
  std::string name;  // of the effect's field, in its unit
  Interval value;
};

struct FoundEffect {
  std::string name;
  std::string variant;  // which of its ways, for people
  double probability = 0.0;
  std::vector<FoundParameter> parameters;
};

struct ComparedSet {
  std::vector<std::string> effects;  // of the library
  double probability = 0.0;
  std::optional<double> held_out_score;  // mean log density a drive, over the null's; of what was refitted
  int complexity = 0;                    // estimated parameters besides the nuisances
  double chosen_share = 0.0;             // of resamples of the drives, those that would have led to this set
  bool with_unknown = false;             // something besides them that the library has no name for
  std::string outside = {};  // that something's form, a row of outside_catalogue; empty: of no known form
  // Logarithms: of the evidence over that of nothing missing, as it stands before a share of it is believed,
  // and of the prior probability.
  // Nothing of a set that was not compared, and where nothing missing was not.
  std::optional<double> log_evidence = {}, log_prior = {};
};
// Its effects, and "unknown" behind them where something else is: for documents and people.
std::vector<std::string> names_of(const ComparedSet& set);

// What the found correction is worth where it had not been: learnt from the gentle drives, predicted of the
// harsh.
struct Extrapolation {
  std::string variable;  // "slope_deg", ...
  bool above = true;     // drives above (or below) the limit are predicted; it is in the variable's unit
  double limit = 0.0;
  std::size_t groups = 0;         // drives predicted, repeats as one
  double log_density_gain = 0.0;  // over re-tuned parameters alone, a drive
  double error = 0.0;             // its standard error
};

struct ConfusablePair {
  std::string a, b;
  double angle_deg = 0.0;  // between their signatures, nuisances projected out
};

// What an effect can't be told from on these drives: effects and causes from outside whose traces are nearly
// parallel, and the re-tuned parameters where they take most of its trace.
struct LookAlike {
  std::string effect;
  std::string like;                // an effect, a cause from outside, or "parameters"
  std::vector<std::string> which;  // of the parameters, those that take most of it
  double angle_deg = 0.0;  // between the traces, re-tuning projected out of both; to all that re-tuning does
};

// What would uncover an effect that these drives hide behind re-tuned parameters: those of these kinds,
// measured apart from drives.
struct MeasurementProposal {
  std::string effect;
  std::vector<NuisanceKind> kinds;
  std::vector<std::string>
      parameters;  // rows of the nuisance catalogue, of these kinds, that are re-tuned here
  // By how many deviations the effect shows at its usual size, as it is and with them known.
  double deviations_now = 0.0, deviations_then = 0.0;
};
// "plate and shear tests of the soil", of each kind.
std::string_view measurement_of(NuisanceKind kind);

// A channel (of a wheel) before any re-tuning.
struct ChannelGap {
  Channel channel = Channel::kSlip;
  std::optional<std::string> wheel;  // nothing: of the rover
  double gap = 0.0, noise = 0.0;     // rms, of residuals and of what scatter makes them
  double bias = 0.0;                 // mean residual, measured less predicted
  double significance = 1.0;         // p, corrected for the number of channels looked at
};

struct Condition {
  WindowVariable variable = WindowVariable::kSlope;
  double from = 0.0, to = 0.0;
};

// A slice of the drives that holds more of the gap than of the data.
struct Regime {
  std::vector<Condition> conditions;
  Channel channel = Channel::kSlip;
  double share_of_gap = 0.0, share_of_data = 0.0;
  double significance = 1.0;
};

// What a channel has of what is looked at, in squared deviations of the noise; shares add up to 1.
struct ChannelShare {
  Channel channel = Channel::kSlip;
  double share = 0.0;
};

struct GapPlace {
  std::string terrain;
  double x_m = 0.0, y_m = 0.0, radius_m = 0.0;
  Channel channel = Channel::kSlip;
  double share_of_gap = 0.0;
};

// Root mean square of prediction less measurement in drives that the fit has not seen.
struct ChannelClosure {
  Channel channel = Channel::kSlip;
  Interval nominal, retuned, with_effects, noise_floor;
  // (retuned - with_effects) / (retuned - noise_floor), within 0 and 1; nothing where re-tuning left no gap.
  std::optional<Interval> closed_fraction = {};
  // With what nobody has named described beside the effects, as far as it repeats from drive to drive.
  std::optional<Interval> with_discrepancy = {};
};

// What planning with a model would have predicted of drives held out of the fit.
struct PlannersFigures {
  double within_90 = 0.0;       // share of observations in the 90 % interval of sensors and scatter
  std::size_t called = 0;       // windows predicted immobilised (slip above kCensoredSlip) that were
  std::size_t false_calls = 0;  // and that were not
  double in_order = 0.0;        // share of pairs of drives, of which one clearly slipped more
};
struct PlannersView {
  std::size_t observations = 0, windows = 0, immobilised = 0, pairs = 0;
  PlannersFigures nominal, retuned, with_effects;
};

// Where a window of drives held out of the fit lies, and its residuals: root mean squares over its channels,
// in deviations. 1: as its noise.
struct WindowGap {
  std::size_t terrain = 0, drive = 0;  // indices into the campaign's
  double start_s = 0.0;
  std::vector<Pose2> stations;
  double nominal = 0.0, retuned = 0.0, with_effects = 0.0;
};

// One observation of a window beside what was predicted of it; of the last two by fits that had not seen its
// drive. In the channel's own unit.
struct HeldOutPoint {
  Channel channel = Channel::kSlip;
  int wheel = -1;  // of a wheel's channel
  std::size_t drive = 0;
  double start_s = 0.0;
  double measured = 0.0, nominal = 0.0, retuned = 0.0, with_effects = 0.0;
};

// What is left over that nobody has named: where it enters, what it depends on, its shape.
struct ResidualShape {
  std::string entry, variable;
  double share = 0.0;                              // of all that is described, in squared deviations
  std::vector<std::pair<double, Interval>> shape;  // over the variable: at, effect on the entry's channel
  std::string form = "smooth_function";            // or that of a cause from outside: "force_on_body", ...
  std::string words = {};                          // of a cause from outside: "a steady pull of 25 N ..."
  std::string unit = {};                           // of its shape
  std::optional<double> probability = {};          // of its being at work, over all explanations
  std::optional<double> closed_share = {};         // of the held-out gap that goes with it, as of an effect
  std::vector<FoundParameter> parameters = {};
};

struct NextDrive {
  double tilt_deg = 0.0, heading_deg = 0.0, speed_m_s = 0.0, curvature_1_m = 0.0;
  double motor_temp_c = 20.0;
  double information_bits = 0.0;
};

// An effect of the library over all explanations, with and without something unknown beside it.
struct EffectMarginal {
  std::string name;
  double probability = 0.0;  // of being present
  // Of the gap that re-tuning leaves on drives held out of the fit, what goes with it, within 0 and 1; see
  // effect_marginals.h.
  double closed_share = 0.0;
  double calibrated = 0.0;  // probability that it is at work, by which it is named: see calibration.h
};

// The effect's own among these; probability and share are 0 where it is not.
EffectMarginal marginal_of(std::span<const EffectMarginal> marginals, const std::string& effect);

// Something unknown of a known form: a force from outside, or a sensor that reads wrongly.
struct OutsideFinding {
  std::string cause;          // row of outside_catalogue
  std::string words;          // "a steady pull of 25 N against the travel, at the body"
  double probability = 0.0;   // of being at work, over all explanations
  double closed_share = 0.0;  // as of an effect
  std::vector<FoundParameter> parameters;
};

// The least size of an effect that the drives would surely have shown.
struct LeastDetectable {
  std::string effect, parameter;
  double value = 0.0;
};

struct RetunedParameter {
  std::string name;
  Interval value;  // the logarithm or number that the nuisance catalogue says
  double prior_std = 0.0;
  bool determined = true;  // the drives say more than the prior
  double believed = 0.0;   // before the drives; 0 is the nominal value, a reference may have told of another
};

// The drives that were taken as healthy, and the difference between model and drives that they taught, in the
// windows of those that follow: its root mean square, and that of what is still open of it, in the channel's
// unit.
struct ReferenceSummary {
  struct LearntChannel {
    Channel channel = Channel::kSlip;
    double learnt = 0.0, open = 0.0;
  };
  std::string campaign, fingerprint;
  std::size_t drives = 0, windows = 0;
  std::vector<LearntChannel> channels;
};

struct Diagnosis {
  std::optional<ReferenceSummary> reference;
  std::string campaign, campaign_fingerprint;
  std::uint64_t seed = 1;
  std::vector<ListedOption> options;
  std::vector<std::string> library;  // effects that were looked for
  Verdict verdict = Verdict::kInsufficient;
  bool model_adequate = true;  // what was believed of soils, laws and scatter stands: see adequacy.h
  double conflict_probability = 1.0, held_out_probability = 1.0;
  bool partial = false;       // effects are named, and something unexplained remains beside them
  std::string reason;         // one sentence
  std::string overturned_by;  // what would
  std::vector<FoundEffect> effects;
  SearchRecord search;                    // what the verdict was decided from
  std::vector<EffectMarginal> marginals;  // of all of the library, the most probable first
  std::vector<ComparedSet> candidates;
  std::vector<ConfusablePair> confusable;
  std::vector<LookAlike> look_alikes;             // the nearest first
  std::vector<MeasurementProposal> measurements;  // of effects that these drives can't show, by name
  std::vector<ChannelGap> channels;
  std::vector<Regime> regimes, regimes_retuned, regimes_of_effect;
  std::vector<ChannelShare> channels_of_effects;  // of what the named effects do; the largest first
  std::vector<GapPlace> places;
  std::vector<ChannelClosure> gap;
  PlannersView planners_view;
  std::vector<HeldOutPoint> held_out;  // for pictures
  std::vector<WindowGap> window_gaps;  // of drives held out of the fit, for maps
  std::optional<Interval> closed_fraction;
  std::vector<Extrapolation> extrapolations;
  // For `unknown` and beside effects that do not explain all: what is left. `residual` has what is of a known
  // form first.
  std::optional<OutsideFinding> outside;
  std::vector<ResidualShape> residual;
  std::vector<NextDrive> next_drives;
  std::vector<LeastDetectable> least_detectable;
  std::vector<RetunedParameter> retuned;
  // The rover and the soils that `retuned` is relative to: the campaign's own, but with a reference those of
  // the same names that the reference has.
  std::shared_ptr<const sim::RoverModel> nominal_rover;
  std::vector<NominalSoil> nominal_soils;
  std::vector<std::string> notes;
  // The corrected model: the re-tuned nominal one with the effects found.
  std::optional<ModelState> model;
  std::vector<sim::EffectSetting> model_effects;
  ParameterPosterior left_open;  // of what the model was re-tuned in
  std::size_t drives = 0, windows = 0, observations = 0;
  NoiseScales noise;
};

}  // namespace slipway::gap
