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

#include "gap/diagnosis/search/selection.h"

namespace slipway::gap {
namespace {

constexpr double kParametersGain = 20.0;  // of the logarithm of the evidence, for calling parameters mis-set
constexpr double kSurelySeen = 6.0;    // standard errors: what the tempered evidence asks for over its prior
constexpr double kSmall = 0.5;         // of an effect's usual size
constexpr double kBeyondChance = 2.0;  // standard errors
// What may be left on held-out drives, over the floor. An effect's equation may be another's: what it leaves
// is forgiven where it closes this share of the channel's gap.
constexpr double kLeftOfNothing = 1.25, kLeftBesideEffects = 1.5, kForgiven = 0.5;
constexpr double kRival = 0.75;  // of an answer's probability: a rival that has as much is alike
constexpr double kDoubt = 0.9;   // the probability of something unknown that such an answer leaves, at least

constexpr std::string_view kSameLook =
    "an effect of the library with another equation than the library's would look the same";

// How much more probable the drives are when soils and motors may differ from the nominal ones, closures
// being free in either case.
double gain_of_parameters(const PreparedCampaign& prepared, const DriveCampaign& campaign,
                          std::size_t threads) {
  const FittedExplanation& null = *prepared.null;
  const Hypothesis pinned(campaign, {}, FreeNuisances::kClosures);
  std::vector<double> start;
  for (const Parameter& closure : pinned.parameters())
    for (std::size_t p = 0; p < null.x.size(); ++p)
      if (null.hypothesis.parameters()[p].name == closure.name) start.push_back(null.x[p]);
  ExplanationOptions options;
  options.threads = threads;
  const FittedExplanation nominal = fit_explanation(pinned, *prepared.model, *prepared.noise, start, options);
  const auto evidence = [&](const FittedExplanation& fit) {
    return fit.log_evidence + discrepancy_gain(fit, *prepared.noise, prepared.discrepancy,
                                               Eigen::MatrixXd(fit.white_jacobian.rows(), 0))
                                  .imprecision;
  };
  return evidence(null) - evidence(nominal);
}

std::vector<std::string> names_in(const Candidate& c) {
  std::vector<std::string> names = c.effects;
  if (c.with_unknown) names.emplace_back("unknown");
  return names;
}

// The most probable set that is not this one, if any.
const Candidate* rival_of(const ExplanationSearch& search, const std::vector<std::string>& named) {
  const auto rival = std::find_if(search.candidates.begin(), search.candidates.end(),
                                  [&](const Candidate& c) { return names_in(c) != named; });
  return rival == search.candidates.end() ? nullptr : &*rival;
}

std::string next_best(const Candidate& rival) {
  const std::vector<std::string> names = names_in(rival);
  return fmt::format("next best: {} (probability {:.2g})",
                     names.empty() ? "nothing missing" : fmt::format("{}", fmt::join(names, " and ")),
                     rival.probability);
}

// Nearly as probable, and no unknown cause.
bool alike(const Candidate* rival, double probability) {
  return rival != nullptr && !rival->with_unknown && rival->probability > kRival * probability;
}

void judge_without_effects(const DriveCampaign& campaign, const PreparedCampaign& prepared,
                           const ExplanationSearch& search, double probability, std::size_t threads,
                           Diagnosis& d) {
  for (const ScreenedVariant& s : search.screened) {
    if (s.visibility <= 0.0) continue;
    if (std::any_of(d.least_detectable.begin(), d.least_detectable.end(),
                    [&](const LeastDetectable& l) { return l.effect == s.variant.effect; }))
      continue;
    const EffectVariant::Free& free = s.variant.free.front();
    d.least_detectable.push_back({s.variant.effect, free.field, kSurelySeen * free.std / s.visibility});
  }
  const Candidate* const rival = rival_of(search, {});
  const auto or_rival = [&](std::string_view words) {
    return rival != nullptr ? fmt::format("{}; {}", words, next_best(*rival)) : std::string(words);
  };
  const double gain = gain_of_parameters(prepared, campaign, threads);
  if (gain > kParametersGain) {
    d.verdict = Verdict::kParameters;
    d.reason = fmt::format(
        "re-tuned soil and motor parameters explain the drives (log evidence +{:.0f}); no effect is "
        "missing (probability {:.2f})",
        gain, probability);
    d.overturned_by = or_rival("an effect that acts like these parameters in every drive that was made");
    return;
  }
  // Of effects at their usual size, how many could have hidden?
  int hidden = 0, all = 0;
  for (const ScreenedVariant& s : search.screened) {
    ++all;
    if (s.visibility * kSmall < kSurelySeen) ++hidden;
  }
  d.overturned_by = or_rival("drives that show an effect below the least size that these could have shown");
  if (alike(rival, probability)) {
    d.verdict = Verdict::kNotDetected;
    d.reason = fmt::format("no gap was surely found (probability {:.2f}), but these drives leave more open",
                           probability);
  } else if (2 * hidden < all) {
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
std::optional<std::string> gap_left(const Diagnosis& d) {
  double most = d.effects.empty() ? kLeftOfNothing : kLeftBesideEffects;
  std::optional<std::string> words;
  for (const ChannelClosure& c : d.gap) {
    if (row_of(c.channel).of_the_stance) continue;
    const double floor = c.noise_floor.value;
    if (c.with_effects.low <= most * floor) continue;
    if (!d.effects.empty() && c.retuned.value - c.with_effects.value >= kForgiven * (c.retuned.value - floor))
      continue;
    most = c.with_effects.low / floor;
    words = fmt::format("on drives held out of the fit {} is {:.1f} times its floor off (at least {:.1f})",
                        name_of(c.channel), c.with_effects.value / floor, most);
  }
  return words;
}

// A parameter that the answer needs at one of its two ends.
std::optional<std::string> parameter_at_its_end(const FittedExplanation& reported) {
  for (std::size_t p = 0; p < reported.hypothesis.nuisance_count(); ++p) {
    const Parameter& parameter = reported.hypothesis.parameters()[p];
    const bool two_sided = parameter.lowest < parameter.neutral && parameter.neutral < parameter.highest;
    if (two_sided && (reported.x[p] <= parameter.lowest || reported.x[p] >= parameter.highest))
      return fmt::format(
          "{} would have to be further from what was believed than it may be ({:.1f} deviations)",
          parameter.name, std::abs(reported.x[p] - parameter.neutral) / parameter.std);
  }
  return std::nullopt;
}

bool holds_unknown(const ComparedSet& set) {
  return std::find(set.effects.begin(), set.effects.end(), "unknown") != set.effects.end();
}

double unknown_probability(const Diagnosis& d) {
  double sum = 0.0;
  for (const ComparedSet& c : d.candidates)
    if (holds_unknown(c)) sum += c.probability;
  return sum;
}

// No effect is told: what drives look like with the effects is what they look like re-tuned.
void withdraw_effects(Diagnosis& d) {
  std::vector<std::string> names;
  for (const FoundEffect& effect : d.effects) names.push_back(effect.name);
  if (names.empty()) return;
  d.notes.push_back(
      fmt::format("{} would explain a part, and may be the unknown cause's shadow: nothing is named",
                  fmt::join(names, " and ")));
  d.effects.clear();
  for (ChannelClosure& c : d.gap) c.with_effects = c.retuned;
  for (HeldOutPoint& point : d.held_out) point.with_effects = point.retuned;
  for (WindowGap& window : d.window_gaps) window.with_effects = window.retuned;
  d.planners_view.with_effects = d.planners_view.retuned;
}

}  // namespace

Interval parameter_interval(const FittedExplanation& fit, std::size_t parameter) {
  const auto i = static_cast<Eigen::Index>(parameter);
  return normal_interval(fit.x[parameter],
                         fit.hypothesis.parameters()[parameter].std * std::sqrt(fit.covariance(i, i)));
}

void judge(const DriveCampaign& campaign, const PreparedCampaign& prepared, const ExplanationSearch& search,
           std::size_t best, std::size_t threads, Diagnosis& d) {
  const Candidate& chosen = search.candidates[best];
  const FittedExplanation& fit = search.fits[chosen.fit];
  std::map<std::set<std::string>, double> sets;
  std::map<std::string, double> single;
  double unknown = 0.0;
  for (const Candidate& c : search.candidates) {
    const std::vector<std::string> names = names_in(c);
    sets[{names.begin(), names.end()}] += c.probability;
    for (const std::string& name : c.effects) single[name] += c.probability;
    if (c.with_unknown) unknown += c.probability;
    d.candidates.push_back({names, c.probability, std::nullopt,
                            static_cast<int>(search.fits[c.fit].x.size() - search.fits[0].x.size())});
  }
  const std::vector<std::string> named = names_in(chosen);
  const double probability = sets[{named.begin(), named.end()}];
  if (chosen.with_unknown) {
    d.verdict = Verdict::kUnknown;
    d.reason =
        fmt::format("a gap remains that no effect of the library explains (probability {:.2f})", unknown);
    d.overturned_by = kSameLook;
  } else if (chosen.effects.empty()) {
    judge_without_effects(campaign, prepared, search, probability, threads, d);
  } else {
    const Candidate* const rival = rival_of(search, named);
    d.verdict =
        probability >= kCertain && !alike(rival, probability) ? Verdict::kEffects : Verdict::kEffectSet;
    d.reason =
        fmt::format("{} explain{} what re-tuned parameters leave over (probability {:.2f})",
                    fmt::join(chosen.effects, " and "), chosen.effects.size() == 1 ? "s" : "", probability);
    if (rival != nullptr) d.overturned_by = next_best(*rival);
  }
  if (d.verdict == Verdict::kUnknown && !chosen.effects.empty())
    d.notes.push_back(
        fmt::format("{} would fit beside what is unexplained, and may be its shadow: nothing is named",
                    fmt::join(chosen.effects, " and ")));
  if (d.verdict != Verdict::kEffects && d.verdict != Verdict::kEffectSet) return;
  for (std::size_t e = 0; e < chosen.effects.size(); ++e) {
    FoundEffect found{chosen.effects[e], fit.hypothesis.effects()[e].label, single[chosen.effects[e]], {}};
    const auto parameters = fit.hypothesis.parameters();
    for (std::size_t p = fit.hypothesis.nuisance_count(); p < parameters.size(); ++p)
      if (parameters[p].effect == found.name)
        found.parameters.push_back(
            {parameters[p].name.substr(found.name.size() + 1), parameter_interval(fit, p)});
    for (const auto& [field, value] : fit.hypothesis.effects()[e].fixed)
      found.parameters.push_back({field, {value, value, value}});
    d.effects.push_back(std::move(found));
  }
}

void doubt_what_does_not_extrapolate(Diagnosis& d) {
  if (d.verdict != Verdict::kEffects) return;
  for (const Extrapolation& e : d.extrapolations) {
    if (e.log_density_gain + kBeyondChance * e.error >= 0.0) continue;
    d.verdict = Verdict::kEffectSet;
    d.reason += fmt::format(
        "; but learnt from the other drives it tells those of {} {} {:.3g} worse than re-tuned "
        "parameters alone",
        e.variable, e.above ? "above" : "below", e.limit);
    return;
  }
}

void doubt_what_leaves_a_gap(const FittedExplanation& reported, Diagnosis& d) {
  const double unknown = unknown_probability(d);
  if (d.verdict == Verdict::kUnknown || d.verdict == Verdict::kInsufficient || unknown <= 0.0) return;
  std::optional<std::string> why = gap_left(d);
  if (!why) why = parameter_at_its_end(reported);
  if (!why) return;
  if (unknown < kDoubt)
    for (ComparedSet& c : d.candidates)
      c.probability *= holds_unknown(c) ? kDoubt / unknown : (1.0 - kDoubt) / (1.0 - unknown);
  std::stable_sort(d.candidates.begin(), d.candidates.end(),
                   [](const ComparedSet& a, const ComparedSet& b) { return a.probability > b.probability; });
  withdraw_effects(d);
  d.least_detectable.clear();
  d.verdict = Verdict::kUnknown;
  d.reason = fmt::format("a gap remains that no effect of the library explains: {}", *why);
  d.overturned_by = kSameLook;
}

}  // namespace slipway::gap
