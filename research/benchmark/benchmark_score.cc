#include "research/benchmark/benchmark_score.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "sim/effects/effect_catalogue.h"

namespace slipway::gap {
namespace {

using Names = std::set<std::string>;

const std::string kUnknownName = "unknown";
constexpr double kSmallAngle_deg = 25.0, kConfident = 0.9, kHeld = 0.95;
constexpr std::size_t kMaxHeld = 3;

// The sets of effects that were compared, each once, with the most probable first.
std::vector<std::pair<Names, double>> merged_sets(const Diagnosis& d) {
  std::vector<std::pair<Names, double>> sets;
  for (const ComparedSet& c : d.candidates) {
    const std::vector<std::string> listed = names_of(c);
    const Names names(listed.begin(), listed.end());
    const auto known =
        std::find_if(sets.begin(), sets.end(), [&](const auto& set) { return set.first == names; });
    if (known == sets.end())
      sets.emplace_back(names, c.probability);
    else
      known->second += c.probability;
  }
  std::stable_sort(sets.begin(), sets.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  return sets;
}

Names found_in(const Diagnosis& d) {
  Names found;
  for (const FoundEffect& effect : d.effects) found.insert(effect.name);
  if (d.verdict == Verdict::kUnknown || d.partial) found.insert(kUnknownName);
  return found;
}

std::string words(const Names& names) {
  return names.empty() ? "nothing" : fmt::format("{}", fmt::join(names, " + "));
}

// The truth in the names of a diagnosis, in which a cause without a name is "unknown".
Names sayable(const HiddenAnswer& answer, const Names& library) {
  Names truth;
  for (const std::string& effect : answer.effects)
    truth.insert(library.contains(effect) ? effect : kUnknownName);
  return truth;
}

bool confusable(const Diagnosis& d, const std::string& a, const std::string& b) {
  return std::any_of(d.confusable.begin(), d.confusable.end(), [&](const ConfusablePair& pair) {
    return pair.angle_deg < kSmallAngle_deg && ((pair.a == a && pair.b == b) || (pair.a == b && pair.b == a));
  });
}

// Whether one set becomes the other when one name is replaced by a look-alike.
bool exchanged(const Diagnosis& d, const Names& a, const Names& b) {
  Names only_a, only_b;
  std::set_difference(a.begin(), a.end(), b.begin(), b.end(), std::inserter(only_a, only_a.end()));
  std::set_difference(b.begin(), b.end(), a.begin(), a.end(), std::inserter(only_b, only_b.end()));
  return only_a.size() == 1 && only_b.size() == 1 && confusable(d, *only_a.begin(), *only_b.begin());
}

// Whether a diagnosis says of every one of these effects that re-tuned parameters look like it.
bool all_like_parameters(const Diagnosis& d, const Names& effects) {
  return !effects.empty() && std::all_of(effects.begin(), effects.end(), [&](const std::string& effect) {
    return std::any_of(d.look_alikes.begin(), d.look_alikes.end(), [&](const LookAlike& alike) {
      return alike.effect == effect && alike.like == "parameters";
    });
  });
}

// The probability that the answer states for its own claim: that something is unknown, with or without
// effects, or that exactly this set of effects acts.
double stated_by(const Diagnosis& d, const std::vector<std::pair<Names, double>>& sets, const Names& found) {
  double sum = 0.0;
  for (const auto& [names, probability] : sets)
    if (d.verdict == Verdict::kUnknown ? names.contains(kUnknownName) : names == found) sum += probability;
  return sum;
}

// Whether effects of single wheels were found at those wheels; empty where none was both hidden and found.
std::optional<bool> wheel_right(const HiddenAnswer& answer, const Diagnosis& d) {
  std::optional<bool> right;
  for (const FoundEffect& effect : d.effects) {
    const auto hidden = answer.wheel_of.find(effect.name);
    if (hidden == answer.wheel_of.end()) continue;
    right = right.value_or(true) &&
            std::any_of(effect.parameters.begin(), effect.parameters.end(), [&](const FoundParameter& p) {
              return p.name == "wheel" && p.value.value == hidden->second;
            });
  }
  return right;
}

// Whether the verdict is of the right kind, and exact: it names what is hidden and nothing else.
void score_verdict(CaseScore& score, const Diagnosis& d, const Names& truth, const Names& found) {
  switch (score.truth_kind) {
    case TruthKind::kNothing:
    case TruthKind::kParameters:
      // A small shift of parameters leaves no gap, and a large one is reported as parameters. Neither is an
      // alarm.
      score.verdict_right = finds_nothing_missing(d.verdict);
      score.exact = score.verdict_right;
      break;
    case TruthKind::kEffects:
      score.verdict_right = names_effects(d.verdict);
      score.exact = score.verdict_right && found == truth;
      break;
    case TruthKind::kOutsideLibrary:
      score.verdict_right = d.verdict == Verdict::kUnknown || (d.partial && found == truth);
      score.exact = score.verdict_right && found == truth;
      break;
  }
  Names named = found, of_library = truth;
  named.erase(kUnknownName);
  of_library.erase(kUnknownName);
  score.partial = d.partial;
  score.names_right = named == of_library;
  score.wrong_name = !std::includes(of_library.begin(), of_library.end(), named.begin(), named.end());
  for (const EffectMarginal& m : d.marginals)
    score.marginals.push_back({{m.probability, of_library.contains(m.name)}, m.name, m.closed_share});
  score.false_alarm = truth.empty() && (names_effects(d.verdict) || d.verdict == Verdict::kUnknown);
}

// What the diagnosis holds beside what it names: the other sets of causes, and how sure it is.
void score_probabilities(CaseScore& score, const Diagnosis& d, const Names& truth, const Names& found) {
  const auto sets = merged_sets(d);
  double sum = 0.0;
  for (std::size_t i = 0; i < sets.size() && i < kMaxHeld && sum < kHeld; ++i) {
    sum += sets[i].second;
    score.held = score.held || sets[i].first == truth;
  }
  const bool second = sets.size() > 1 && sets[1].first == truth;
  score.alike = score.exact || (d.verdict == Verdict::kEffectSet && score.held) ||
                (names_effects(d.verdict) && second && exchanged(d, found, truth)) ||
                (finds_nothing_missing(d.verdict) && all_like_parameters(d, truth));
  for (const FoundEffect& effect : d.effects)
    score.confident_wrong =
        score.confident_wrong || (effect.probability > kConfident && !truth.contains(effect.name));
  for (const auto& [names, probability] : sets)
    if (names.contains(kUnknownName)) score.unknown_probability += probability;
  score.stated = stated_by(d, sets, found);
}

// Which part of the hidden disc the places of the gap cover, where an effect that acts in a region is named.
double place_overlap(const HiddenAnswer::Place& place, const Diagnosis& d, const Names& found) {
  const bool named = std::any_of(found.begin(), found.end(), [](const std::string& name) {
    const sim::Effect* const effect = sim::find_effect(name);
    return effect != nullptr && effect->region != nullptr;
  });
  double overlap = 0.0;
  for (const GapPlace& gap : d.places)
    if (named) overlap = std::max(overlap, disc_overlap(place, {gap.x_m, gap.y_m, gap.radius_m}));
  return overlap;
}

}  // namespace

CaseScore score_case(const HiddenAnswer& answer, const Diagnosis& d, const std::set<std::string>& library,
                     double seconds) {
  CaseScore score;
  const Names truth = sayable(answer, library), found = found_in(d);
  const bool foreign = truth.contains(kUnknownName);
  score.campaign = answer.campaign;
  score.fidelity = answer.fidelity;
  score.kind = answer.kind;
  score.size = answer.size;
  score.seconds = seconds;
  score.verdict = name_of(d.verdict);
  score.truth_kind = foreign                              ? TruthKind::kOutsideLibrary
                     : !truth.empty()                     ? TruthKind::kEffects
                     : answer.nominal_off.value_or(false) ? TruthKind::kParameters
                                                          : TruthKind::kNothing;
  score.truth = !answer.effects.empty()                      ? words(answer.effects)
                : score.truth_kind == TruthKind::kParameters ? "parameters"
                                                             : "nothing";
  score.found = d.verdict == Verdict::kInsufficient ? "insufficient"
                : d.verdict == Verdict::kParameters ? "parameters"
                                                    : words(found);

  score_verdict(score, d, truth, found);
  score_probabilities(score, d, truth, found);
  if (d.closed_fraction) score.closed_fraction = d.closed_fraction->value;
  score.wheel_right = wheel_right(answer, d);
  if (score.truth_kind == TruthKind::kEffects && names_effects(d.verdict)) {
    score.channel_right = channel_right(answer.traces, d);
    if (const auto overlap = slice_overlap(answer.traces, d)) {
      score.slice_overlap = overlap->value;
      score.slice_attainable = overlap->attainable;
    }
  }
  if (answer.place) score.place_overlap = place_overlap(*answer.place, d, found);
  return score;
}

WithheldScore score_withheld(const HiddenAnswer& answer, const std::string& withheld, const Diagnosis& open,
                             const Diagnosis& d) {
  WithheldScore score;
  score.campaign = answer.campaign;
  score.withheld = withheld;
  score.fidelity = answer.fidelity;
  score.verdict = name_of(d.verdict);
  const Names found = found_in(d);
  score.found = d.verdict == Verdict::kParameters ? "parameters" : words(found);
  Names named = found, others = answer.effects;
  named.erase(kUnknownName);
  others.erase(withheld);
  // A partial answer names the others that are hidden, if any, and says that something is beside them.
  score.unknown = d.verdict == Verdict::kUnknown ||
                  (d.partial && std::includes(others.begin(), others.end(), named.begin(), named.end()));
  score.absorbed =
      finds_nothing_missing(d.verdict) || (names_effects(d.verdict) && !d.partial && named == others);
  score.look_alike = names_effects(d.verdict) && exchanged(open, found, answer.effects);
  score.declared = score.absorbed && all_like_parameters(open, {withheld});
  return score;
}

double disc_overlap(const HiddenAnswer::Place& a, const HiddenAnswer::Place& b) {
  const double distance = std::hypot(a.x_m - b.x_m, a.y_m - b.y_m), r = a.radius_m, q = b.radius_m;
  const double area_a = std::numbers::pi * r * r, area_b = std::numbers::pi * q * q;
  if (r <= 0.0 || q <= 0.0 || distance >= r + q) return 0.0;
  double common = std::min(area_a, area_b);
  if (distance > std::abs(r - q)) {
    // Two circular segments on the chord that the circles share.
    const double at_a = (distance * distance + r * r - q * q) / (2.0 * distance), at_b = distance - at_a;
    const auto segment = [](double radius, double to_chord) {
      return radius * radius * std::acos(std::clamp(to_chord / radius, -1.0, 1.0)) -
             to_chord * std::sqrt(std::max(0.0, radius * radius - to_chord * to_chord));
    };
    common = segment(r, at_a) + segment(q, at_b);
  }
  return common / (area_a + area_b - common);
}

}  // namespace slipway::gap
