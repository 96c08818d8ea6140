#pragma once

#include <string>

#include "research/validation/cuadriga/cuadriga_held_out.h"

namespace slipway::validation {

// Slip and charge per metre against gradient: held-out windows as dots, and the prediction by the fit of all
// logs for a window at the median turn rate and wheel speed (median, 50 and 90 % intervals).
std::string draw_cuadriga_drives(const std::string& title, const CrossValidation& answer);

}  // namespace slipway::validation
