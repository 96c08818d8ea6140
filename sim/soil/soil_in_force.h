#pragma once

#include "sim/soil/soil.h"

namespace slipway::sim {

// The soil as one wheel meets it, from the soil of its place: under the place's gravity (effect
// soil_gravity), at the wheel's rim speed (effect rate_shear) and, where an earlier wheel made a track,
// compacted (effect multipass) and without soil to push before it, or less of it (effect bulldozing).
Soil soil_in_force(const Soil& soil, double gravity_m_s2, double rim_speed_m_s, bool in_a_track);

}  // namespace slipway::sim
