#include "gap/diagnosis/naming.h"

#include <algorithm>
#include <optional>
#include <set>

#include "sim/effects/effect_catalogue.h"

namespace slipway::gap {
namespace {

using Names = std::set<std::string>;

Names set_of(const std::vector<std::string>& names) {
  return {names.begin(), names.end()};
}

// The same beside a cause from outside of a known form.
bool stands_beside_form(const EffectMarginal& marginal, const VerdictOptions& options) {
  return (marginal.probability >= options.min_probability_beside_form &&
          marginal.closed_share >= options.min_share_beside_form) ||
         (marginal.probability >= options.min_probability_closing_most &&
          marginal.closed_share >= options.min_partial_share);
}

// The most probable candidate with exactly these effects of the library, among those that `may` be taken.
template <class May>
std::optional<std::size_t> candidate_with(const ExplanationSearch& search, const Names& effects,
                                          const May& may) {
  for (std::size_t c = 0; c < search.candidates.size(); ++c)
    if (may(search.candidates[c]) && set_of(library_effects_of(search.candidates[c])) == effects) return c;
  return std::nullopt;
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
  return is_effect(cause) && !has_one_form(cause) && sim::find_effect(cause)->variant_at == nullptr;
}

// Of known causes, all of them with some weight; of others what was chosen. A cause from outside that stands
// alone stays: nothing else says what is there.
std::size_t of_weight(const ExplanationSearch& search, std::size_t chosen, const CauseShares& shares,
                      const Believable& believable, const VerdictOptions& options) {
  const Candidate& first = search.candidates[chosen];
  if (first.with_unknown || (first.outside && library_effects_of(first).empty())) return chosen;
  double most_of_laws = 0.0;
  for (const std::string& cause : first.effects)
    if (is_law(cause)) most_of_laws = std::max(most_of_laws, shares.of_gap(cause));
  Names kept;
  for (const std::string& cause : first.effects) {
    const double least = is_law(cause) ? options.min_share_of_law * most_of_laws : 0.0;
    if (shares.of_gap(cause) >= std::max(options.min_closed_share, least)) kept.insert(cause);
  }
  if (std::any_of(kept.begin(), kept.end(), is_effect)) {
    const bool beside_one_form = std::all_of(kept.begin(), kept.end(), has_one_form);
    for (const std::string& cause : first.effects)
      if (is_effect(cause) && (beside_one_form || has_one_form(cause)) &&
          shares.beside_others(cause) >= options.min_share_of_rest)
        kept.insert(cause);
  }
  const auto rest = std::find_if(search.candidates.begin(), search.candidates.end(), [&](const Candidate& c) {
    return !c.with_unknown && set_of(c.effects) == kept;
  });
  if (rest == search.candidates.end()) return chosen;  // it was not compared without the others
  if (!kept.empty() && believable(first) && !believable(*rest)) return chosen;
  return static_cast<std::size_t>(rest - search.candidates.begin());
}

Naming as_chosen(const ExplanationSearch& search, std::size_t chosen) {
  const Candidate& c = search.candidates[chosen];
  return {c.unknown() ? std::vector<std::string>{} : c.effects, false, chosen, chosen, chosen};
}

}  // namespace

bool stands_beside_unknown(const EffectMarginal& marginal, const VerdictOptions& options) {
  return marginal.probability >= options.min_partial_probability &&
         marginal.closed_share >= options.min_partial_share;
}

Naming name_effects(const ExplanationSearch& search, std::size_t chosen,
                    std::span<const EffectMarginal> marginals, const CauseShares& shares,
                    const Believable& believable, const VerdictOptions& options) {
  if (!options.name_by_marginals) return as_chosen(search, chosen);
  chosen = of_weight(search, chosen, shares, believable, options);
  const Candidate& first = search.candidates[chosen];
  if (!first.unknown()) return as_chosen(search, chosen);
  const bool known_form = first.outside && !first.with_unknown;
  Names names;
  for (const EffectMarginal& m : marginals)
    if (stands_beside_unknown(m, options) || (known_form && stands_beside_form(m, options)))
      names.insert(m.name);
  if (names.empty()) return as_chosen(search, chosen);
  const auto any = candidate_with(search, names, [](const Candidate& c) { return c.unknown(); });
  const auto alone = candidate_with(search, names, [](const Candidate& c) { return !c.outside; });
  if (!any) return as_chosen(search, chosen);
  return {library_effects_of(search.candidates[*any]), true, chosen, *any, alone.value_or(*any)};
}

}  // namespace slipway::gap
