#pragma once

#include <string>
#include <vector>

#include "api/chart/chart.h"

namespace slipway::validation {

// Predicted against measured values, with the line where they agree. quantity is the axis title with its
// unit.
api::Chart scatter_chart(const std::string& quantity, const std::vector<double>& measured,
                         const std::vector<double>& predicted);

}  // namespace slipway::validation
