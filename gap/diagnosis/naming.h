#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gap/diagnosis/result/result.h"
#include "gap/diagnosis/search/diagnosis_options.h"
#include "gap/diagnosis/search/explanation_search.h"

namespace slipway::gap {

// Which effects an answer names.
struct Naming {
  std::vector<std::string> effects;
  // Something unexplained stays beside them: a partial answer.
  bool partial = false;
  // The candidate that was chosen, without what closes too little.
  std::size_t chosen = 0;
  // The candidate whose fit has the effects' parameters, and the one of these effects alone, by which the
  // drives are corrected; the same unless a cause from outside stands beside them. Without effects: `chosen`.
  std::size_t candidate = 0, correction = 0;
};

// What an effect or a cause from outside closes of the held-out gap.
struct CauseShares {
  using Share = std::function<double(const std::string& cause)>;
  Share of_gap;         // ClosedShares::of
  Share beside_others;  // ClosedShares::beside_others
};

// How far an explanation bends what was believed.
struct Beliefs {
  std::function<double(const Candidate& candidate)> closure_shift;  // furthest_closure(), without its sign
  // beyond_belief(), or a scatter between drives beyond VerdictOptions::max_scatter
  std::function<bool(const Candidate& candidate)> are_bent_beyond;
};

// Names by the marginal probabilities and the shares of the gap that go with the causes. A cause that closes
// less than VerdictOptions::min_closed_share is left out of what was chosen, if the rest was compared; so is
// a law of ground or motors beside another, of which it closes less than min_share_of_law, and as little of
// what acts at a place beside a law of the ground: that much another equation of the other one may close.
// Beside an effect that closes more, an effect is left out only if it also closes less than min_share_of_rest
// of what the other leaves, where either of the two has one form: what is left is then not the other form of
// the one that another could mimic. An effect is also kept where without it a closure would go beyond
// max_stand_in_shift that is within with it: the closure stands in for the effect. What closes less than
// min_named_share in all is not named; where its evidence is strong (strong_evidence), doubts.h says so.
// Instead of an explanation that is bent beyond belief a larger one of the same causes is taken that is not
// bent, if it has believable_share of its probability and each of its causes has some weight. Of an
// explanation that is bent beyond belief only those effects are kept that are as good as certain, if nothing
// is bent with them alone, and otherwise those that stand_beside_unknown(), where they were compared and
// there are any. Where nothing unknown is among the rest, it is named. Where something unknown is, those
// effects are named that stand beside it; of several these must stand together in an explanation that was
// compared. The effects of what was chosen are also named where each of them has min_partial_probability,
// closes min_closed_share, and closes min_partial_share of what the others leave. Where what was chosen is a
// cause from outside, so that the unknown has a known form, min_certain_share does with
// min_certain_probability, or min_probability_closing_most of an effect that closes min_partial_share; a
// law of all wheels may close as much of what the cause from outside leaves, and min_closed_share in all.
// Beside something unknown nothing that may be how another wheel law differs (may_be_wheel_law) is named
// where what was chosen is bent beyond belief.
Naming name_effects(const ExplanationSearch& search, std::size_t chosen,
                    std::span<const EffectMarginal> marginals, const CauseShares& shares,
                    const Beliefs& beliefs, const VerdictOptions& options);

// Whether a cause is an effect of the library that acts at a place: a patch of soft soil.
bool acts_at_a_place(const std::string& cause);

// min_certain_probability and min_certain_share are reached.
bool as_good_as_certain(const EffectMarginal& marginal, const VerdictOptions& options);

// Whether an effect could be how another wheel law differs from this one: it changes what ground or gears do
// to all wheels alike, wherever and however warm they turn.
bool may_be_wheel_law(const std::string& effect);

// Whether an effect may be named beside something of no known form: it has min_partial_probability and closes
// min_partial_share, or it is no law of all wheels, has strong_evidence and closes min_certain_share.
// `another_law`: what is bent beyond belief says that the wheel law is another one, so that no law of all
// wheels may be named.
bool stands_beside_unknown(const EffectMarginal& marginal, bool another_law, const VerdictOptions& options);

// A partial answer with exactly these names; nothing where no explanation with something unknown has them.
std::optional<Naming> name_partially(const ExplanationSearch& search, std::size_t chosen,
                                     std::span<const std::string> names);

}  // namespace slipway::gap
