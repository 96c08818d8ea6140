#pragma once

#include <cstddef>
#include <vector>

#include "gap/diagnosis/model/window_model.h"

namespace slipway::gap {

// Turns a window's predicted slip and side slip into what is read along headings that are `off_rad` too far
// to the left. Where no slip was observed, the rover moves as commanded. Windows of turns in place stay as
// they are.
void read_along_turned_heading(const WindowModel& model, std::size_t window, double off_rad,
                               std::vector<double>& predicted);

}  // namespace slipway::gap
