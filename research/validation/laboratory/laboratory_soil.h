#pragma once

#include "core/angle.h"
#include "sim/soil/soil.h"

namespace slipway::validation {

// A soil with the parameters that papers print and defaults for all others. The cohesion is in Pa, the
// friction angle in degrees, and the shear modulus K in m; c1 and c2 give the angle of maximum stress.
inline sim::Soil laboratory_soil(const sim::BekkerModuli& moduli, double cohesion_pa, double friction_deg,
                                 double shear_modulus_m, double c1, double c2) {
  sim::Soil soil;
  soil.pressure = moduli;
  soil.cohesion_pa = cohesion_pa;
  soil.friction_angle_rad = rad_from_deg(friction_deg);
  soil.shear_modulus_x_m = soil.shear_modulus_y_m = shear_modulus_m;
  soil.c1 = c1;
  soil.c2 = c2;
  return soil;
}

// The nominal soil of the practice campaigns of the drive-campaign format.
inline sim::Soil practice_soil() {
  return laboratory_soil({20000.0, 1.2e6, 0.95}, 1500.0, 36.0, 0.01, 0.18, 0.32);
}

// Row "JLU Mars 3 loose" of the Zhurong paper's Table 1, c1 and c2 of its Table A1.
inline sim::Soil jlu_mars_3_loose() {
  return laboratory_soil({3125.0, 536156.0, 0.867}, 102.0, 33.2, 0.0171, 0.285, 0.32);
}

}  // namespace slipway::validation
