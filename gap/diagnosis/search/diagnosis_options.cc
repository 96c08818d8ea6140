#include "gap/diagnosis/search/diagnosis_options.h"

#include <type_traits>

namespace slipway::gap {
namespace {

// Collects the fields of one step after the other.
class Lister {
 public:
  void step(std::string_view name) { step_ = name; }

  template <class Number>
  requires std::is_arithmetic_v<Number>
  void field(std::string_view name, Number value) {
    rows_.push_back({step_, name, {static_cast<double>(value)}, false});
  }
  template <std::size_t Count>
  void field(std::string_view name, const std::array<double, Count>& values) {
    rows_.push_back({step_, name, {values.begin(), values.end()}, true});
  }
  std::vector<ListedOption> take() { return std::move(rows_); }

 private:
  std::string_view step_;
  std::vector<ListedOption> rows_;
};

// Structured bindings name every field of a struct: one that is added and not listed does not compile.
#define SLIPWAY_FIELD(name) list.field(#name, name)

void list_windows(const WindowOptions& options, Lister& list) {
  list.step("windows");
  // The last two are found in the campaign's own readings.
  const auto& [length_m, turn_rad, stations, outlier, outlier_neighbours, pause_share,
               currents_in_sense_of_rate, currents_split_evenly] = options;
  static_cast<void>(currents_in_sense_of_rate);
  static_cast<void>(currents_split_evenly);
  SLIPWAY_FIELD(length_m);
  SLIPWAY_FIELD(turn_rad);
  SLIPWAY_FIELD(stations);
  SLIPWAY_FIELD(outlier);
  SLIPWAY_FIELD(outlier_neighbours);
  SLIPWAY_FIELD(pause_share);
  list.field("censored_slip", kCensoredSlip);
}

void list_noise(const NoiseOptions& options, Lister& list) {
  list.step("noise");
  const auto& [initial, prior_std, censored_slip_std] = options;
  const auto& [stiffness, friction, shear_modulus, within_drives, lean_rad, load_shift_m, slip, side_slip,
               yaw_rate_rad_s, attitude_rad, current_share, sinkage_m] = initial;
  SLIPWAY_FIELD(stiffness);
  SLIPWAY_FIELD(friction);
  SLIPWAY_FIELD(shear_modulus);
  SLIPWAY_FIELD(within_drives);
  SLIPWAY_FIELD(lean_rad);
  SLIPWAY_FIELD(load_shift_m);
  SLIPWAY_FIELD(slip);
  SLIPWAY_FIELD(side_slip);
  SLIPWAY_FIELD(yaw_rate_rad_s);
  SLIPWAY_FIELD(attitude_rad);
  SLIPWAY_FIELD(current_share);
  SLIPWAY_FIELD(sinkage_m);
  SLIPWAY_FIELD(prior_std);
  SLIPWAY_FIELD(censored_slip_std);
}

void list_preparation(const PreparationOptions& options, Lister& list) {
  list.step("preparation");
  const auto& [plane_is_nearer, scatter_rounds, max_observations] = options;
  SLIPWAY_FIELD(plane_is_nearer);
  SLIPWAY_FIELD(scatter_rounds);
  SLIPWAY_FIELD(max_observations);
}

void list_fit(const FitOptions& options, Lister& list) {
  list.step("fit");
  const auto& [huber, no_answer, both_stuck, stronger_friction, tolerance, min_fall, max_iterations] =
      options;
  SLIPWAY_FIELD(huber);
  SLIPWAY_FIELD(no_answer);
  SLIPWAY_FIELD(both_stuck);
  SLIPWAY_FIELD(stronger_friction);
  SLIPWAY_FIELD(tolerance);
  SLIPWAY_FIELD(min_fall);
  SLIPWAY_FIELD(max_iterations);
}

void list_discrepancy(const DiscrepancyOptions& options, Lister& list) {
  list.step("discrepancy");
  const auto& [sizes, single_share, imprecision, imprecision_shares, form_imprecision, form_sizes, tilt_deg,
               load_shift_m, steering_deg, slip_reading, side_slip_reading, yaw_rate_rad_s, attitude_rad,
               current_share, sinkage_m, pitch_deg, roll_deg, slip, curvature_1_m, temperature_c] = options;
  SLIPWAY_FIELD(sizes);
  SLIPWAY_FIELD(imprecision);
  SLIPWAY_FIELD(single_share);
  SLIPWAY_FIELD(imprecision_shares);
  SLIPWAY_FIELD(form_imprecision);
  SLIPWAY_FIELD(form_sizes);
  SLIPWAY_FIELD(tilt_deg);
  SLIPWAY_FIELD(load_shift_m);
  SLIPWAY_FIELD(steering_deg);
  SLIPWAY_FIELD(slip_reading);
  SLIPWAY_FIELD(side_slip_reading);
  SLIPWAY_FIELD(yaw_rate_rad_s);
  SLIPWAY_FIELD(attitude_rad);
  SLIPWAY_FIELD(current_share);
  SLIPWAY_FIELD(sinkage_m);
  SLIPWAY_FIELD(pitch_deg);
  SLIPWAY_FIELD(roll_deg);
  SLIPWAY_FIELD(slip);
  SLIPWAY_FIELD(curvature_1_m);
  SLIPWAY_FIELD(temperature_c);
}

void list_soft_patch(const SoftPatchOptions& options, Lister& list) {
  list.step("soft_patch");
  const auto& [radii_m, max_patches, min_rise] = options;
  SLIPWAY_FIELD(radii_m);
  SLIPWAY_FIELD(max_patches);
  SLIPWAY_FIELD(min_rise);
}

void list_search(const SearchOptions& options, Lister& list) {
  list.step("search");
  const auto& [withheld, max_refitted, max_variants, max_paired, max_seconds, min_pair_gain, max_linear_shift,
               max_behind, out_of_reach, min_named_size, something_else, outside, max_outside,
               max_outside_seconds, max_scattered, threads] = options;
  static_cast<void>(withheld);
  static_cast<void>(threads);
  SLIPWAY_FIELD(max_refitted);
  SLIPWAY_FIELD(max_variants);
  SLIPWAY_FIELD(max_paired);
  SLIPWAY_FIELD(max_seconds);
  SLIPWAY_FIELD(min_pair_gain);
  SLIPWAY_FIELD(max_linear_shift);
  SLIPWAY_FIELD(max_behind);
  SLIPWAY_FIELD(out_of_reach);
  SLIPWAY_FIELD(min_named_size);
  SLIPWAY_FIELD(something_else);
  SLIPWAY_FIELD(outside);
  SLIPWAY_FIELD(max_outside);
  SLIPWAY_FIELD(max_outside_seconds);
  SLIPWAY_FIELD(max_scattered);
}

void list_second_search(const SecondSearchOptions& options, Lister& list) {
  list.step("second_search");
  const auto& [max_refitted, max_paired, max_seconds, max_kept] = options;
  SLIPWAY_FIELD(max_refitted);
  SLIPWAY_FIELD(max_paired);
  SLIPWAY_FIELD(max_seconds);
  SLIPWAY_FIELD(max_kept);
}

void list_priors(const PriorOptions& options, Lister& list) {
  list.step("priors");
  const auto& [nothing, one_effect, two_effects, something_else, one_outside, twin_share] = options;
  SLIPWAY_FIELD(nothing);
  SLIPWAY_FIELD(one_effect);
  SLIPWAY_FIELD(two_effects);
  SLIPWAY_FIELD(something_else);
  SLIPWAY_FIELD(one_outside);
  SLIPWAY_FIELD(twin_share);
}

void list_evidence(const EvidenceOptions& options, Lister& list) {
  list.step("evidence");
  const auto& [share] = options;
  SLIPWAY_FIELD(share);
}

void list_selection(const SelectionOptions& options, Lister& list) {
  list.step("selection");
  const auto& [min_running, max_running] = options;
  SLIPWAY_FIELD(min_running);
  SLIPWAY_FIELD(max_running);
}

void list_decision(const DecisionOptions& options, Lister& list) {
  list.step("decision");
  const auto& [min_drives, min_windows, wrong_name, missed_name, false_alarm, missed_alarm, conflict] =
      options;
  SLIPWAY_FIELD(min_drives);
  SLIPWAY_FIELD(min_windows);
  SLIPWAY_FIELD(wrong_name);
  SLIPWAY_FIELD(missed_name);
  SLIPWAY_FIELD(false_alarm);
  SLIPWAY_FIELD(missed_alarm);
  SLIPWAY_FIELD(conflict);
}

void list_description(const DescriptionOptions& options, Lister& list) {
  list.step("description");
  const auto& [surely_seen, determined_share, max_angle_deg, min_signature, max_unexplained_shapes] = options;
  SLIPWAY_FIELD(surely_seen);
  SLIPWAY_FIELD(determined_share);
  SLIPWAY_FIELD(max_angle_deg);
  SLIPWAY_FIELD(min_signature);
  SLIPWAY_FIELD(max_unexplained_shapes);
}

void list_held_out(const HeldOutOptions& options, Lister& list) {
  list.step("held_out");
  const auto& [max_iterations, no_worse, clearly_more_slip] = options;
  SLIPWAY_FIELD(max_iterations);
  SLIPWAY_FIELD(no_worse);
  SLIPWAY_FIELD(clearly_more_slip);
}

void list_extrapolation(const ExtrapolationOptions& options, Lister& list) {
  list.step("extrapolation");
  const auto& [learnt_quantile, min_groups, min_slope_range_deg, min_temperature_range_c,
               min_speed_range_m_s] = options;
  SLIPWAY_FIELD(learnt_quantile);
  SLIPWAY_FIELD(min_groups);
  SLIPWAY_FIELD(min_slope_range_deg);
  SLIPWAY_FIELD(min_temperature_range_c);
  SLIPWAY_FIELD(min_speed_range_m_s);
}

void list_slices(const SliceOptions& options, Lister& list) {
  list.step("slices");
  const auto& [min_windows, min_one_in, max_share, pieces, max_values] = options;
  SLIPWAY_FIELD(min_windows);
  SLIPWAY_FIELD(min_one_in);
  SLIPWAY_FIELD(max_share);
  SLIPWAY_FIELD(pieces);
  SLIPWAY_FIELD(max_values);
}

void list_location(const LocationOptions& options, Lister& list) {
  list.step("location");
  const auto& [max_significance, min_trace_share, plainly_off, resamples_per_permutation, max_regimes,
               slope_scale_deg, temperature_scale_c, place_radii_m, max_place_significance, min_place_windows,
               min_place_drives, max_place_one_in, max_places] = options;
  SLIPWAY_FIELD(max_significance);
  SLIPWAY_FIELD(min_trace_share);
  SLIPWAY_FIELD(plainly_off);
  SLIPWAY_FIELD(resamples_per_permutation);
  SLIPWAY_FIELD(max_regimes);
  SLIPWAY_FIELD(slope_scale_deg);
  SLIPWAY_FIELD(temperature_scale_c);
  SLIPWAY_FIELD(place_radii_m);
  SLIPWAY_FIELD(max_place_significance);
  SLIPWAY_FIELD(min_place_windows);
  SLIPWAY_FIELD(min_place_drives);
  SLIPWAY_FIELD(max_place_one_in);
  SLIPWAY_FIELD(max_places);
}

void list_next_drives(const NextDriveOptions& options, Lister& list) {
  list.step("next_drives");
  const auto& [tilts_deg, headings_deg, speed_shares, curvatures_1_m, temperatures_c, min_slip_error,
               min_side_slip_error, min_yaw_rate_error_rad_s, min_current_error_a, min_sinkage_error_m,
               max_explanations, max_drives, min_bits, min_tilt_apart_deg] = options;
  SLIPWAY_FIELD(tilts_deg);
  SLIPWAY_FIELD(headings_deg);
  SLIPWAY_FIELD(speed_shares);
  SLIPWAY_FIELD(curvatures_1_m);
  SLIPWAY_FIELD(temperatures_c);
  SLIPWAY_FIELD(min_slip_error);
  SLIPWAY_FIELD(min_side_slip_error);
  SLIPWAY_FIELD(min_yaw_rate_error_rad_s);
  SLIPWAY_FIELD(min_current_error_a);
  SLIPWAY_FIELD(min_sinkage_error_m);
  SLIPWAY_FIELD(max_explanations);
  SLIPWAY_FIELD(max_drives);
  SLIPWAY_FIELD(min_bits);
  SLIPWAY_FIELD(min_tilt_apart_deg);
}

void list_reference(const ReferenceOptions& options, Lister& list) {
  list.step("reference");
  const auto& [sizes, beyond, drift, noise_std, min_drives, min_windows, rounds, max_open, min_open,
               evidence_share] = options;
  SLIPWAY_FIELD(sizes);
  SLIPWAY_FIELD(beyond);
  SLIPWAY_FIELD(drift);
  SLIPWAY_FIELD(noise_std);
  SLIPWAY_FIELD(min_drives);
  SLIPWAY_FIELD(min_windows);
  SLIPWAY_FIELD(rounds);
  SLIPWAY_FIELD(max_open);
  SLIPWAY_FIELD(min_open);
  SLIPWAY_FIELD(evidence_share);
}

#undef SLIPWAY_FIELD

}  // namespace

std::vector<ListedOption> listed_options(const DiagnosisOptions& options) {
  const auto& [windows, noise, preparation, fit, discrepancy, soft_patch, search, second_search, priors,
               evidence, selection, decision, description, held_out, extrapolation, slices, location,
               next_drives, reference, seed, given, folds, resamples] = options;
  static_cast<void>(seed);
  Lister list;
  list_windows(windows, list);
  list_noise(noise, list);
  list_preparation(preparation, list);
  list_fit(fit, list);
  list_discrepancy(discrepancy, list);
  list_soft_patch(soft_patch, list);
  list_search(search, list);
  list_second_search(second_search, list);
  list_priors(priors, list);
  list_evidence(evidence, list);
  list_selection(selection, list);
  list_decision(decision, list);
  list_description(description, list);
  list_held_out(held_out, list);
  list_extrapolation(extrapolation, list);
  list_slices(slices, list);
  list_location(location, list);
  list_next_drives(next_drives, list);
  list_reference(reference, list);
  list.step("run");
  list.field("given", given);
  list.field("folds", folds);
  list.field("resamples", resamples);
  return list.take();
}

}  // namespace slipway::gap
