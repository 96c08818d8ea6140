#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "sim/rover/motor.h"
#include "sim/soil/soil.h"
#include "sim/wheel/wheel_forces.h"

namespace slipway::sim {

// What a given slip compares the rim's speed r w with.
enum class SlipDefinition {
  kForward,  // the speed v_x along the wheel's plane: slip_ratio.h, as everywhere else here
  kTravel,   // the speed |v| of travel, in whatever direction: as many test rigs report it
};

// Which radius the rim's speed in a slip is taken at. Wheels with cleats are reported by their tips too.
enum class SlipRadius {
  kRim,
  kShear,  // where the soil is sheared (shear_radius_m)
  kTip,    // of the cleats
};

// The motion at a slip of 1 and below -1 is a limit: a locked wheel has r w = 0. The law is the same to nine
// digits at this many times the rim's speed as at infinity.
constexpr double kLockedSpeedRatio = 1e9;

// Slip i by the forward speed, slip angle beta with tan(beta) = v_y / v_x, |beta| < 90 deg:
//   v_x / (r w) = 1 - i (i >= 0), 1 / (1 + i) (i < 0)        v_y = v_x tan(beta)
WheelMotion forward_motion(double slip, double slip_angle_rad);

// Slip s by the speed of travel, of a rig that travels straight at an angle beta to the wheel's plane [as the
// tests of Pavlov & Johnson 2022 are reported]: s = (r w - |v|) / max(|v|, r w).
//   |v| / (r w) = 1 - s (s >= 0), 1 / (1 + s) (s < 0)        v_x = |v| cos(beta), v_y = |v| sin(beta)
// At 90 deg the wheel moves sideways only. Near it, soil with independent shear (Soil::shear_coupling 0)
// keeps the rim's whole thrust however fast the wheel is dragged sideways, even locked: use coupled shear
// there.
WheelMotion rig_motion(double slip, double slip_angle_rad);

// One steady test of a single wheel on level soil: how it is held and moved.
struct WheelRigConditions {
  WheelGeometry wheel;
  Soil soil;  // of the place, with its effects; what gravity, speed and track make of it is done here
  double gravity_m_s2 = 3.71;
  double load_n = 100.0;
  std::optional<double>
      sinkage_m;  // given: held at this depth; otherwise free to sink until it carries load_n
  double slip = 0.0;
  double slip_angle_rad = 0.0;
  SlipDefinition slip_definition = SlipDefinition::kForward;
  SlipRadius slip_radius = SlipRadius::kRim;
  // Given: the wheel climbs a slope of this angle under the weight load_n, straight on, at the slip at which
  // its pull is the weight's part along the slope; `slip` is then not read.
  std::optional<double> slope_rad;
  // One of the two speeds is held. A locked wheel's is the travel's, a wheel's that spins on the spot the
  // rim's.
  double speed_m_s = 0.04;
  bool speed_is_of_travel = false;  // otherwise of the rim
  bool in_a_track = false;          // of an earlier wheel (effect multipass)
  std::optional<DriveMotor> drive;  // for the current; at its working temperature
};

enum class RigOutcome {
  kBalanced,     // the soil carries the load
  kHeld,         // at the given depth
  kSunkToAxle,   // no depth up to the axle carries the load
  kImmobilised,  // on a slope: no slip pulls the weight's part along it
  kNotBalanced,  // the solver found no depth that carries it to 1e-6: soil far harder than any, at a tiny
                 // load
};

// "balanced", "held", "sunk_to_axle", "immobilised", "not_balanced".
std::string_view describe(RigOutcome outcome);

// What a rig reports. Where the wheel does not stand nothing but slip, angle and reason is said.
struct WheelRigResult {
  RigOutcome outcome = RigOutcome::kBalanced;
  std::string reason;  // of an outcome that is no balance
  double slip = 0.0;   // of the test, or what a slope asks for
  double entry_angle_rad = 0.0;
  double exit_angle_rad = 0.0;  // theta_r, negative behind the lowest point
  double sinkage_m = 0.0;       // of the lowest point of the rim
  WheelForces forces;
  // The parts of drawbar pull = thrust - compaction - bulldozing resistance [Wong 2010, chapter 2]:
  double thrust_n = 0.0;                 // b r int(tau cos theta), grousers included
  double compaction_resistance_n = 0.0;  // b r int(sigma sin theta)
  double bulldozing_resistance_n = 0.0;
  std::optional<double> current_a;
  // Pull times v_x over torque times rate; where the wheel drives (T > 0) and pulls (DP >= 0).
  std::optional<double> tractive_efficiency;

  bool stands() const { return outcome == RigOutcome::kBalanced || outcome == RigOutcome::kHeld; }
};

// The motion of a test at its own slip.
WheelMotion motion_of(const WheelRigConditions& test);

// The rates are those of the test: r w of the rim, 0 for a locked wheel.
double rim_speed_m_s(const WheelRigConditions& test);
WheelRigResult run_wheel_rig(const WheelRigConditions& test);

}  // namespace slipway::sim
