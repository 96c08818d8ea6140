#pragma once

#include <string>

#include "api/steps/step_comparison.h"

namespace slipway::api {

// Measured slip over climb as dots, with the median and the 90 % band that were forecast, by bins of a
// degree: an SVG document.
std::string step_chart(const StepComparison& comparison);

}  // namespace slipway::api
