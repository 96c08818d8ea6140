#include "gap/diagnosis/naming.h"

#include <algorithm>
#include <optional>
#include <set>

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

Naming as_chosen(const ExplanationSearch& search, std::size_t chosen) {
  const Candidate& c = search.candidates[chosen];
  return {c.unknown() ? std::vector<std::string>{} : c.effects, false, chosen, chosen};
}

// What was chosen without what closes next to nothing.
Naming of_weight(const ExplanationSearch& search, std::size_t chosen,
                 std::span<const EffectMarginal> marginals, const VerdictOptions& options) {
  Naming naming = as_chosen(search, chosen);
  std::erase_if(naming.effects, [&](const std::string& effect) {
    return std::any_of(marginals.begin(), marginals.end(), [&](const EffectMarginal& m) {
      return m.name == effect && m.closed_share < options.min_closed_share;
    });
  });
  const auto alone =
      candidate_with(search, set_of(naming.effects), [](const Candidate& c) { return !c.unknown(); });
  if (!alone) return as_chosen(search, chosen);  // their sum was not compared without the others
  naming.candidate = naming.correction = *alone;
  naming.effects = search.candidates[*alone].effects;
  return naming;
}

}  // namespace

bool stands_beside_unknown(const EffectMarginal& marginal, const VerdictOptions& options) {
  return marginal.probability >= options.min_partial_probability &&
         marginal.closed_share >= options.min_partial_share;
}

Naming name_effects(const ExplanationSearch& search, std::size_t chosen,
                    std::span<const EffectMarginal> marginals, const VerdictOptions& options) {
  if (!options.name_by_marginals) return as_chosen(search, chosen);
  if (!search.candidates[chosen].unknown()) return of_weight(search, chosen, marginals, options);
  const Candidate& first = search.candidates[chosen];
  const bool known_form = first.outside && !first.with_unknown;
  Names names;
  for (const EffectMarginal& m : marginals)
    if (stands_beside_unknown(m, options) || (known_form && stands_beside_form(m, options)))
      names.insert(m.name);
  if (names.empty()) return as_chosen(search, chosen);
  const auto any = candidate_with(search, names, [](const Candidate& c) { return c.unknown(); });
  const auto alone = candidate_with(search, names, [](const Candidate& c) { return !c.outside; });
  if (!any) return as_chosen(search, chosen);
  Naming naming{library_effects_of(search.candidates[*any]), true, *any, alone.value_or(*any)};
  return naming;
}

std::size_t without_weightless_outside(const ExplanationSearch& search, std::size_t chosen,
                                       const std::function<double(const std::string&)>& closed_share,
                                       const VerdictOptions& options) {
  const Candidate& first = search.candidates[chosen];
  const std::vector<std::string> effects = library_effects_of(first);
  if (!options.name_by_marginals || !first.outside || first.with_unknown || effects.empty()) return chosen;
  if (closed_share(outside_causes_of(first).front()) >= options.min_closed_share) return chosen;
  return candidate_with(search, set_of(effects), [](const Candidate& c) { return !c.unknown(); })
      .value_or(chosen);
}

}  // namespace slipway::gap
