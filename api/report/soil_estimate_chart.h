#pragma once

#include <string>

#include "gap/estimate/soil_estimation.h"

namespace slipway::api {

// Fitted against measured, a chart a channel, as SVG.
std::string draw_soil_estimate(const gap::SoilEstimate& estimate);

}  // namespace slipway::api
