#pragma once

#include "core/result.h"
#include "sim/wheel/wheel_forces.h"

namespace slipway::sim {

// k in N/m^(n+2) of the pressure p = k z^n under this wheel: k_c / b + k_phi of Bekker's law, and what stands
// in its place in another law's form (PressureForm).
double power_stiffness(const WheelGeometry& wheel, const Soil& soil);

// Bekker's closed form for the sinkage of a towed wheel [Bekker 1956; Zhurong eq. A18]:
//
//   z0 = (3 W / ((3 - n) b (k_c / b + k_phi) sqrt(D)))^(2 / (2 n + 1))
//
// Valid for n < 3 and small sinkage; it carries less than the load when the depth is a good part of the
// radius. On a soil with another law the stiffness is that of the law's form (PressureForm), as a power of z.
double bekker_sinkage_m(const WheelGeometry& wheel, const Soil& soil, double load_n);

// The entry angle at which the soil carries the load [ARTEMIS eq. 20]: W(theta_f) = load; the shallowest
// where several do. Newton kept inside a bracket. Errors: not_converged where no angle up to
// kMaxEntryAngleRad carries the load (sunk to the axle); the detail says how much is carried at most.
// load_n > 0.
Result<double> balanced_entry_angle_rad(const WheelGeometry& wheel, const Soil& soil, double load_n,
                                        const WheelMotion& motion);

}  // namespace slipway::sim
