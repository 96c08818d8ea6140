#pragma once

#include <span>
#include <string>

#include "gap/estimate/least_squares.h"

namespace slipway::validation {

// "n0 0.87 +- 0.06, K 0.0049 +- 0.0008 (at its bound)": estimates with their standard errors, for a note.
std::string words_of(std::span<const gap::Unknown> unknowns, const gap::LeastSquaresFit& fit);

}  // namespace slipway::validation
