#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "gap/diagnosis.h"
#include "gap/window_variables.h"

namespace slipway::gap {

// Windows that meet all conditions, by their numbers in rising order.
struct Slice {
  std::vector<Condition> conditions;
  std::vector<std::size_t> windows;
};

// The slices that a gap is looked for in: each variable cut at its fifths, or at its values where there are
// few, and pairs of such pieces; none of very few windows or of nearly all.
std::vector<Slice> slices_of(std::span<const WindowVariables> variables);

}  // namespace slipway::gap
