#pragma once

#include <vector>

#include "api/requests/wheel_sweep_request.h"
#include "core/result.h"

namespace slipway::api {

// What a sweep of a whole rover can't be asked for, since its weight, its motion and its tracks follow: a
// load, a slip, a depth, a wheel of its own. A slope must be given or swept. Pointers as those of
// sim::faults_of.
std::vector<Fault> whole_rover_faults(const WheelSweepRequest& request);

// The balance of the whole rover (sim::QuasiStaticSolver) at every row of the sweep: it climbs a plane of
// that slope straight up, or down where it is negative, at the speed that is commanded; loads follow from its
// lean.
std::vector<RoverOnSlope> rovers_on_slopes(const sim::WheelSweep& sweep);

}  // namespace slipway::api
