#include "gap/diagnosis/doubts.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "gap/diagnosis/held_out/effect_marginals.h"
#include "gap/diagnosis/model/nuisance_catalogue.h"
#include "gap/diagnosis/naming.h"
#include "gap/diagnosis/verdict.h"

namespace slipway::gap {
namespace {

// The channel of which most is left over its floor, where that is too much; nothing else. Attitudes do not
// count: how a rover leans as its wheels sink is in no model here.
std::optional<std::string> gap_left(const Diagnosis& d, const VerdictOptions& options) {
  double most = d.effects.empty() ? options.max_left_of_nothing : options.max_left_beside_effects;
  std::optional<std::string> words;
  for (const ChannelClosure& c : d.gap) {
    if (row_of(c.channel).of_the_stance) continue;
    const double floor = c.noise_floor.value;
    if (c.with_effects.low <= most * floor) continue;
    if (!d.effects.empty() &&
        c.retuned.value - c.with_effects.value >= options.forgiven_closure * (c.retuned.value - floor))
      continue;
    most = c.with_effects.low / floor;
    words = fmt::format("on drives held out of the fit {} is {:.1f} times its floor off (at least {:.1f})",
                        name_of(c.channel), c.with_effects.value / floor, most);
  }
  return words;
}

// Whether both ends of what a parameter may be are far from what was believed of it. An end near that says
// nothing: with a reference the parameter may lie there.
bool has_far_ends(const Parameter& parameter) {
  constexpr double kFarEnd = 4.0;  // deviations
  return parameter.lowest < parameter.neutral - kFarEnd * parameter.std &&
         parameter.neutral + kFarEnd * parameter.std < parameter.highest;
}

// In usual ones: soil that was measured well is bent by another equation as far as any.
double deviations_of(const FittedExplanation& reported, std::size_t p) {
  const Parameter& parameter = reported.hypothesis.parameters()[p];
  return (reported.x[p] - parameter.neutral) / parameter.usual_std;
}

// A parameter that the answer needs at one of its two ends.
std::optional<std::string> parameter_at_its_end(const FittedExplanation& reported) {
  for (std::size_t p = 0; p < reported.hypothesis.nuisance_count(); ++p) {
    const Parameter& parameter = reported.hypothesis.parameters()[p];
    if (has_far_ends(parameter) && (reported.x[p] <= parameter.lowest || reported.x[p] >= parameter.highest))
      return fmt::format(
          "{} would have to be further from what was believed than it may be ({:.1f} deviations)",
          parameter.name, std::abs(deviations_of(reported, p)));
  }
  return std::nullopt;
}

// Whether an effect that acts at a place is named: a patch is told from other causes by its place, and its
// rim bends the soil around it.
bool names_a_place(std::span<const std::string> effects) {
  return std::any_of(effects.begin(), effects.end(), acts_at_a_place);
}

// The soil that lies furthest from what was believed of it, where that is too far to name effects beside it.
// With a reference, which ties the parameters to each other, nothing.
std::optional<std::string> soil_beyond_belief(const FittedExplanation& reported,
                                              std::span<const std::string> effects,
                                              const VerdictOptions& options) {
  const Hypothesis& hypothesis = reported.hypothesis;
  if (effects.empty() || names_a_place(effects) || hypothesis.prior_precision().size() > 0)
    return std::nullopt;
  struct Shift {
    double square = 0.0, most = 0.0;
    std::string of;  // the parameter that is furthest off
  };
  std::map<int, Shift> shift_of;  // by soil; -1: the ratio of the moduli, which is that of all
  for (std::size_t p = 0; p < hypothesis.nuisance_count(); ++p) {
    const Parameter& parameter = hypothesis.parameters()[p];
    if (parameter.soil < 0 && parameter.name != kLateralShearModulus) continue;
    const double deviations = deviations_of(reported, p);
    Shift& shift = shift_of[parameter.soil];
    shift.square += deviations * deviations;
    if (std::abs(deviations) >= std::abs(shift.most)) shift.most = deviations, shift.of = parameter.name;
  }
  const Shift ratio = shift_of[-1];
  shift_of.erase(-1);
  Shift furthest;
  for (const auto& [soil, shift] : shift_of)
    if (shift.square >= furthest.square) furthest = shift;
  const double deviations = std::sqrt(furthest.square + ratio.square);
  if (deviations <= options.max_soil_shift) return std::nullopt;
  const Shift& most = std::abs(ratio.most) > std::abs(furthest.most) ? ratio : furthest;
  return fmt::format("the soil would be {:.1f} deviations from what was believed of it ({} alone {:+.1f})",
                     deviations, most.of, most.most);
}

std::optional<std::string> closure_beyond_belief(const FittedExplanation& fit,
                                                 const VerdictOptions& options) {
  const ClosureShift furthest = furthest_closure(fit);
  if (std::abs(furthest.deviations) <= options.max_closure_shift) return std::nullopt;
  return fmt::format("{} would be {:+.1f} deviations from what was believed of it", furthest.closure,
                     furthest.deviations);
}

std::optional<std::string> little_closed(const ReportedAnswer& answer, const Diagnosis& d,
                                         const VerdictOptions& options) {
  if (!options.name_by_marginals || d.effects.empty() || answer.log_evidence < options.strong_evidence ||
      answer.closed_share >= options.min_named_share)
    return std::nullopt;
  return fmt::format(
      "what fits them best (log evidence +{:.0f}) closes {:.0f} % of the gap on drives held out of "
      "the fit",
      answer.log_evidence, 100.0 * answer.closed_share);
}

double unknown_probability(const Diagnosis& d) {
  double sum = 0.0;
  for (const ComparedSet& c : d.candidates)
    if (c.with_unknown) sum += c.probability;
  return sum;
}

std::vector<std::string> named(const Diagnosis& d) {
  std::vector<std::string> names;
  for (const FoundEffect& effect : d.effects) names.push_back(effect.name);
  return names;
}

// No effect is named: what drives look like with the effects is what they look like re-tuned.
void withdraw_effects(Diagnosis& d) {
  d.effects.clear();
  for (ChannelClosure& c : d.gap) c.with_effects = c.retuned;
  for (HeldOutPoint& point : d.held_out) point.with_effects = point.retuned;
  for (WindowGap& window : d.window_gaps) window.with_effects = window.retuned;
  d.planners_view.with_effects = d.planners_view.retuned;
}

// Marginal probabilities after those of the sets have changed.
void take_marginals_anew(Diagnosis& d) {
  for (EffectMarginal& m : d.marginals) m.probability = marginal_probability(d.candidates, m.name);
  std::stable_sort(
      d.marginals.begin(), d.marginals.end(),
      [](const EffectMarginal& a, const EffectMarginal& b) { return a.probability > b.probability; });
  for (FoundEffect& effect : d.effects) effect.probability = marginal_probability(d.candidates, effect.name);
}

// Whether effects are named and this holds of each.
template <class Holds>
bool of_each_named(const Diagnosis& d, const VerdictOptions& options, const Holds& holds) {
  return options.name_by_marginals && !d.effects.empty() &&
         std::all_of(d.effects.begin(), d.effects.end(),
                     [&](const FoundEffect& effect) { return holds(marginal_of(d.marginals, effect.name)); });
}

// Whether each is more probable than not, and no other wheel law; where other sets were alike, whether each
// is in nearly all of them.
bool all_probable(const Diagnosis& d, const VerdictOptions& options) {
  const double least =
      d.verdict == Verdict::kEffects ? options.min_probability_closing_most : options.min_partial_probability;
  return of_each_named(d, options, [&](const EffectMarginal& m) {
    return m.probability >= least && !may_be_wheel_law(m.name);
  });
}

// Something unknown gets VerdictOptions::min_doubt of the probability, where it was compared and has less.
void raise_unknown(const VerdictOptions& options, Diagnosis& d) {
  const double unknown = unknown_probability(d);
  if (unknown > 0.0 && unknown < options.min_doubt)
    for (ComparedSet& c : d.candidates)
      c.probability *=
          c.with_unknown ? options.min_doubt / unknown : (1.0 - options.min_doubt) / (1.0 - unknown);
  std::stable_sort(d.candidates.begin(), d.candidates.end(),
                   [](const ComparedSet& a, const ComparedSet& b) { return a.probability > b.probability; });
  take_marginals_anew(d);
}

// A doubt against which those of the named effects stand of which this holds.
template <class Stands>
Doubt doubt_against(const Diagnosis& d, const std::string& why, bool of_a_gap, const Stands& stands) {
  Doubt doubt{.why = why, .of_a_gap = of_a_gap, .standing = {}, .fallen = {}};
  for (const std::string& name : named(d)) (stands(name) ? doubt.standing : doubt.fallen).push_back(name);
  return doubt;
}

}  // namespace

ClosureShift furthest_closure(const FittedExplanation& fit) {
  ClosureShift furthest;
  for (std::size_t p = 0; p < fit.hypothesis.nuisance_count(); ++p) {
    const Parameter& parameter = fit.hypothesis.parameters()[p];
    if (parameter.kind != NuisanceKind::kClosure || !has_far_ends(parameter)) continue;
    const double deviations = deviations_of(fit, p);
    if (std::abs(deviations) > std::abs(furthest.deviations)) furthest = {parameter.name, deviations};
  }
  return furthest;
}

std::optional<std::string> beyond_belief(const FittedExplanation& fit, std::span<const std::string> effects,
                                         const VerdictOptions& options) {
  const std::optional<std::string> closure = closure_beyond_belief(fit, options);
  return closure ? closure : soil_beyond_belief(fit, effects, options);
}

std::optional<std::string> scatter_beyond_belief(const std::optional<ScaleOffBelief>& scatter,
                                                 const VerdictOptions& options) {
  if (!scatter || scatter->deviations <= options.max_scatter) return std::nullopt;
  return fmt::format("{} would scatter by {:.0f} times what was believed", scatter->of, scatter->times);
}

void doubt_what_does_not_extrapolate(const VerdictOptions& options, Diagnosis& d) {
  if (d.verdict != Verdict::kEffects) return;
  for (const Extrapolation& e : d.extrapolations) {
    if (e.log_density_gain + options.beyond_chance * e.error >= 0.0) continue;
    d.verdict = Verdict::kEffectSet;
    d.reason += fmt::format(
        "; but learnt from the other drives it predicts those of {} {} {:.3g} worse than re-tuned "
        "parameters alone",
        e.variable, e.above ? "above" : "below", e.limit);
    return;
  }
}

void withdraw_what_tells_no_better(double log_density_gain, double log_evidence,
                                   const VerdictOptions& options, Diagnosis& d) {
  if (!names_effects(d.verdict) || d.partial || log_density_gain > 0.0) return;
  const bool is_strong = log_evidence >= options.strong_evidence;
  if (of_each_named(d, options, [&](const EffectMarginal& m) {
        return m.closed_share >= options.min_partial_share &&
               (is_strong || m.probability >= options.min_partial_probability);
      }))
    return;
  const std::vector<std::string> names = named(d);
  d.verdict = Verdict::kParameters;
  d.reason = fmt::format(
      "re-tuned soil and motor parameters tell drives held out of the fit as well as they do with {}, whose "
      "probability is {:.2f}: nothing is named (log density with it {:+.2g})",
      fmt::join(names, " and "), d.effects.front().probability, log_density_gain);
  d.overturned_by = kSameLook;
  withdraw_effects(d);
}

std::optional<Doubt> doubt_of(const ReportedAnswer& answer, const VerdictOptions& options,
                              const Diagnosis& d) {
  if (d.verdict == Verdict::kUnknown || d.verdict == Verdict::kInsufficient || d.partial ||
      unknown_probability(d) <= 0.0)
    return std::nullopt;
  const std::optional<std::string> bent = beyond_belief(answer.fit, named(d), options);
  const std::optional<std::string> scattered = scatter_beyond_belief(answer.scatter, options);
  const auto stands = [&](const std::string& name) {
    return options.name_by_marginals &&
           stands_beside_unknown(marginal_of(d.marginals, name), bent || scattered, options);
  };
  std::optional<std::string> left = gap_left(d, options);
  if (!left) left = parameter_at_its_end(answer.fit);
  if (left) return doubt_against(d, *left, true, stands);
  if (bent) return doubt_against(d, *bent, false, stands);
  if (const auto little = little_closed(answer, d, options))
    return doubt_against(d, *little, false, [](const std::string&) { return false; });
  if (!scattered) return std::nullopt;
  const bool all = all_probable(d, options) && answer.closed_share >= options.min_partial_share;
  return doubt_against(d, *scattered, false, [&](const std::string& name) { return all || stands(name); });
}

void apply_doubt(const Doubt& doubt, const VerdictOptions& options, Diagnosis& d) {
  // Names that stand keep their probability where the doubt is one of belief.
  if (doubt.of_a_gap || doubt.standing.empty()) raise_unknown(options, d);
  if (!doubt.fallen.empty())
    d.notes.push_back(fmt::format("{} would explain a part, and may be the unknown cause's shadow: {}",
                                  fmt::join(doubt.fallen, " and "),
                                  doubt.standing.empty() ? "nothing is named" : "not named"));
  d.overturned_by = kSameLook;
  if (!doubt.standing.empty()) {
    std::erase_if(d.effects, [&](const FoundEffect& effect) {
      return std::find(doubt.fallen.begin(), doubt.fallen.end(), effect.name) != doubt.fallen.end();
    });
    d.partial = true;
    d.verdict = Verdict::kEffects;
    d.reason = fmt::format("{}, and something unexplained remains beside it: {}",
                           closing_words(d, doubt.standing), doubt.why);
    return;
  }
  withdraw_effects(d);
  d.least_detectable.clear();
  d.verdict = Verdict::kUnknown;
  d.reason = fmt::format("{}: {}",
                         doubt.of_a_gap ? "a gap remains that no effect of the library explains"
                                        : "nothing in the library explains these drives believably",
                         doubt.why);
}

void doubt_readings(std::span<const std::string> implausible, const VerdictOptions& options, Diagnosis& d) {
  if (implausible.empty() || !finds_nothing_missing(d.verdict)) return;
  raise_unknown(options, d);
  d.least_detectable.clear();
  d.verdict = Verdict::kUnknown;
  d.reason = implausible.front();
  d.overturned_by = "readings in the units that the campaign states";
}

}  // namespace slipway::gap
