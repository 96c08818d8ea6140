#pragma once

#include <string>
#include <vector>

#include "gap/diagnosis/search/explanation_search.h"

namespace slipway::gap {

// A note for each parameter of a library effect that is estimated at an end of its range where the effect is
// strongest: the drives may then ask for more than that effect can do. Parameters that say in which form it
// acts, and ends at which it does nothing, have none.
std::vector<std::string> notes_of_ends_of_ranges(const FittedExplanation& fit);

}  // namespace slipway::gap
