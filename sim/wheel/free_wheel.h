#pragma once

#include "sim/wheel/wheel_forces.h"

namespace slipway::sim {

// A wheel that turns as the ground turns it.
struct FreeRolling {
  double rim_ratio = 0.0;  // rho = r w / v_ref, the rim's speed over the reference speed
  WheelMotion motion;      // over the ground, per rim speed
  WheelForces forces;
};

// The rate of a wheel without a motor: the soil's torque just overcomes the drag of its bearing and gear,
//
//   T(rho) = -T_drag,   u = v_x / rho,   v_y / (r w) = v_y / rho
//
// v_x, v_y: the wheel's velocity over v_ref, `over_ground`. T rises with rho: a rim at the ground's speed
// still pushes soil backwards (T(v_x) > 0), a locked one is pushed (T < 0), so the root is a small skid and
// is bracketed. Where even the locked wheel's torque does not overcome the drag, or where the wheel goes
// backwards against its direction, it stays at `slowest_ratio`: locked.
FreeRolling roll_freely(const WheelGeometry& wheel, const Soil& soil, double entry_angle_rad,
                        const WheelMotion& over_ground, double drag_nm, double slowest_ratio);

}  // namespace slipway::sim
