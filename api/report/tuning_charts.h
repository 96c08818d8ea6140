#pragma once

#include <string>
#include <vector>

#include "api/chart/chart.h"
#include "campaign/tune.h"

namespace slipway::api {

// The score surface: a heat map for each pair of parameters, over the whole ranges and around the best, with
// the sweep's best set and the estimate by least squares with its ellipse of 95 %. Of one parameter: the
// score over it, of all drives and of each tilt.
std::vector<NamedChart> draw_tuning(const std::string& title, const campaign::TableTuning& result);

}  // namespace slipway::api
