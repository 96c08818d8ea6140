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
  // and no better place of an effect is looked for beside its own scatter: 3 % of it are believed at least
  // (1.2 % with a reference).
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
  double nothing = 0.21;
  double one_effect = 0.395;   // shared by the effects of the library
  double two_effects = 0.131;  // shared by their pairs
  double something_else = 0.092;
  double one_outside = 0.092;  // shared by the causes from outside
  double one_and_something_else = 0.04;
  double one_and_one_outside = 0.04;
  // Of a cause from outside that no drive tells from an effect of the library: its part of what the others
  // have.
  double twin_share = 0.1;
  double pair_beside_something_else_log = -2.0;  // logarithm of its prior over that of the pair alone
};

// How much of the log evidence is believed, since no simulator is exact: with one share alone answers of
// "0.99" were wrong in one case of four on sealed campaigns; under the second share a set keeps some
// probability unless it is far behind. See weigh.
struct EvidenceShare {
  double share, weight;
};
struct EvidenceOptions {
  std::array<EvidenceShare, 2> shares{EvidenceShare{0.3, 0.85}, EvidenceShare{0.03, 0.15}};
  // That something is missing is believed by so many times the share that is believed of which it is:
  // simulators are further apart in what an effect looks like than in what drives without one look like.
  double of_missing = 4.0 / 3.0;
  bool whole = false;  // believed as it stands, for ablations
};

// Which of the compared sets the answer is: see selection.h.
struct SelectionOptions {
  double certain = 0.5;           // probability from which the first set is the answer whatever follows
  double unknown_majority = 0.5;  // of all sets with something else, beyond which one of them is the answer
  double simpler_share = 0.5;  // of the first set's probability, for which a smaller one of the same is taken
  // Of the probability of a cause from outside, with which another one is as probable: see best_form.
  double alike_form_share = 0.5;
  double min_running = 0.01;  // probability of sets that resamples choose among
  int max_running = 6;        // of them, at most
};

