#include "gap/diagnosis/decide/decision.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>

#include "gap/diagnosis/decide/calibration.h"
#include "sim/effects/effect_catalogue.h"

namespace slipway::gap {
namespace {

constexpr std::array<std::string_view, 7> kVerdicts{"no_gap",     "not_detected", "parameters",  "effects",
                                                    "effect_set", "unknown",      "insufficient"};

using Names = std::set<std::string>;
using Explanation = SearchRecord::Explanation;

// The effects of an explanation that may be named.
Names nameable_in(const Explanation& e, bool adequate) {
  Names names;
  for (const std::string& effect : e.effects)
    if (adequate || !may_be_wheel_law(effect)) names.insert(effect);
  return names;
}

// The most probable explanation of which this holds; the first of all where there is none.
template <class Holds>
std::size_t most_probable(const SearchRecord& record, const Holds& holds) {
  const auto& all = record.explanations;
  const auto found = std::find_if(all.begin(), all.end(), holds);
  return found == all.end() ? 0 : static_cast<std::size_t>(found - all.begin());
}

// The compared set that naming saves most by; empty where none does.
Names set_of_least_loss(const SearchRecord& record, const Decision& decision,
                        const DecisionOptions& options) {
  Names best;
  double most = 0.0;
  for (const Explanation& e : record.explanations) {
    double saved = 0.0;
    const Names names = nameable_in(e, decision.adequate);
    for (const std::string& effect : names) {
      const double q = decision.calibrated.at(effect);
      saved += q * options.missed_name - (1.0 - q) * options.wrong_name;
    }
    if (saved <= most) continue;
    most = saved;
    best = names;
  }
  return best;
}

double missing_probability(const SearchRecord& record) {
  const Calibration& of_certain = calibration(record.with_reference);
  double missing = 0.0;
  for (const Explanation& e : record.explanations) {
    double at_work = e.unknown() ? 1.0 : 0.0;
    for (const std::string& effect : e.effects)
      at_work = std::max(at_work, of_certain(1.0, record.share_of(effect)));
    missing += e.probability * at_work;
  }
  return missing;
}

}  // namespace

std::string_view name_of(Verdict verdict) {
  return kVerdicts[static_cast<std::size_t>(verdict)];
}

bool may_be_wheel_law(const std::string& effect) {
  const sim::Effect* const row = sim::find_effect(effect);
  if (row == nullptr || row->variant_at != nullptr) return false;  // from outside, or at a place
  // What is of the rover alone all authors write alike: a larger wheel, a shifted load.
  const bool of_the_rover = row->on_rover != nullptr && row->on_soil == nullptr && !row->has_many_forms;
  return !of_the_rover && row->wheel_field.empty() && !row->reads_motor_temperature;
}

Decision decide(const SearchRecord& record, double evidence_share, const DecisionOptions& options) {
  Decision decision;
  decision.marginals = marginals_of(record);
  decision.adequacy = adequacy_of(record, record.explanations.front().fit);
  decision.adequate = decision.adequacy.p() >= options.conflict;
  for (const SearchRecord::Cause& cause : record.causes)
    decision.calibrated[cause.name] =
        calibration(record.with_reference)(decision.marginals.of_cause[cause.name], cause.share);
  decision.missing_probability = missing_probability(record);

  const Names names = set_of_least_loss(record, decision, options);
  decision.names.assign(names.begin(), names.end());
  if (names.empty()) {
    const double missing = decision.missing_probability;
    const bool alarm = !decision.adequate || record.drives_changed ||
                       (1.0 - missing) * options.false_alarm < missing * options.missed_alarm;
    decision.answer = decision.beside =
        alarm ? most_probable(record, [](const Explanation& e) { return e.unknown(); })
              : most_probable(record, [](const Explanation& e) { return !e.unknown() && e.effects.empty(); });
    // That soils and motors are as believed, if nothing is missing.
    const double nominal = 1.0 / (1.0 + std::exp(evidence_share * record.parameters_gain));
    const double sure = options.wrong_name / (options.wrong_name + options.missed_name);
    decision.verdict = alarm                       ? Verdict::kUnknown
                       : 1.0 - nominal > sure      ? Verdict::kParameters
                       : record.hidden_share < 0.5 ? Verdict::kNoGap
                                                   : Verdict::kNotDetected;
    return decision;
  }
  double unknown = 0.0;
  for (const Explanation& e : record.explanations) {
    if (nameable_in(e, decision.adequate) != names) continue;
    decision.set_probability += e.probability;
    if (e.unknown()) unknown += e.probability;
  }
  decision.partial = !decision.adequate || unknown > 0.5 * decision.set_probability;
  decision.verdict =
      decision.partial || decision.set_probability > 0.5 ? Verdict::kEffects : Verdict::kEffectSet;
  // With these effects alone where that was compared, and otherwise with a law of all wheels among them.
  const auto answered = [&](bool something_unknown) -> std::optional<std::size_t> {
    const auto& all = record.explanations;
    for (const bool exactly : {true, false}) {
      const auto found = std::find_if(all.begin(), all.end(), [&](const Explanation& e) {
        return e.unknown() == something_unknown && nameable_in(e, exactly || decision.adequate) == names;
      });
      if (found != all.end()) return static_cast<std::size_t>(found - all.begin());
    }
    return std::nullopt;
  };
  const auto known = answered(false), beside = answered(true);
  decision.answer = known ? *known : beside.value();
  decision.beside = beside ? *beside : decision.answer;
  return decision;
}

}  // namespace slipway::gap
