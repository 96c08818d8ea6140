#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gap/diagnosis/model/drive_window.h"
#include "gap/diagnosis/model/noise_model.h"

namespace slipway::gap {

// Every number that the answer of a diagnosis depends on, with the reason for its value, by the step that
// uses it. docs/method/estimator.md has the equations with the names of these fields beside the symbols, and
// an answer's provenance has their values: see listed_options. Numbers that decide only how a result is
// computed (the step of a difference, the order of a search) are constants beside the code.
//
// "Deviations" are standard deviations of the whitened noise; "prior deviations" are those that a parameter
// is believed by before the drives; "gain" is a difference of natural logarithms of evidences.

// How the most probable parameters of an explanation are found: see posterior_mode.h.
struct FitOptions {
  // Deviations beyond which a residual counts linearly. No window is Gaussian that far out, and a smaller
  // threshold would weigh down the slopes on which effects show.
  double huber = 4.0;
  // Deviations by which an observation is off where the model has no answer because the rover would not move:
  // as much as the loss still takes in full.
  double no_answer = 4.0;
  double both_stuck = 1.0;  // the same where the rover hardly moved either: as much as noise does
  // Prior deviations of soils' friction by which they are made stronger for a second fit, where the first
  // says of a rover that drove on that it would not move.
  double stronger_friction = 1.5;
  double tolerance = 1e-3;  // of a step, in the parameters' own standard errors
  double min_fall = 0.02;   // of the cost in an iteration: evidences that differ by less are not told apart
  int max_iterations = 12;
};

// How a campaign is prepared: see prepared_campaign.h.
struct PreparationOptions {
  // The suspension's own stance is believed unless the recorded attitudes lie nearer to the plane under the
  // wheels, their root mean square being less than this share of the suspension's.
  double plane_is_nearer = 0.8;
  int scatter_rounds = 2;          // the scatter and the re-tuned parameters need each other
  int max_observations = 120'000;  // about 1 GB of columns; more are refused, with how to thin them
};

// The discrepancy term: what could be missing that the library has no name for. See discrepancy_term.h.
struct DiscrepancyOptions {
  // Sizes of the term as something else, in units of its columns: weak, plain, strong; a factor of three
  // apart, so that the best of them is never far off. The evidence is averaged over them.
  std::array<double, 3> sizes{0.4, 1.2, 3.6};
  // How probable it is that something else enters at one point by one circumstance, and not at all points by
  // all of them at once: most that goes wrong with a rover does one thing.
  double single_share = 0.5;
  // No simulator is exact: the term stands beside every explanation up to this size, and only more than that
  // is something else.
  double imprecision = 0.1;
  std::array<double, 3> imprecision_shares{0.1, 0.3, 1.0};  // of `imprecision` that are averaged over
  // That an effect is at work does not say that its equation is the library's: what it does may be off by
  // this share, differently by circumstance, by channel, and by channel at each axle.
  double form_imprecision = 0.3;
  std::array<double, 3> form_sizes{0.0, 0.3, 1.0};  // of `form_imprecision` that are averaged over
  // What one unit of each column is: an error of that entry that would matter to a planner.
  double tilt_deg = 1.0;  // of the direction under which weights act: a force along or across
  double load_shift_m = 0.05;
  double steering_deg = 1.0;
  double slip_reading = 0.03;
  double side_slip_reading = 0.02;
  double yaw_rate_rad_s = 0.001;
  double attitude_rad = 0.01;
  double current_share = 0.05;  // of the predicted current
  double sinkage_m = 0.002;
  // What a circumstance is divided by, so that it is about 1 where drives are harsh.
  double pitch_deg = 10.0;
  double roll_deg = 10.0;
  double slip = 0.2;
  double curvature_1_m = 0.4;
  double temperature_c = 30.0;
};

// Where softer ground could lie: see soft_patch_search.h.
struct SoftPatchOptions {
  std::array<double, 7> radii_m{0.75, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0};  // from a wheel base to a crater
  int max_patches = 3;    // that compete: more would be one place said several times
  double min_rise = 0.1;  // of the log evidence, for which a disc is moved or resized
};

// Which effects are fitted, and which of their sets compete: see explanation_search.h.
struct SearchOptions {
  std::vector<std::string> withheld;  // effects that are not looked for
  int max_refitted = 16;              // effects that are fitted in full, which costs most
  int max_variants = 2;               // of each of them
  int max_paired = 4;                 // of those, whose pairs are looked for
  int max_seconds = 3;                // of each of those
  double min_pair_gain = 1.0;         // that a second effect promises by its derivatives, or it is not fitted
  // Prior deviations: re-tuned parameters that had to go this far are no point from which effects look
  // linear, so that effects are screened at the nominal parameters too.
  double max_linear_shift = 2.5;
  // A fit that would stay this much log evidence behind the best one is given up.
  double max_behind = 50.0;
  // Log evidence behind the best, from which a fit is not started again at what was believed of the soils,
  // and no better place of an effect is looked for beside its own scatter: 12 % of it are believed at least.
  double out_of_reach = 500.0;
  // An effect smaller than this share of its usual size (the deviation of its prior) is not worth a name: it
  // is how one simulator's numerics differ from another's. At 0.4 a wheel that drags at half its usual size
  // lost its name.
  double min_named_size = 0.3;
  bool something_else = true;   // the discrepancy term competes; without it for ablations
  bool outside = true;          // causes from outside compete (outside_cause.h); without them for ablations
  int max_outside = 4;          // causes from outside that are fitted in full
  int max_outside_seconds = 1;  // of them, beside each effect whose pairs are looked for
  int max_scattered = 6;  // explanations that are compared with the drives' own scatter beside each of them
  std::size_t threads = 0;
};

// With a first explanation found, the search is repeated under the scatter that it leaves, with less: what
// was far behind need not be fitted again.
struct SecondSearchOptions {
  int max_refitted = 6;
  int max_paired = 2;
  int max_seconds = 2;
  int max_kept = 6;  // sets that the first search found, fitted again from where they stood
};

// What is believed before the drives: that nothing is missing, that one effect is, two are, or something that
// the library does not have, of a known form or of none. A diagnosis is asked for where something seems to be
// wrong. They add up to 1 but for pairs beside something else.
struct PriorOptions {
  double nothing = 0.2;
  double one_effect = 0.39;     // shared by the effects of the library
  double two_effects = 0.132;   // shared by their pairs
  double something_else = 0.1;  // of no known form; beside effects as often
  double one_outside = 0.1;     // shared by the causes from outside; beside an effect as often
  // Of a cause from outside that no drive tells from an effect of the library: its part of what the others
  // have.
  double twin_share = 0.1;
};

// How much of the log evidence is believed, since no simulator is exact: see posterior.h.
struct EvidenceOptions {
  double share = 0.3;
};

// Which explanations resampled drives choose among: see selection.h.
struct SelectionOptions {
  double min_running = 0.01;  // least probability
  int max_running = 6;
};

// What the answer is decided by: see decision.h. The losses count in units of a missed name.
struct DecisionOptions {
  int min_drives = 3;         // fewer say nothing of what differs from drive to drive
  int min_windows = 6;        // fewer than parameters
  double wrong_name = 3.0;    // a team changes a model, or a rover, for a cause that is not there
  double missed_name = 1.0;   // the cause stays to be found
  double false_alarm = 1.0;   // something is said to be missing from a model that is right
  double missed_alarm = 1.0;  // a model that lacks something goes on planning
  // Probability of a conflict with what was believed, and of what is left over on drives held out, below
  // which the wheel model is not adequate.
  double conflict = 1e-4;
};

// What is told beside the verdict.
struct DescriptionOptions {
  double surely_seen = 6.0;        // standard errors with which an effect would surely have been seen
  double determined_share = 0.7;   // of a prior deviation, below which drives determine a parameter
  double max_angle_deg = 30.0;     // between signatures of effects that are hard to tell apart
  double min_signature = 1.0;      // deviations, of signatures that are compared
  int max_unexplained_shapes = 5;  // parts of what is unexplained that are described
};

// Predictions of drives that a fit has not seen: see gap_closure.h.
struct HeldOutOptions {
  int max_iterations = 4;  // of fits to folds, which begin at the answer of all drives
  // A corrected model is offered where no channel is predicted worse by it than by the nominal one, this many
  // times.
  double no_worse = 1.02;
  double clearly_more_slip = 0.05;  // between drives' mean slips that a planner could rank
};

// Harsh drives predicted from gentle ones: see extrapolation.h.
struct ExtrapolationOptions {
  double learnt_quantile = 2.0 / 3.0;  // of the groups of drives by harshness; those beyond are predicted
  int min_groups = 4;                  // of drives that are predicted, for a standard error
  // Ranges over a campaign below which nothing is extrapolated.
  double min_slope_range_deg = 5.0;
  double min_temperature_range_c = 20.0;
  double min_speed_range_m_s = 0.02;
};

// Slices that a gap is looked for in: see slices.h.
struct SliceOptions {
  int min_windows = 3;
  int min_one_in = 20;      // a slice has one in so many windows at least; fewer are single events
  double max_share = 0.75;  // of the windows: nearly all of them are no place
  int pieces = 5;           // that a variable is cut into
  int max_values = 6;       // a variable with no more values is cut at them
};

// Where the gap is: see localise.h and regimes.h.
struct LocationOptions {
  double max_significance = 0.1;  // p of a regime, corrected for all slices
  double min_trace_share = 0.1;   // of a trace that a channel has, for regimes in it
  // Squared deviations: windows further off than all others weigh no more than the next, for a window that a
  // model calls stuck is a hundred deviations off and would outweigh all.
  double plainly_off = 100.0;
  int resamples_per_permutation = 4;  // one permutation costs as much as all slices
  int max_regimes = 5;
  double slope_scale_deg = 10.0;  // what a channel's bias may go with: see channel_gaps
  double temperature_scale_c = 30.0;
  std::array<double, 2> place_radii_m{1.5, 3.0};
  double max_place_significance = 0.05;
  int min_place_windows = 3;
  int min_place_drives = 2;  // a place is one that several drives met
  int max_place_one_in = 3;  // of windows: it is not where they all are
  int max_places = 5;
};

// Drives that would tell the explanations apart: see next_drives.h.
struct NextDriveOptions {
  std::array<double, 4> tilts_deg{0.0, 5.0, 10.0, 15.0};
  std::array<double, 3> headings_deg{0.0, 90.0, 180.0};  // from straight uphill
  std::array<double, 3> speed_shares{1.0, 0.5, -1.0};    // of the rover's cruise speed
  std::array<double, 2> curvatures_1_m{0.0, 0.3};
  std::array<double, 2> temperatures_c{20.0, -40.0};
  // The least error that one drive leaves in a channel, whatever the scatter that was found.
  double min_slip_error = 0.01;
  double min_side_slip_error = 0.01;
  double min_yaw_rate_error_rad_s = 3e-4;
  double min_current_error_a = 0.003;
  double min_sinkage_error_m = 0.001;
  int max_explanations = 4;         // that drives are to tell apart
  int max_drives = 3;               // that are proposed
  double min_bits = 1e-3;           // below which no drive is proposed
  double min_tilt_apart_deg = 6.0;  // between proposed drives that are otherwise alike
};

// What drives that are taken as healthy teach of those that follow: see reference_learning.h.
struct ReferenceOptions {
  // Deviations that a coefficient of the smooth difference may have, in its channel's unit, and 0: see
  // believed_sizes.
  std::array<double, 5> sizes{0.03, 0.1, 0.3, 1.0, 3.0};
  // Beyond what the reference met, where nothing was learnt: the deviation of the difference for each 10 deg
  // of slope or 0.2 of slip, of what another simulator may be off by (half of a current, 0.2 of slip).
  double beyond = 1.0;
  // Prior deviations by which soils, closures and motors may have drifted since: ground is not the same
  // twice.
  double drift = 0.2;
  // Of the logarithms of the drives' scatter: by a third it may be another one now.
  double noise_std = 0.3;
  int min_drives =
      1;  // of those that follow; fewer than without, since the reference told what they scatter by
  int min_windows = 2;
  int rounds = 2;          // parameters and difference need each other
  int max_open = 120;      // directions in which the difference is left open: those of most effect
  double min_open = 0.01;  // squared deviations in all, below which a direction is none
  // Of EvidenceOptions::share, with a reference: what it taught on its own drives counts as evidence on
  // others, and is less to be believed there.
  double evidence_share = 0.4;
};

struct DiagnosisOptions {
  WindowOptions windows;
  NoiseOptions noise;
  PreparationOptions preparation;
  FitOptions fit;
  DiscrepancyOptions discrepancy;
  SoftPatchOptions soft_patch;
  SearchOptions search;
  SecondSearchOptions second_search;
  PriorOptions priors;
  EvidenceOptions evidence;
  SelectionOptions selection;
  DecisionOptions decision;
  DescriptionOptions description;
  HeldOutOptions held_out;
  ExtrapolationOptions extrapolation;
  SliceOptions slices;
  LocationOptions location;
  NextDriveOptions next_drives;
  ReferenceOptions reference;
  std::uint64_t seed = 1;
  // An oracle's: what is not withheld is at work, all of it (see fit_given_explanation).
  bool given = false;
  int folds = 5;
  int resamples = 400;  // of bootstraps and permutations
};

// One field, under its name in these structs: "fit", "huber", {4}. A list has more values than one or is
// marked as one.
struct ListedOption {
  std::string_view step, name;
  std::vector<double> values;
  bool list = false;
};
// All fields but the effects that were withheld, the seed and the number of threads; steps together.
std::vector<ListedOption> listed_options(const DiagnosisOptions& options);

}  // namespace slipway::gap
