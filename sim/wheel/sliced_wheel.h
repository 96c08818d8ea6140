#pragma once

#include <array>
#include <span>

#include "sim/wheel/wheel_forces.h"

namespace slipway::sim {

constexpr int kMaxSlices = 9;

// A wheel on ground whose height differs across its width, divided into N slices normal to its axle, each
// with an entry and an exit angle of its own [ARTEMIS section 2.1]. Slices of equal width b / N from the
// right face to the left, slice s at y_s = b ((s + 1/2) / N - 1/2), over ground of height h_s above the level
// from which the sinkage z is counted:
//
//   z_s = z + h_s                        a slice with z_s <= 0 hangs in the air and carries nothing
//   theta_f,s = acos(1 - z_s / r)        theta_r,s = -c3 theta_f,s
//   F = sum F_s    M_x = sum y_s W_s     about the rolling direction, positive presses the left side up
//
// F_s are the forces of a wheel of width b / N (wheel_forces.h) but for two things: the soil under it feels
// the whole wheel, so that its stiffness stays k_c / b + k_phi; and of the side walls only the outer one on
// the side that the wheel slides to meets soil. All slices move alike. Properties: on level ground the slices
// together are the whole wheel; M_x has the sign of the side that is higher; it turns its sign with the
// ground mirrored in y.
struct SliceContact {
  double entry_angle_rad = 0.0, exit_angle_rad = 0.0;  // both 0 in the air
  double vertical_n = 0.0;
};

struct SlicedWheelForces {
  WheelForces total;
  double overturning_nm = 0.0;
  std::array<SliceContact, kMaxSlices> slices{};  // as many as there are heights
};

// One height a slice, 1 to kMaxSlices of them.
SlicedWheelForces sliced_wheel_forces(const WheelGeometry& wheel, const Soil& soil,
                                      std::span<const double> ground_height_m, double sinkage_m,
                                      const WheelMotion& motion);

// Distance of a slice from the wheel's middle, positive to the left.
double slice_offset_m(double width_m, int slice, int slices);

}  // namespace slipway::sim
