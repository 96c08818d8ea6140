#pragma once

#include <string>
#include <vector>

#include "api/chart/chart.h"

namespace slipway::validation {

// Predicted against measured, one point each, with the line where they agree. quantity: with its unit.
api::Chart scatter_chart(const std::string& quantity, const std::vector<double>& measured,
                         const std::vector<double>& predicted);

}  // namespace slipway::validation
