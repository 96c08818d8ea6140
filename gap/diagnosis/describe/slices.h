#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "gap/diagnosis/model/window_variables.h"
#include "gap/diagnosis/result/result.h"

namespace slipway::gap {

// Windows that meet all conditions, by their numbers in rising order.
struct Slice {
  std::vector<Condition> conditions;
  std::vector<std::size_t> windows;
};

// How few of so many windows a slice may have.
std::size_t least_of_slice(std::size_t windows, const SliceOptions& options = {});

// The slices that a gap is looked for in: each variable cut at its fifths, or at its values where there are
// few, the lowest and the highest of these together ("above 8 deg"), and pairs of such pieces of two
// variables; none of fewer windows than that, or of more than SliceOptions::max_share of them.
std::vector<Slice> slices_of(std::span<const WindowVariables> variables, const SliceOptions& options = {});

}  // namespace slipway::gap
