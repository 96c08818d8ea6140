#include "sim/single_wheel/single_wheel_rig.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

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

// The radius that the slip is by, over the rim's.
double slip_radius_ratio(const WheelRigConditions& test) {
  if (test.slip_radius == SlipRadius::kRim) return 1.0;
  const double radius = test.slip_radius == SlipRadius::kTip
                            ? test.wheel.radius_m + test.wheel.grousers.height_m
                            : shear_radius_m(test.wheel, test.soil);
  return radius / test.wheel.radius_m;
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
    case RigOutcome::kImmobilised:
      return "immobilised";
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

WheelMotion motion_of(const WheelRigConditions& test) {
  const WheelMotion motion = test.slip_definition == SlipDefinition::kForward
                                 ? forward_motion(test.slip, test.slip_angle_rad)
                                 : rig_motion(test.slip, test.slip_angle_rad);
  const double ratio = slip_radius_ratio(test);
  return {motion.forward * ratio, motion.leftward * ratio};
}

double rim_speed_m_s(const WheelRigConditions& test) {
  const WheelMotion motion = motion_of(test);
  const double travel = std::hypot(motion.forward, motion.leftward);
  if (travel >= kLockedSpeedRatio * (1.0 - 1e-6)) return 0.0;
  return test.speed_is_of_travel && travel > 0.0 ? test.speed_m_s / travel : test.speed_m_s;
}

namespace {

// A wheel at the slip of its test.
WheelRigResult run_at_slip(const WheelRigConditions& test) {
  const WheelMotion motion = motion_of(test);
  const double rim_speed = rim_speed_m_s(test);
  const Soil met = soil_in_force(test.soil, test.gravity_m_s2, rim_speed, test.in_a_track ? 1.0 : 0.0);
  WheelRigResult result;
  result.slip = test.slip;
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

// The smallest slip from -0.99 to 0.99 at which the pull reaches the weight's part along the slope, the load
// being the part across it; the pull may fall again at more slip.
WheelRigResult run_on_slope(const WheelRigConditions& on_slope) {
  constexpr int kSteps = 99;
  WheelRigConditions test = on_slope;
  test.slope_rad.reset();
  test.load_n = on_slope.load_n * std::cos(*on_slope.slope_rad);
  const double asked = on_slope.load_n * std::sin(*on_slope.slope_rad);
  const auto at = [&](double slip) {
    test.slip = slip;
    return run_at_slip(test);
  };
  double best = -std::numeric_limits<double>::infinity(), best_slip = 0.0;
  std::optional<double> below;
  WheelRigResult last;
  for (int step = -kSteps; step <= kSteps; ++step) {
    const double slip = 0.01 * step;
    last = at(slip);
    if (!last.stands()) {
      below.reset();
      continue;
    }
    const double pull = last.forces.drawbar_pull_n;
    if (pull >= asked && below) {
      double low = *below, high = slip;
      for (int halving = 0; halving < 50; ++halving) {
        const double middle = 0.5 * (low + high);
        const WheelRigResult there = at(middle);
        (there.stands() && there.forces.drawbar_pull_n >= asked ? high : low) = middle;
      }
      return at(high);
    }
    if (pull < asked) below = slip;
    if (pull > best) best = pull, best_slip = slip;
  }
  if (best == -std::numeric_limits<double>::infinity()) return last;
  WheelRigResult stuck;
  stuck.outcome = RigOutcome::kImmobilised;
  stuck.slip = best_slip;
  stuck.reason = fmt::format(
      "immobilised: the slope asks for {:.4g} N of pull, at most {:.4g} N are there, at slip {:.2f}", asked,
      best, best_slip);
  return stuck;
}

}  // namespace

WheelRigResult run_wheel_rig(const WheelRigConditions& test) {
  return test.slope_rad ? run_on_slope(test) : run_at_slip(test);
}

}  // namespace slipway::sim
