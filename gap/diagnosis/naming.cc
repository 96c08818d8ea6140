#include "gap/diagnosis/naming.h"

#include <algorithm>
#include <optional>
#include <set>

#include "gap/diagnosis/held_out/effect_marginals.h"
#include "sim/effects/effect_catalogue.h"

namespace slipway::gap {
namespace {

using Names = std::set<std::string>;

Names set_of(const std::vector<std::string>& names) {
  return {names.begin(), names.end()};
}

// Whether a library effect keeps its name beside a cause from outside of a known form.
bool stands_beside_form(const EffectMarginal& marginal, const VerdictOptions& options) {
  return as_good_as_certain(marginal, options) ||
         (marginal.probability >= options.min_probability_closing_most &&
          marginal.closed_share >= options.min_partial_share);
}

// Whether all these effects, which stand in one explanation, stand beside something unknown together. Of what
// is closed by two at once neither can close most: each closes most of what the others leave.
bool stand_together(const Names& effects, std::span<const EffectMarginal> marginals,
                    const CauseShares& shares, const VerdictOptions& options) {
  return std::all_of(effects.begin(), effects.end(), [&](const std::string& effect) {
    return marginal_of(marginals, effect).probability >= options.min_partial_probability &&
           shares.of_gap(effect) >= options.min_closed_share &&
           shares.beside_others(effect) >= options.min_partial_share;
  });
}

// Whether a law of all wheels keeps its name beside a cause from outside of a known form: it closes most of
// what is left to it in the most probable explanation that has it. Of causes that the library lacks, none
// looked like such a law beside a force or a sensor's error.
bool closes_what_form_leaves(const EffectMarginal& marginal, const CauseShares& shares,
                             const VerdictOptions& options) {
  return may_be_wheel_law(marginal.name) && marginal.probability >= options.min_probability_closing_most &&
         marginal.closed_share >= options.min_closed_share &&
         shares.beside_others(marginal.name) >= options.min_partial_share;
}

// The most probable candidate of which this holds; none where no such was compared.
template <class Holds>
std::optional<std::size_t> candidate_where(const ExplanationSearch& search, const Holds& holds) {
  const auto found = std::find_if(search.candidates.begin(), search.candidates.end(), holds);
  if (found == search.candidates.end()) return std::nullopt;
  return static_cast<std::size_t>(found - search.candidates.begin());
}

// With exactly these causes, and nothing of no known form.
std::optional<std::size_t> known_with(const ExplanationSearch& search, const Names& causes) {
  return candidate_where(search,
                         [&](const Candidate& c) { return !c.with_unknown && set_of(c.effects) == causes; });
}

bool is_effect(const std::string& cause) {
  return sim::find_effect(cause) != nullptr;
}

// An effect of the rover alone that all authors write alike: a larger wheel, a shifted load.
bool has_one_form(const std::string& cause) {
  const sim::Effect* const effect = sim::find_effect(cause);
  return effect != nullptr && effect->on_rover != nullptr && effect->on_soil == nullptr &&
         !effect->has_many_forms;
}

// An effect of the ground or of the motors that authors write differently, wherever the rover drives.
bool is_law(const std::string& cause) {
  return is_effect(cause) && !has_one_form(cause) && !acts_at_a_place(cause);
}

// Of known causes, all of them with some weight; of others what was chosen. A cause from outside that stands
// alone stays: nothing else says what is there.
std::size_t of_weight(const ExplanationSearch& search, std::size_t chosen, const CauseShares& shares,
                      const Beliefs& beliefs, const VerdictOptions& options) {
  const Candidate& first = search.candidates[chosen];
  if (first.with_unknown || (first.outside && library_effects_of(first).empty())) return chosen;
  double most_of_laws = 0.0, most_of_ground = 0.0;
  for (const std::string& cause : first.effects) {
    if (is_law(cause)) most_of_laws = std::max(most_of_laws, shares.of_gap(cause));
    if (may_be_wheel_law(cause)) most_of_ground = std::max(most_of_ground, shares.of_gap(cause));
  }
  Names kept;
  for (const std::string& cause : first.effects) {
    const double beside = is_law(cause) ? most_of_laws : acts_at_a_place(cause) ? most_of_ground : 0.0;
    if (shares.of_gap(cause) >= std::max(options.min_closed_share, options.min_share_of_law * beside))
      kept.insert(cause);
  }
  if (std::any_of(kept.begin(), kept.end(), is_effect)) {
    const bool beside_one_form = std::all_of(kept.begin(), kept.end(), has_one_form);
    for (const std::string& cause : first.effects)
      if (is_effect(cause) && (beside_one_form || has_one_form(cause)) &&
          shares.beside_others(cause) >= options.min_share_of_rest)
        kept.insert(cause);
  }
  double closed = 0.0;
  for (const std::string& cause : kept) closed += shares.of_gap(cause);
  if (closed < options.min_named_share &&
      evidence_over_nothing(first, search.candidates) < options.strong_evidence)
    kept.clear();
  const auto rest = known_with(search, kept);
  if (!rest) return chosen;
  const bool stood_in_for = !kept.empty() && beliefs.closure_shift(first) <= options.max_stand_in_shift &&
                            beliefs.closure_shift(search.candidates[*rest]) > options.max_stand_in_shift;
  return stood_in_for ? chosen : *rest;
}

// Of an explanation that is bent beyond belief a larger one of the same causes that is not, about as
// probable, each of whose causes has some weight. What acts at a place may bend the soil (doubts.h), and is
// no way out.
std::size_t not_bent(const ExplanationSearch& search, std::size_t chosen, const CauseShares& shares,
                     const Beliefs& beliefs, const VerdictOptions& options) {
  const Candidate& first = search.candidates[chosen];
  if (first.with_unknown || first.effects.empty() || !beliefs.are_bent_beyond(first)) return chosen;
  const Names causes = set_of(first.effects);
  for (std::size_t c = 0; c < search.candidates.size(); ++c) {
    const Candidate& larger = search.candidates[c];
    const Names own = set_of(larger.effects);
    if (!larger.unknown() && larger.probability >= options.believable_share * first.probability &&
        own.size() > causes.size() && std::includes(own.begin(), own.end(), causes.begin(), causes.end()) &&
        std::none_of(own.begin(), own.end(), acts_at_a_place) && !beliefs.are_bent_beyond(larger) &&
        of_weight(search, c, shares, beliefs, options) == c)
      return c;
  }
  return chosen;
}

// Of several known causes of an explanation that is bent beyond belief those that are as good as certain,
// where nothing is bent with them alone, and otherwise those that stand beside something unknown.
std::size_t of_belief(const ExplanationSearch& search, std::size_t chosen,
                      std::span<const EffectMarginal> marginals, const Beliefs& beliefs,
                      const VerdictOptions& options) {
  const Candidate& first = search.candidates[chosen];
  if (first.with_unknown || first.effects.size() < 2 || !beliefs.are_bent_beyond(first)) return chosen;
  const auto with_those = [&](const auto& stands) {
    Names kept;
    for (const EffectMarginal& m : marginals)
      if (stands(m) && std::find(first.effects.begin(), first.effects.end(), m.name) != first.effects.end())
        kept.insert(m.name);
    return kept.empty() ? std::nullopt : known_with(search, kept);
  };
  const auto certain = with_those([&](const EffectMarginal& m) { return as_good_as_certain(m, options); });
  if (certain && !beliefs.are_bent_beyond(search.candidates[*certain])) return *certain;
  return with_those([&](const EffectMarginal& m) { return stands_beside_unknown(m, true, options); })
      .value_or(chosen);
}

Naming as_chosen(const ExplanationSearch& search, std::size_t chosen) {
  const Candidate& c = search.candidates[chosen];
  return {c.unknown() ? std::vector<std::string>{} : c.effects, false, chosen, chosen, chosen};
}

}  // namespace

bool acts_at_a_place(const std::string& cause) {
  const sim::Effect* const effect = sim::find_effect(cause);
  return effect != nullptr && effect->variant_at != nullptr;
}

bool as_good_as_certain(const EffectMarginal& marginal, const VerdictOptions& options) {
  return marginal.probability >= options.min_certain_probability &&
         marginal.closed_share >= options.min_certain_share;
}

bool may_be_wheel_law(const std::string& effect) {
  if (!is_law(effect)) return false;
  const sim::Effect& row = *sim::find_effect(effect);
  return row.wheel_field.empty() && !row.reads_motor_temperature;
}

bool stands_beside_unknown(const EffectMarginal& marginal, bool another_law, const VerdictOptions& options) {
  if (may_be_wheel_law(marginal.name) && another_law) return false;
  return (marginal.probability >= options.min_partial_probability &&
          marginal.closed_share >= options.min_partial_share) ||
         (!may_be_wheel_law(marginal.name) && marginal.log_evidence >= options.strong_evidence &&
          marginal.closed_share >= options.min_certain_share);
}

std::optional<Naming> name_partially(const ExplanationSearch& search, std::size_t chosen,
                                     std::span<const std::string> names) {
  const Names wanted(names.begin(), names.end());
  const auto has_names = [&](const Candidate& c) { return set_of(library_effects_of(c)) == wanted; };
  const auto any = candidate_where(search, [&](const Candidate& c) { return c.unknown() && has_names(c); });
  if (!any) return std::nullopt;
  const auto alone = candidate_where(search, [&](const Candidate& c) { return !c.outside && has_names(c); });
  return Naming{library_effects_of(search.candidates[*any]), true, chosen, *any, alone.value_or(*any)};
}

Naming name_effects(const ExplanationSearch& search, std::size_t chosen,
                    std::span<const EffectMarginal> marginals, const CauseShares& shares,
                    const Beliefs& beliefs, const VerdictOptions& options) {
  if (!options.name_by_marginals) return as_chosen(search, chosen);
  chosen = of_weight(search, chosen, shares, beliefs, options);
  chosen = not_bent(search, chosen, shares, beliefs, options);
  chosen = of_belief(search, chosen, marginals, beliefs, options);
  const Candidate& first = search.candidates[chosen];
  if (!first.unknown()) return as_chosen(search, chosen);
  const bool known_form = first.outside && !first.with_unknown;
  const bool another_law = beliefs.are_bent_beyond(first);
  Names names;
  for (const EffectMarginal& m : marginals)
    if (known_form ? stands_beside_form(m, options) : stands_beside_unknown(m, another_law, options))
      names.insert(m.name);
  if (known_form)
    for (const std::string& effect : library_effects_of(first))
      if (closes_what_form_leaves(marginal_of(marginals, effect), shares, options)) names.insert(effect);
  if (const Names all = set_of(library_effects_of(first)); stand_together(all, marginals, shares, options))
    names.insert(all.begin(), all.end());
  if (another_law) std::erase_if(names, may_be_wheel_law);
  if (names.empty()) return as_chosen(search, chosen);
  const std::vector<std::string> all(names.begin(), names.end());
  return name_partially(search, chosen, all).value_or(as_chosen(search, chosen));
}

}  // namespace slipway::gap
