#pragma once

#include <span>

#include "sim/soil/soil.h"

namespace slipway::sim {

// Cleats across a wheel's rim (effect grousers; also part of a rover's file).
struct Grousers {
  double height_m = 0.0;
  double count = 0.0;  // around the rim; need not be whole where it is estimated
  // Shear displacement at which a cleat's thrust is mobilised, over the soil's shear modulus along.
  double mobilisation = 1.0;
  // Share of that displacement that is made by slip alone, r s (theta_f - theta): 1 leaves out the way that
  // the rim's own path into the ground makes, so that cleats brake as they drive.
  double by_slip = 0.0;
  // Share of the rim's pressure beside a cleat that presses on the soil which the cleat pushes
  // (grouser_law.h).
  double surcharge = 0.0;
  double thrust = 1.0;   // share of the passive thrust that cleats have besides the shear at their radius
  double braking = 1.0;  // share of that thrust that brakes where the shear brakes
  // Where soil stands between the cleats and turns with them it is sheared at r + share h: the share as it is
  // given, and by_spacing times what the spacing makes of it (grouser_law.h).
  double shear_share = 0.0;
  double shear_by_spacing = 0.0;

  bool operator==(const Grousers&) const = default;
};

// What the laws need of a wheel.
struct WheelGeometry {
  double radius_m = 0.125;  // of the rim, without grousers
  double width_m = 0.16;
  Grousers grousers = {};
  // Of the soil's strength, what passes between the rim's surface and the soil: 1 for soil on soil, less for
  // smooth metal (effect smooth_rim).
  double rim_friction = 1.0;
};

// How a wheel moves over the ground, per rim speed r |w|. Frame W: x rolling direction, y left.
struct WheelMotion {
  double forward = 1.0;   // u = v_x / (r w); see slip_ratio.h
  double leftward = 0.0;  // v_y / (r |w|); tan(beta) = leftward / forward
};

// Forces of the soil on a wheel, at its centre, frame W, and the torque that drives it.
struct WheelForces {
  double drawbar_pull_n = 0.0;  // along x
  double lateral_n = 0.0;       // along y
  double vertical_n = 0.0;      // along z
  double torque_nm = 0.0;       // the motor's, about the axle, positive drives forward

  WheelForces operator-(const WheelForces& o) const {
    return {drawbar_pull_n - o.drawbar_pull_n, lateral_n - o.lateral_n, vertical_n - o.vertical_n,
            torque_nm - o.torque_nm};
  }
};

// clang-format off
// A rigid wheel on level soil with entry angle theta_f [ARTEMIS eq. 1 to 20; Wong & Reece 1967]:
//
//   theta_m = (c1 + c2 |i|) theta_f              angle of greatest normal stress                      (2)
//   theta_r = -c3 theta_f                        exit angle; c3 = 0 is perfectly plastic soil
//   z = r (cos theta - cos theta_f)              depth in front, theta_m < theta < theta_f            (1)
//   z = the depth in front at theta'             behind, theta_r < theta < theta_m, with              (1)
//       theta' = theta_f - (theta - theta_r) / (theta_m - theta_r) (theta_f - theta_m)
//   sigma = (k_c / b + k_phi) z^n'               normal stress, radial; crust and hard layer add
//   n' = n + n1 |i_v| + n1_skid max(0, -i_v) + n1_lateral sin^2(beta)    i_v: slip of the whole speed (22)
//   j_x = r (theta_f - theta - u (sin theta_f - sin theta))              u = 1 - i or 1 / (1 + i)     (5)
//   j_y = r (v_y / (r |w|)) (theta_f - theta)                            (9) and (10) as one
//   tau_x, tau_y = +-(c + sigma tan phi) (1 - exp(-|j| / K))             against the slipping         (3), (6)
//   DP = b r int(tau_x cos - sigma sin) + grousers - frontal bulldozing                               (16 to 18)
//   L  = b r int(tau_y) + side-wall bulldozing sin(beta), or sooner: early_mobilisation()                                              (11, 19)
//   W  = b r int(sigma cos + tau_x sin) + grousers                                                    (20)
//   T  = b r^2 int(tau_x) + grousers
//
// Grousers: grouser_law.h; bulldozing: bulldozing_law.h (front), terzaghi.h (sides), both fading out where a wheel
// spins almost on the spot (kStandingSpeedRatio in wheel_law.h). Equation 11 prints tan(theta) for tan(phi). As in
// ARTEMIS, tau_x and tau_y are mobilised independently, so that with both at full slip their resultant exceeds the
// strength by up to sqrt(2); Soil::shear_coupling takes that back. c2's slip is |i|, as in the drive-campaign
// format. Quadrature: arc_quadrature.h, error below 1e-5 of the load (tests). Compiled for several instruction sets
// (wheel_kernel.h).
//
//   sigma cos + tau_x sin >= 0 ahead of the axle: where a braked rim shears downwards, tau_x ends there
//
// The last: soil that would have to hang on to the rim breaks off. Without it what is borne fell with depth, and the
// pull of a balanced wheel in deep skid jumped by up to 17 loads.
//
// Properties: W rises with theta_f for a driven wheel without a crust (a braked one with a great c1 + c2 may carry
// most somewhere above the axle); all scale with b when k_c = 0; mirror:
// leftward -> -leftward flips L only.
// clang-format on
WheelForces wheel_forces(const WheelGeometry& wheel, const Soil& soil, double entry_angle_rad,
                         const WheelMotion& motion);

// The same for many soils at once, vectorised over them: spans of one length, one element a wheel.
void wheel_forces(const WheelGeometry& wheel, std::span<const Soil> soils,
                  std::span<const double> entry_angles_rad, std::span<const WheelMotion> motions,
                  std::span<WheelForces> forces);

// The laws' own limit: beyond it a wheel counts as sunk to its axle.
constexpr double kMaxEntryAngleRad = 1.5;
// Of soil that a wheel may plough deeper than its axle (Soil::ploughing): 1.7 radii deep.
constexpr double kMaxPloughingAngleRad = 2.35;
double max_entry_angle_rad(const Soil& soil);

// The radius at which the soil is sheared: between the rim and the tips of its cleats (grouser_law.h).
double shear_radius_m(const WheelGeometry& wheel, const Soil& soil);

// z = r (1 - cos theta_f)
double sinkage_m(double radius_m, double entry_angle_rad);
double entry_angle_rad(double radius_m, double sinkage_m);

}  // namespace slipway::sim
