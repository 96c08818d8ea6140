#include "sim/single_wheel/single_wheel_rig.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sim/soil/soil_in_force.h"
#include "sim/wheel/entry_angle.h"
#include "sim/wheel/slip_ratio.h"

namespace slipway::sim {
namespace {

constexpr double kBalanceTolerance = 1e-6;  // of the load

// |v| / (r w) of a slip in [-1, 1].
double bounded_speed_ratio(double slip) {
  return slip <= -1.0 + 1.0 / kLockedSpeedRatio ? kLockedSpeedRatio : speed_ratio_from_slip(slip);
}

WheelMotion motion_of(const WheelRigConditions& test) {
  return test.slip_definition == SlipDefinition::kForward ? forward_motion(test.slip, test.slip_angle_rad)
                                                          : rig_motion(test.slip, test.slip_angle_rad);
}

// Splits the pull by taking parts of the law away: without shear strength only the normal stress is left.
void split_pull(const WheelRigConditions& test, const Soil& met, const WheelMotion& motion,
                WheelRigResult& result) {
  const auto pull = [&](const WheelGeometry& wheel, const Soil& soil) {
    return wheel_forces(wheel, soil, result.entry_angle_rad, motion).drawbar_pull_n;
  };
  Soil soil = met;
  soil.bulldozing = soil.side_bulldozing = 0.0;
  soil.ploughing = {};
  result.bulldozing_resistance_n = pull(test.wheel, soil) - result.forces.drawbar_pull_n;
  soil.cohesion_pa = soil.friction_angle_rad = 0.0;
  WheelGeometry smooth = test.wheel;
  smooth.grousers = {};
  result.compaction_resistance_n = -pull(smooth, soil);
  result.thrust_n =
      result.forces.drawbar_pull_n + result.compaction_resistance_n + result.bulldozing_resistance_n;
}

}  // namespace

std::string_view describe(RigOutcome outcome) {
  switch (outcome) {
    case RigOutcome::kBalanced:
      return "balanced";
    case RigOutcome::kHeld:
      return "held";
    case RigOutcome::kSunkToAxle:
      return "sunk_to_axle";
    case RigOutcome::kNotBalanced:
      break;
  }
  return "not_balanced";
}

WheelMotion forward_motion(double slip, double slip_angle_rad) {
  const double u = bounded_speed_ratio(slip);
  return {u, u * std::tan(slip_angle_rad)};
}

WheelMotion rig_motion(double slip, double slip_angle_rad) {
  const double travel = bounded_speed_ratio(slip);
  return {travel * std::cos(slip_angle_rad), travel * std::sin(slip_angle_rad)};
}

double rim_speed_m_s(const WheelRigConditions& test) {
  const WheelMotion motion = motion_of(test);
  const double travel = std::hypot(motion.forward, motion.leftward);
  if (travel >= kLockedSpeedRatio * (1.0 - 1e-6)) return 0.0;
  return test.speed_is_of_travel && travel > 0.0 ? test.speed_m_s / travel : test.speed_m_s;
}

WheelRigResult run_wheel_rig(const WheelRigConditions& test) {
  const WheelMotion motion = motion_of(test);
  const double rim_speed = rim_speed_m_s(test);
  const Soil met = soil_in_force(test.soil, test.gravity_m_s2, rim_speed, test.in_a_track);
  WheelRigResult result;
  if (test.sinkage_m) {
    result.outcome = RigOutcome::kHeld;
    result.entry_angle_rad = entry_angle_rad(test.wheel.radius_m, *test.sinkage_m);
  } else {
    const auto balanced = balanced_entry_angle_rad(test.wheel, met, test.load_n, motion);
    if (!balanced) {
      result.outcome = RigOutcome::kSunkToAxle;
      result.reason = balanced.error().detail;
      return result;
    }
    result.entry_angle_rad = *balanced;
  }
  result.forces = wheel_forces(test.wheel, met, result.entry_angle_rad, motion);
  if (const double carried = result.forces.vertical_n;
      !test.sinkage_m && std::abs(carried - test.load_n) > kBalanceTolerance * test.load_n) {
    result.outcome = RigOutcome::kNotBalanced;
    result.reason = fmt::format("not balanced: {:.4g} N are carried of {:.4g} N where the solver stopped",
                                carried, test.load_n);
    return result;
  }
  result.exit_angle_rad = 0.0 - met.exit_angle_ratio * result.entry_angle_rad;
  result.sinkage_m = sinkage_m(test.wheel.radius_m, result.entry_angle_rad);
  split_pull(test, met, motion, result);
  const double rate = rim_speed / test.wheel.radius_m;
  if (test.drive) result.current_a = motor_state(*test.drive, result.forces.torque_nm, rate).current_a;
  if (result.forces.torque_nm > 0.0 && result.forces.drawbar_pull_n >= 0.0)
    result.tractive_efficiency =
        result.forces.drawbar_pull_n * motion.forward * test.wheel.radius_m / result.forces.torque_nm;
  return result;
}

}  // namespace slipway::sim
