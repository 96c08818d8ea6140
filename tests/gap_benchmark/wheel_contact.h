#pragma once

#include "hidden_truth.h"

namespace slipway::gap_benchmark {

// Soil under one wheel at one instant, with everything in force that depends on place, pass and time.
struct ContactSoil {
  double stiffness = 0.0;  // k_c / b + k_phi, N/m^(n+2)
  double n = 1.0, cohesion_pa = 0.0, tan_phi = 0.0, shear_modulus_m = 0.01, weight_n_m3 = 0.0;
  double c1 = 0.18, c2 = 0.32;
};

// Motion in the wheel's own plane: forward and left over the ground, and the rim's turning.
struct WheelMotion {
  double forward_m_s = 0.0, left_m_s = 0.0, rate_rad_s = 0.0;
};

struct WheelLoads {
  double normal_n = 0.0, pull_n = 0.0, side_n = 0.0;  // on the wheel; pull forward, side to the left
  double torque_nm = 0.0;                             // of the motor, positive turning forward
};

// Forces of the soil on a wheel sunk to a depth: Bekker's pressure under Wong and Reece's angle of greatest
// stress, Mohr-Coulomb strength, Janosi and Hanamoto's mobilisation, by Simpson's rule over the arc.
WheelLoads wheel_loads(double radius_m, double width_m, double depth_m, const WheelMotion& motion,
                       const ContactSoil& soil, const Closure& closure, const HiddenTruth& hidden);

}  // namespace slipway::gap_benchmark