// What the chosen set means: see verdict.h.
struct VerdictOptions {
  int min_drives = 3;   // fewer say nothing of what differs from drive to drive
  int min_windows = 6;  // fewer than parameters
  // Gain of soils and motors being free over their being nominal, closures free in either case, beyond which
  // parameters are called mis-set.
  double min_parameters_gain = 20.0;
  double surely_seen = 6.0;       // standard errors that the believed share of the evidence asks for
  double small_effect = 0.5;      // of an effect's usual size: what drives should have shown
  double max_hidden_share = 0.5;  // of the variants that could have hidden at that size, for no gap
  double beyond_chance = 2.0;     // standard errors by which harsh drives are predicted worse
  // What may be left on held-out drives over the floor, nothing being named; and beside named effects, whose
  // equation may be another's.
  double max_left_of_nothing = 1.25;
  double max_left_beside_effects = 1.5;
  double forgiven_closure = 0.5;  // share of the channel's gap: effects that close so much may leave the rest
  // Prior deviations by which a scale of the drives' own scatter may be above what was believed of it,
  // without a reference (6.8 times); beyond them it hides something. Healthy campaigns came to 0.6 at most.
  double max_scatter = 1.6;
  // Of something of no known form, alone, the log evidence over nothing below which it may be chance.
  double min_unknown_evidence = 4.0;
  // The same of the probability of all that has something unknown. Of 1,458 answers to sealed campaigns 11
  // were `unknown` by less: 5 of healthy drives, 5 with an effect of the library, 1 with a cause from
  // outside.
  double min_unknown_probability = 0.6;
  // Share of the resampled campaigns that show nothing missing, beyond which named effects may be chance. Of
  // some 100 right answers to sealed campaigns none came to more than 0.08; drives on mis-set soils, with a
  // false name, came to 0.26.
  double max_nothing_share = 0.15;
  // Usual prior deviations by which a soil may be off what was believed of it beside named effects, all of
  // its parameters and the ratio of its shear moduli together, without a reference. A cause that the library
  // lacks bends soils to a name that is not its own; of 115 right answers 4 came to more, 3 of them a patch.
  // Six numbers that are believed as they should be come to more once in 9,000 times.
  double max_soil_shift = 5.25;
  // The same of a closure, whatever the answer: of c1 0.3, so that loose sand's 0.18 may be compact sand's
  // 0.43 [Wong and Reece 1967]. In 24 healthy campaigns none came to more than 1.1.
  double max_closure_shift = 6.0;
  // Of the probability of a set whose soil or closure is further off than that: a larger set of the same
  // effects that has as much, and beside which neither is, is the answer.
  double believable_share = 0.5;
  // How far off a closure may be beside which an effect is left out that closes little: beyond it, the
  // closure stands in for the effect. Where the effect was not there, closures of 11 sealed campaigns came
  // to 2.7 at most.
  double max_stand_in_shift = 4.0;
  double rival_share = 0.75;       // of the answer's probability: a rival with as much is alike
  double min_doubt = 0.9;          // probability of something unknown where an answer left a gap
  double determined_share = 0.7;   // of a prior deviation, below which drives determine a parameter
  double max_angle_deg = 30.0;     // between signatures of effects that are hard to tell apart
  double min_signature = 1.0;      // deviations, of signatures that are compared
  int max_unexplained_shapes = 5;  // parts of what is unexplained that are described
  bool name_by_marginals = true;   // see naming.h; without it an unknown cause hides all names
  double min_closed_share = 0.05;  // of the held-out gap: an effect with less is not named
  // The same of all that is named together. What closes less is something else where its logarithm of the
  // evidence over nothing is strong (the answer is `unknown`), and otherwise not worth a name: of three such
  // names on sealed campaigns one was right, and one was of a healthy campaign.
  double min_named_share = 0.1;
  double strong_evidence = 50.0;
  // Of what another law of ground or motors closes, the same of a second law, and of what acts at a place
  // beside a law of the ground: the square of DiscrepancyOptions::form_imprecision, by which the first one's
  // equation may be off.
  double min_share_of_law = 0.09;
  // The same of what another effect leaves, where one of the two has one form; see naming.h. An effect that
  // closes nearly all leaves little of the whole to close.
  double min_share_of_rest = 0.05;
  // Beside something unknown an effect is named from this marginal probability and this share on.
  double min_partial_probability = 0.9;
  double min_partial_share = 0.5;
  // What closes less, but min_certain_share, must be as good as certain where the rest has a known form: a
  // cause that the library lacks looks like an effect and a force beside it. Where it has none the effect
  // must be no law of all wheels, since another wheel law looks like several, and have strong_evidence over
  // the best explanation without it.
  double min_certain_probability = 0.99;
  double min_certain_share = 0.1;
  // Where the rest has a known form, of an effect that closes min_partial_share, or a law of all wheels that
  // closes as much of what that form leaves: what is more probable than not, and closes most, is named.
  double min_probability_closing_most = 0.5;
};

// Predictions of drives that a fit has not seen: see gap_closure.h.
struct HeldOutOptions {
  int max_iterations = 4;          // of fits to folds, which begin at the answer of all drives
  double min_chosen_share = 0.02;  // of resamples: sets that fewer choose are not fitted to folds
  // A re-tuned model beside something unknown is offered where no channel is predicted worse than by the
  // nominal one, this many times, and one is predicted better, by this factor.
  double no_worse = 1.02;
  double much_better = 0.8;
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
  // Of the held-out gap: VerdictOptions::min_closed_share with a reference. What other physics leaves of a
  // difference beyond what the reference met has closed a tenth at most, what has changed a third and more.
  double min_closed_share = 0.15;
  // At least this are VerdictOptions::max_left_of_nothing and max_left_beside_effects with a reference:
  // drives elsewhere meet what it was not taught on, and healthy ones on hills left 1.5 times their floor.
  double max_left = 2.0;
  // Of EvidenceOptions::shares, with a reference: what it taught on its own drives counts as evidence on
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
  VerdictOptions verdict;
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
