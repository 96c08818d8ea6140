#pragma once

#include <optional>
#include <span>
#include <string>

#include "gap/diagnosis/decide/decision.h"
#include "gap/diagnosis/result/result.h"

namespace slipway::gap {

// The sentences of a decision: what was found and how sure that is, and what would overturn it.
struct DecisionWords {
  std::string reason, overturned_by;
};
// `outside`: the cause from outside that stands for what is unknown, where it has a known form.
DecisionWords words_of(const Decision& decision, const SearchRecord& record,
                       std::span<const EffectMarginal> marginals,
                       const std::optional<OutsideFinding>& outside);

}  // namespace slipway::gap
