#include "sim/soil/soil_in_force.h"

#include <algorithm>
#include <cmath>

namespace slipway::sim {

Soil soil_in_force(const Soil& soil, double gravity_m_s2, double rim_speed_m_s, bool in_a_track) {
  Soil met = soil;
  met.gravity_m_s2 = gravity_m_s2;
  if (soil.rate_shear_exponent != 0.0) {
    const double ratio = std::max(rim_speed_m_s, 1e-4) / soil.rate_shear_speed_m_s;
    const double factor = std::pow(ratio, soil.rate_shear_exponent);
    met.shear_modulus_x_m *= factor;
    met.shear_modulus_y_m *= factor;
  }
  // The soil before a wheel in a track was pushed aside by the wheel that made it, or some of it.
  if (in_a_track) met.bulldozing *= soil.track_bulldozing;
  double stiffer = in_a_track ? 1.0 + soil.multipass_stiffening : 1.0;
  if (soil.gravity_exponent != 0.0)
    stiffer *= std::pow(gravity_m_s2 / soil.measured_gravity_m_s2, soil.gravity_exponent);
  met.stiffen(stiffer);
  return met;
}

}  // namespace slipway::sim
