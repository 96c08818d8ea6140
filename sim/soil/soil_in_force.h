#pragma once

#include "sim/soil/soil.h"

namespace slipway::sim {

// The soil as one wheel meets it, from the soil of its place: under the place's gravity (effect
// soil_gravity), at the wheel's rim speed (effect rate_shear) and, for the share of the wheel's width that
// stands in the track of an earlier wheel, compacted (effect multipass) and without soil to push before it,
// or less of it (effect bulldozing).
Soil soil_in_force(Soil soil, double gravity_m_s2, double rim_speed_m_s, double share_in_track);

// Whether a track differs from fresh soil.
bool remembers_tracks(const Soil& soil);

// What a track changes, for the share of a wheel's width that stands in it: how many times as stiff as fresh
// soil the soil is, how many times as cohesive and as stiff in shear, and how much of the soil before the
// wheel is left.
struct TrackFactors {
  double stiffness = 1.0, shear = 1.0, bulldozing = 1.0;
};
TrackFactors track_factors(const Soil& soil, double share_in_track);

// Makes a soil the one that a wheel meets which stands in a track with this share of its width.
void put_in_track(Soil& soil, double share_in_track);

}  // namespace slipway::sim
