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

namespace slipway::gap {
namespace {

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

void judge_without_effects(const ExplanationSearch& search, const Candidate& chosen, double probability,
                           const DiagnosisOptions& options, Diagnosis& d) {
  d.least_detectable = least_detectable_of(search.screened, options.verdict);
  const Candidate* const rival = rival_of(search, chosen);
  const auto or_rival = [&](std::string_view words) {
    return rival != nullptr ? fmt::format("{}; {}", words, next_best(*rival)) : std::string(words);
  };
  const double gain = d.search.parameters_gain;
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
      fmt::format("{} explain{} what re-tuned parameters leave over (probability of this explanation {:.2f})",
                  fmt::join(chosen.effects, " and "), chosen.effects.size() == 1 ? "s" : "", probability);
  if (rival != nullptr) d.overturned_by = next_best(*rival);
}

// Why something of no known form, alone, may be chance; nothing where it is more than drives show that have
// nothing amiss.
std::optional<std::string> why_chance(const Candidate& chosen, const ExplanationSearch& search,
                                      double unknown, const VerdictOptions& options) {
  if (!chosen.with_unknown || !chosen.effects.empty()) return std::nullopt;
  const double evidence = evidence_over_nothing(chosen, search.candidates);
  if (evidence < options.min_unknown_evidence)
    return fmt::format("by a log evidence of {:.1f}, of which less than {:.0f} may be chance", evidence,
                       options.min_unknown_evidence);
  if (unknown < options.min_unknown_probability)
    return fmt::format("and less than {:.2f} may be chance", options.min_unknown_probability);
  return std::nullopt;
}

// What is there, if anything, is not surely found: nothing is named.
void say_not_detected(const ExplanationSearch& search, const VerdictOptions& options, Diagnosis& d) {
  d.least_detectable = least_detectable_of(search.screened, options);
  d.verdict = Verdict::kNotDetected;
  d.effects.clear();
  d.overturned_by = "more drives, which show what is there more clearly";
}

void judge_chance(const ExplanationSearch& search, double unknown, const std::string& why,
                  const VerdictOptions& options, Diagnosis& d) {
  d.reason =
      fmt::format("no gap was surely found: something unknown has a probability of {:.2f}, {}", unknown, why);
  say_not_detected(search, options, d);
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

}  // namespace

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

Interval parameter_interval(const FittedExplanation& fit, std::size_t parameter) {
  const auto i = static_cast<Eigen::Index>(parameter);
  const Parameter& p = fit.hypothesis.parameters()[parameter];
  Interval interval = normal_interval(fit.x[parameter], p.std * std::sqrt(fit.covariance(i, i)));
  interval.low = std::clamp(interval.low, std::min(p.lowest, interval.value), interval.value);
  interval.high = std::clamp(interval.high, interval.value, std::max(p.highest, interval.value));
  return interval;
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

std::vector<FoundEffect> found_effects(const FittedExplanation& fit,
                                       std::span<const EffectMarginal> marginals) {
  std::vector<FoundEffect> all;
  const auto effects = fit.hypothesis.effects();
  for (std::size_t e = 0; e < effects.size(); ++e)
    if (find_outside(effects[e].effect) == nullptr)
      all.push_back({effects[e].effect, effects[e].label,
                     marginal_of(marginals, effects[e].effect).probability, parameters_of(fit, e, true)});
  return all;
}

std::string closing_words(const Diagnosis& d, std::span<const std::string> effects) {
  std::vector<std::string> each;
  for (const std::string& effect : effects) {
    const EffectMarginal m = marginal_of(d.marginals, effect);
    each.push_back(fmt::format("{} (probability {:.3f}) closes {:.0f} % of the gap", effect, m.probability,
                               100.0 * m.closed_share));
  }
  return fmt::format("{}", fmt::join(each, ", "));
}

void judge(const DriveCampaign& campaign, const ExplanationSearch& search,
           const Naming& naming, const DiagnosisOptions& options, Diagnosis& d) {
  const Candidate& chosen = search.candidates[naming.candidate];
  std::map<SetKey, double> sets;
  double unknown = 0.0;
  for (const Candidate& c : search.candidates) {
    sets[key_of(c)] += c.probability;
    if (c.unknown()) unknown += c.probability;
    ComparedSet set = compared(c);
    set.probability = c.probability;
    set.log_evidence = evidence_over_nothing(c, search.candidates);
    set.log_prior = c.log_prior;
    set.complexity = static_cast<int>(search.fits[c.fit].x.size() - search.fits[0].x.size());
    d.candidates.push_back(std::move(set));
  }
  const double probability = sets[key_of(chosen)];
  if (search.candidates[naming.chosen].unknown())
    d.outside = outside_finding(search, naming.chosen, campaign);
  if (const auto why = why_chance(chosen, search, unknown, options.verdict)) {
    judge_chance(search, unknown, *why, options.verdict, d);
  } else if (chosen.unknown() && !naming.partial) {
    judge_unknown(search, naming.chosen, unknown, d);
  } else if (naming.effects.empty()) {
    judge_without_effects(search, chosen, probability, options, d);
  } else {
    judge_effects(search, naming, probability, options, d);
    d.effects = found_effects(search.fits[chosen.fit], d.marginals);
  }
}

void judge_resamples(const ExplanationSearch& search, const VerdictOptions& options, Diagnosis& d) {
  if (!names_effects(d.verdict) || d.partial) return;
  double nothing = 0.0;
  for (const ComparedSet& c : d.candidates)
    if (c.effects.empty() && !c.with_unknown) nothing += c.chosen_share;
  if (nothing <= options.max_nothing_share) return;
  std::vector<std::string> names;
  for (const FoundEffect& effect : d.effects) names.push_back(effect.name);
  d.reason = fmt::format(
      "no gap was surely found: with {} the drives are more probable, but had other drives of the same kinds "
      "been made, {:.0f} % of such campaigns would show nothing missing",
      fmt::join(names, " and "), 100.0 * nothing);
  say_not_detected(search, options, d);
}

}  // namespace slipway::gap
