#pragma once

#include <vector>

#include "planner/problem/motion.h"
#include "sim/prediction/drive_prediction.h"

namespace slipway::planner {

// The motions as stations for the simulator: on driven parts at most sim::max_station_spacing_m apart, in
// turns in place at most 15 deg. A station's flags tell how it was reached from the one before it. Never
// empty; where a motion ends, the last station has exactly its place and heading.
std::vector<sim::PathStation> route_stations(const std::vector<Motion>& motions, double spacing_m);

// The first station of a drive at a distance or behind it, within rounding; else the last. `drive` has some.
const sim::StationPrediction& station_at(const sim::DrivePrediction& drive, double at_m);

}  // namespace slipway::planner
