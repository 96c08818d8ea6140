#pragma once

#include "sim/wheel/wheel_forces.h"

namespace slipway::sim {

// The Zhurong paper's current model as printed: the entry angle from the closed form A18 and A19 (not from
// balance), the torque from A16 with c2's slip signed, and no gear. Kept so that the paper can be reproduced;
// predictions use the balanced entry angle and the rover's own motor.
struct ZhurongLiteral {
  double sinkage_m = 0.0;        // A18
  double entry_angle_rad = 0.0;  // A19
  double torque_nm = 0.0;        // A16
};

ZhurongLiteral zhurong_literal(const WheelGeometry& wheel, const Soil& soil, double load_n,
                               double slip_ratio);

// The paper's k_I [eq. 2] and the gear ratio that its printed 0.114 A implies: T / (k_I * 79.3) = 0.114 A at
// zero slip, where T / k_I = 9.04 A.
constexpr double kZhurongTorqueFactor = 0.1578;
constexpr double kZhurongImpliedGearRatio = 79.3;

}  // namespace slipway::sim
