#pragma once

#include <Eigen/Core>

namespace slipway::sky {

enum class Planet { kEarth, kMars };

// From the sun [au], in the equator of J2000, at days of TDB since J2000: VSOP87B [Bretagnon and Francou,
// Planetary theories in rectangular and spherical variables, A&A 202, 1988], cut at amplitudes of 1e-5 rad
// and 1.5e-5 au. From 1800 to 2150 the direction from one to the other is within 0.012 deg of the whole
// series, which is within 0.04 arc seconds of JPL's DE441.
Eigen::Vector3d from_sun_au(Planet planet, double days);

}  // namespace slipway::sky
