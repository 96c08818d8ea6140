#include "gap/diagnosis/verdict.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "gap/diagnosis/held_out/effect_marginals.h"
#include "gap/diagnosis/model/outside_cause.h"
#include "gap/diagnosis/search/selection.h"

namespace slipway::gap {
namespace {

constexpr std::string_view kSameLook =
    "an effect of the library with another equation than the library's would look the same";

// How much more probable the drives are when soils and motors may differ from the nominal ones, closures
// being free in either case.
double gain_of_parameters(const PreparedCampaign& prepared, const DriveCampaign& campaign,
                          const DiagnosisOptions& options) {
  const FittedExplanation& null = *prepared.null;
  const Hypothesis pinned(campaign, {}, FreeNuisances::kClosures);
  std::vector<double> start;
  for (const Parameter& closure : pinned.parameters())
    for (std::size_t p = 0; p < null.x.size(); ++p)
      if (null.hypothesis.parameters()[p].name == closure.name) start.push_back(null.x[p]);
  const FittedExplanation nominal =
      fit_explanation(pinned, *prepared.model, *prepared.noise, start, options.fit, options.search.threads);
  const auto evidence = [&](const FittedExplanation& fit) {
    const Eigen::MatrixXd no_form(fit.white_jacobian.rows(), 0);
    const DiscrepancyGain gain =
        discrepancy_gain(fit, whitened(fit, *prepared.noise, prepared.discrepancy), no_form,
                         options.discrepancy, [&] { return prepared.model->cancelled(); });
    return fit.log_evidence + gain.imprecision;
  };
  return evidence(null) - evidence(nominal);
}

ComparedSet compared(const Candidate& c) {
  ComparedSet set;
  set.effects = library_effects_of(c);
  set.with_unknown = c.unknown();
  if (c.outside) set.outside = outside_causes_of(c).front();
  return set;
}

// The most probable set that is not this one, if any.
const Candidate* rival_of(const ExplanationSearch& search, const Candidate& chosen) {
  const auto rival =
      std::find_if(search.candidates.begin(), search.candidates.end(), [&](const Candidate& c) {
        return library_effects_of(c) != library_effects_of(chosen) || c.unknown() != chosen.unknown();
      });
  return rival == search.candidates.end() ? nullptr : &*rival;
}

std::string next_best(const Candidate& rival) {
  const std::vector<std::string> names = names_of(compared(rival));
  return fmt::format("next best: {} (probability {:.2g})",
                     names.empty() ? "nothing missing" : fmt::format("{}", fmt::join(names, " and ")),
                     rival.probability);
}

// Nearly as probable, and no unknown cause.
bool alike(const Candidate* rival, double probability, const VerdictOptions& options) {
  return rival != nullptr && !rival->unknown() && rival->probability > options.rival_share * probability;
}

// Which probabilities belong to the same set, whatever the order of its effects.
using SetKey = std::pair<std::set<std::string>, bool>;
SetKey key_of(const Candidate& c) {
  const std::vector<std::string> effects = library_effects_of(c);
  return {{effects.begin(), effects.end()}, c.unknown()};
}

// The least size of each effect that these drives would surely have shown, of its first variant's first
// field.
std::vector<LeastDetectable> least_detectable_of(std::span<const ScreenedVariant> screened,
                                                 const VerdictOptions& options) {
  std::vector<LeastDetectable> least;
  for (const ScreenedVariant& s : screened) {
    if (s.visibility <= 0.0) continue;
    if (std::any_of(least.begin(), least.end(),
                    [&](const LeastDetectable& l) { return l.effect == s.variant.effect; }))
      continue;
    const EffectVariant::Free& free = s.variant.free.front();
    least.push_back({s.variant.effect, free.field, options.surely_seen * free.std / s.visibility});
  }
  return least;
}

void judge_without_effects(const DriveCampaign& campaign, const PreparedCampaign& prepared,
                           const ExplanationSearch& search, const Candidate& chosen, double probability,
                           const DiagnosisOptions& options, Diagnosis& d) {
  d.least_detectable = least_detectable_of(search.screened, options.verdict);
  const Candidate* const rival = rival_of(search, chosen);
  const auto or_rival = [&](std::string_view words) {
    return rival != nullptr ? fmt::format("{}; {}", words, next_best(*rival)) : std::string(words);
  };
  const double gain = gain_of_parameters(prepared, campaign, options);
  if (gain > options.verdict.min_parameters_gain) {
    d.verdict = Verdict::kParameters;
    d.reason = fmt::format(
        "re-tuned soil and motor parameters explain the drives (log evidence +{:.0f}); no effect is "
        "missing (probability {:.2f})",
        gain, probability);
    d.overturned_by = or_rival("an effect that acts like these parameters in every drive that was made");
    return;
  }
  d.overturned_by = or_rival("drives that show an effect below the least size that these could have shown");
  if (alike(rival, probability, options.verdict)) {
    d.verdict = Verdict::kNotDetected;
    d.reason = fmt::format("no gap was surely found (probability {:.2f}), but these drives leave more open",
                           probability);
  } else if (hidden_share(search.screened, options.verdict) < options.verdict.max_hidden_share) {
    d.verdict = Verdict::kNoGap;
    d.reason = fmt::format(
        "with parameters re-tuned within what was believed of them, prediction and drives agree within the "
        "drives' own scatter (probability {:.2f})",
        probability);
  } else {
    d.verdict = Verdict::kNotDetected;
    d.reason = "no gap was found, but these drives could not have shown effects of half their usual size";
  }
}

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

// A parameter that the answer needs at one of its two ends. An end near what was believed says nothing: with
// a reference it may lie there.
std::optional<std::string> parameter_at_its_end(const FittedExplanation& reported) {
  for (std::size_t p = 0; p < reported.hypothesis.nuisance_count(); ++p) {
    const Parameter& parameter = reported.hypothesis.parameters()[p];
    constexpr double kFarEnd = 2.0;  // deviations
    const bool two_sided = parameter.lowest < parameter.neutral - kFarEnd * parameter.std &&
                           parameter.neutral + kFarEnd * parameter.std < parameter.highest;
    if (two_sided && (reported.x[p] <= parameter.lowest || reported.x[p] >= parameter.highest))
      return fmt::format(
          "{} would have to be further from what was believed than it may be ({:.1f} deviations)",
          parameter.name, std::abs(reported.x[p] - parameter.neutral) / parameter.std);
  }
  return std::nullopt;
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

// The parameters of one of a fit's causes: what was estimated, and what was held.
std::vector<FoundParameter> parameters_of(const FittedExplanation& fit, std::size_t which, bool with_held) {
  const EffectVariant& variant = fit.hypothesis.effects()[which];
  const auto parameters = fit.hypothesis.parameters();
  std::vector<FoundParameter> found;
  for (std::size_t p = fit.hypothesis.nuisance_count(); p < parameters.size(); ++p)
    if (parameters[p].effect == variant.effect)
      found.push_back({parameters[p].name.substr(variant.effect.size() + 1), parameter_interval(fit, p)});
  if (with_held)
    for (const auto& [field, value] : variant.fixed) found.push_back({field, {value, value, value}});
  return found;
}

// The library's effects of the chosen explanation, with their parameters.
std::vector<FoundEffect> found_effects(const FittedExplanation& fit,
                                       const std::map<std::string, double>& probability_of) {
  std::vector<FoundEffect> all;
  const auto effects = fit.hypothesis.effects();
  for (std::size_t e = 0; e < effects.size(); ++e)
    if (find_outside(effects[e].effect) == nullptr)
      all.push_back({effects[e].effect, effects[e].label, probability_of.at(effects[e].effect),
                     parameters_of(fit, e, true)});
  return all;
}

// "dragging_wheel (0.999) closes 93 % of the gap"
std::string closing_words(const Diagnosis& d, std::span<const std::string> effects) {
  std::vector<std::string> each;
  for (const std::string& effect : effects)
    for (const EffectMarginal& m : d.marginals)
      if (m.name == effect)
        each.push_back(fmt::format("{} (probability {:.3f}) closes {:.0f} % of the gap", effect,
                                   m.probability, 100.0 * m.closed_share));
  return fmt::format("{}", fmt::join(each, ", "));
}

std::string remaining_words(const Diagnosis& d) {
  return d.outside ? fmt::format("{} (probability {:.2f})", d.outside->words, d.outside->probability)
                   : "something of no known form";
}

void judge_effects(const ExplanationSearch& search, const Naming& naming, double probability,
                   const DiagnosisOptions& options, Diagnosis& d) {
  const Candidate& chosen = search.candidates[naming.candidate];
  const Candidate* const rival = rival_of(search, chosen);
  if (naming.partial) {
    d.partial = true;
    d.verdict = Verdict::kEffects;
    d.reason = fmt::format("{}, and beside it remains unexplained: {}", closing_words(d, naming.effects),
                           remaining_words(d));
    d.overturned_by = kSameLook;
    return;
  }
  const bool certain =
      probability >= options.selection.certain && !alike(rival, probability, options.verdict);
  d.verdict = certain ? Verdict::kEffects : Verdict::kEffectSet;
  d.reason =
      fmt::format("{} explain{} what re-tuned parameters leave over (probability {:.2f})",
                  fmt::join(chosen.effects, " and "), chosen.effects.size() == 1 ? "s" : "", probability);
  if (rival != nullptr) d.overturned_by = next_best(*rival);
}

void judge_unknown(const ExplanationSearch& search, std::size_t best, double unknown, Diagnosis& d) {
  d.verdict = Verdict::kUnknown;
  d.reason =
      d.outside
          ? fmt::format("no effect of the library: {} (probability {:.2f}; something unknown {:.2f})",
                        d.outside->words, d.outside->probability, unknown)
          : fmt::format("a gap remains that no effect of the library explains (probability {:.2f})", unknown);
  d.overturned_by = kSameLook;
  const std::vector<std::string> beside = library_effects_of(search.candidates[best]);
  if (!beside.empty())
    d.notes.push_back(
        fmt::format("{} would fit beside what is unexplained, and may be its shadow: nothing is named",
                    fmt::join(beside, " and ")));
}

// Marginal probabilities after those of the sets have changed.
void take_marginals_anew(Diagnosis& d) {
  for (EffectMarginal& m : d.marginals) m.probability = marginal_probability(d.candidates, m.name);
  std::stable_sort(
      d.marginals.begin(), d.marginals.end(),
      [](const EffectMarginal& a, const EffectMarginal& b) { return a.probability > b.probability; });
  for (FoundEffect& effect : d.effects) effect.probability = marginal_probability(d.candidates, effect.name);
}

// Whether each named effect may stand beside something unknown.
bool all_stand(const Diagnosis& d, const VerdictOptions& options) {
  return options.name_by_marginals && !d.effects.empty() &&
         std::all_of(d.effects.begin(), d.effects.end(), [&](const FoundEffect& effect) {
           return std::any_of(d.marginals.begin(), d.marginals.end(), [&](const EffectMarginal& m) {
             return m.name == effect.name && stands_beside_unknown(m, options);
           });
         });
}

}  // namespace

Interval parameter_interval(const FittedExplanation& fit, std::size_t parameter) {
  const auto i = static_cast<Eigen::Index>(parameter);
  return normal_interval(fit.x[parameter],
                         fit.hypothesis.parameters()[parameter].std * std::sqrt(fit.covariance(i, i)));
}

double hidden_share(std::span<const ScreenedVariant> screened, const VerdictOptions& options) {
  if (screened.empty()) return 1.0;
  const auto hidden = std::count_if(screened.begin(), screened.end(), [&](const ScreenedVariant& s) {
    return s.visibility * options.small_effect < options.surely_seen;
  });
  return static_cast<double>(hidden) / static_cast<double>(screened.size());
}

std::optional<OutsideFinding> outside_finding(const ExplanationSearch& search, std::size_t candidate,
                                              const DriveCampaign& campaign) {
  const FittedExplanation& fit = search.fits[search.candidates[candidate].fit];
  const auto effects = fit.hypothesis.effects();
  for (std::size_t e = 0; e < effects.size(); ++e) {
    const OutsideCause* const cause = find_outside(effects[e].effect);
    if (cause == nullptr) continue;
    OutsideFinding found;
    found.cause = cause->name;
    found.words = cause->words(fit.hypothesis.outside_values(cause->name, fit.x), campaign);
    for (const Candidate& c : search.candidates)
      if (std::find(c.effects.begin(), c.effects.end(), found.cause) != c.effects.end())
        found.probability += c.probability;
    found.parameters = parameters_of(fit, e, false);
    return found;
  }
  return std::nullopt;
}

void judge(const DriveCampaign& campaign, const PreparedCampaign& prepared, const ExplanationSearch& search,
           const Naming& naming, const DiagnosisOptions& options, Diagnosis& d) {
  const Candidate& chosen = search.candidates[naming.candidate];
  std::map<SetKey, double> sets;
  std::map<std::string, double> single;
  double unknown = 0.0;
  const auto nothing = std::find_if(search.candidates.begin(), search.candidates.end(),
                                    [](const Candidate& c) { return c.effects.empty() && !c.with_unknown; });
  for (const Candidate& c : search.candidates) {
    sets[key_of(c)] += c.probability;
    for (const std::string& name : c.effects) single[name] += c.probability;
    if (c.unknown()) unknown += c.probability;
    ComparedSet set = compared(c);
    set.probability = c.probability;
    if (nothing != search.candidates.end()) set.log_evidence = c.log_evidence - nothing->log_evidence;
    set.log_prior = c.log_prior;
    set.complexity = static_cast<int>(search.fits[c.fit].x.size() - search.fits[0].x.size());
    d.candidates.push_back(std::move(set));
  }
  const double probability = sets[key_of(chosen)];
  if (search.candidates[naming.chosen].unknown())
    d.outside = outside_finding(search, naming.chosen, campaign);
  if (chosen.unknown() && !naming.partial) {
    judge_unknown(search, naming.chosen, unknown, d);
  } else if (naming.effects.empty()) {
    judge_without_effects(campaign, prepared, search, chosen, probability, options, d);
  } else {
    judge_effects(search, naming, probability, options, d);
    d.effects = found_effects(search.fits[chosen.fit], single);
  }
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

void withdraw_what_tells_no_better(double log_density_gain, Diagnosis& d) {
  const bool names_effects = d.verdict == Verdict::kEffects || d.verdict == Verdict::kEffectSet;
  if (!names_effects || d.partial || log_density_gain > 0.0) return;
  const std::vector<std::string> names = named(d);
  d.verdict = Verdict::kParameters;
  d.reason = fmt::format(
      "re-tuned soil and motor parameters tell drives held out of the fit as well as they do with {}, whose "
      "probability is {:.2f}: nothing is named (log density with it {:+.2g})",
      fmt::join(names, " and "), d.effects.front().probability, log_density_gain);
  d.overturned_by = kSameLook;
  withdraw_effects(d);
}

void doubt_what_leaves_a_gap(const FittedExplanation& reported, const VerdictOptions& options, Diagnosis& d) {
  const double unknown = unknown_probability(d);
  if (d.verdict == Verdict::kUnknown || d.verdict == Verdict::kInsufficient || d.partial || unknown <= 0.0)
    return;
  std::optional<std::string> why = gap_left(d, options);
  if (!why) why = parameter_at_its_end(reported);
  if (!why) return;
  const double doubt = options.min_doubt;
  if (unknown < doubt)
    for (ComparedSet& c : d.candidates)
      c.probability *= c.with_unknown ? doubt / unknown : (1.0 - doubt) / (1.0 - unknown);
  std::stable_sort(d.candidates.begin(), d.candidates.end(),
                   [](const ComparedSet& a, const ComparedSet& b) { return a.probability > b.probability; });
  take_marginals_anew(d);
  const std::vector<std::string> names = named(d);
  if (all_stand(d, options)) {
    d.partial = true;
    d.verdict = Verdict::kEffects;
    d.reason =
        fmt::format("{}, and something unexplained remains beside it: {}", closing_words(d, names), *why);
    d.overturned_by = kSameLook;
    return;
  }
  if (!names.empty())
    d.notes.push_back(
        fmt::format("{} would explain a part, and may be the unknown cause's shadow: nothing is named",
                    fmt::join(names, " and ")));
  withdraw_effects(d);
  d.least_detectable.clear();
  d.verdict = Verdict::kUnknown;
  d.reason = fmt::format("a gap remains that no effect of the library explains: {}", *why);
  d.overturned_by = kSameLook;
}

}  // namespace slipway::gap
