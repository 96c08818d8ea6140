#pragma once

#include <span>
#include <string>

#include "gap/diagnosis/decide/search_record.h"
#include "gap/diagnosis/held_out/effect_marginals.h"
#include "gap/diagnosis/search/explanation_search.h"

namespace slipway::gap {

// The record of a search: what is told of explanations, fits and causes.
SearchRecord record_of(const ExplanationSearch& search, const ClosedShares& shares,
                       std::span<const std::string> library);

}  // namespace slipway::gap
