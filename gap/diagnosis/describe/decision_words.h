#pragma once

#include <optional>
#include <span>
#include <string>

#include "gap/diagnosis/decide/decision.h"
#include "gap/diagnosis/follow/followed_drives.h"
#include "gap/diagnosis/model/reference_belief.h"
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

// Of drives that have changed although no explanation of all of them is more probable than none. `reference`:
// null where the first of them were taken as healthy.
std::string changed_words(const FollowedDrives& followed, const ReferenceBelief* reference);

}  // namespace slipway::gap
