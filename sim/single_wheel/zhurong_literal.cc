#include "sim/single_wheel/zhurong_literal.h"

#include "sim/wheel/entry_angle.h"
#include "sim/wheel/slip_ratio.h"

namespace slipway::sim {

ZhurongLiteral zhurong_literal(const WheelGeometry& wheel, const Soil& soil, double load_n,
                               double slip_ratio) {
  ZhurongLiteral literal;
  literal.sinkage_m = bekker_sinkage_m(wheel, soil, load_n);
  literal.entry_angle_rad = entry_angle_rad(wheel.radius_m, literal.sinkage_m);
  const WheelMotion motion{.forward = speed_ratio_from_slip(slip_ratio), .leftward = 0.0};
  literal.torque_nm = wheel_forces(wheel, soil, literal.entry_angle_rad, motion).torque_nm;
  return literal;
}

}  // namespace slipway::sim
