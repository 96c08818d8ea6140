#include "sim/soil/soil_in_force.h"

#include <algorithm>
#include <cmath>

namespace slipway::sim {

Soil soil_in_force(Soil soil, double gravity_m_s2, double rim_speed_m_s, double share_in_track) {
  soil.gravity_m_s2 = gravity_m_s2;
  if (soil.rate_shear_exponent != 0.0) {
    const double ratio = std::max(rim_speed_m_s, 1e-4) / soil.rate_shear_speed_m_s;
    const double factor = std::pow(ratio, soil.rate_shear_exponent);
    soil.shear_modulus_x_m *= factor;
    soil.shear_modulus_y_m *= factor;
  }
  if (soil.gravity_exponent != 0.0)
    soil.stiffen(std::pow(gravity_m_s2 / soil.measured_gravity_m_s2, soil.gravity_exponent));
  put_in_track(soil, share_in_track);
  return soil;
}

bool remembers_tracks(const Soil& soil) {
  return soil.multipass_stiffening > 0.0 || (soil.bulldozing > 0.0 && soil.track_bulldozing != 1.0);
}

// The soil before a wheel in a track was pushed aside by the wheel that made it, or some of it.
TrackFactors track_factors(const Soil& soil, double share_in_track) {
  const double stiffening = soil.multipass_stiffening * share_in_track;
  return {.stiffness = 1.0 + stiffening,
          .shear = 1.0 + soil.multipass_strengthening * stiffening,
          .bulldozing = 1.0 - (1.0 - soil.track_bulldozing) * share_in_track};
}

void put_in_track(Soil& soil, double share_in_track) {
  const TrackFactors track = track_factors(soil, share_in_track);
  soil.stiffen(track.stiffness);
  soil.shear_strength_ratio *= track.shear;
  soil.bulldozing *= track.bulldozing;
}

}  // namespace slipway::sim
