#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

namespace slipway::gap_benchmark {

// A soil as in campaign.json, with angles in radians. It is not the library's type, since this program shares
// no code with the library.
struct TrueSoil {
  std::string name;
  double k_c = 20000.0, k_phi = 1.2e6, n = 0.95;
  double cohesion_pa = 1500.0, friction_rad = 0.6283185307179586, shear_modulus_m = 0.01;
  double density_kg_m3 = 1500.0, c1 = 0.18, c2 = 0.32;
};

// Closure parameters of the wheel law and of the suspension, which cannot be measured on the soil.
struct Closure {
  bool parabolic_stress = false;  // instead of Wong and Reece's two branches of Bekker's power
  bool coupled_shear = false;     // one vector of shear displacement instead of one along and one across
  double lateral_modulus = 1.0;   // shear modulus across over that along; no campaign varies it
  double exit_share = 0.0;        // exit angle over entry angle, behind the lowest point
  double rise_share = 0.0;  // soil heaped before the rim, over the sinkage: the arc of contact starts higher
  double pull_below_axle = 1.0;  // 1: pulls act on the ground below the axle; 0: torque reacts on the carrier
};

// The hidden causes, which act in the drives and in no prediction. A value of 0, or of 1 for factors, means
// absence.
struct HiddenTruth {
  bool other_equations = true;  // false for the library's own equations, in other code

  double slip_sinkage = 0.0;  // n1
  double multipass = 0.0;     // stiffening
  double grouser_height_m = 0.0, grouser_count = 0.0;
  double bulldozing = 0.0, side_bulldozing = 0.0;
  std::array<double, 3> com_shift_m{};
  double kt_per_k = 0.0, friction_per_k = 0.0;
  double gear_torque_nm = 0.0, gear_viscous_nms_rad = 0.0;
  double radius_scale = 0.0;
  int dragging = -1;
  double dragging_rate_share = 1.0, dragging_nm = 0.0;
  double rate_exponent = 0.0;
  double crust_pa = 0.0, crust_depth_m = 0.005;
  double hardpan_pa_m = 0.0, hardpan_depth_m = 0.01;
  double patch_x_m = 0.0, patch_y_m = 0.0, patch_radius_m = 0.0, patch_weakening = 0.0;
  double steering_rad = 0.0;
  int steered = -1;  // all
  double roll_bias_rad = 0.0, pitch_bias_rad = 0.0;
  bool bias_of_gravity =
      false;  // true where map and inclinometer share it, false where only the inclinometer has it

  // Causes that are outside every library.
  double tether_n = 0.0;
  double wind_n = 0.0, wind_rad = 0.0;  // a push in one direction of the map
  double odometry_yaw_scale = 0.0;
  double current_gain_drift = 0.0;  // from the first drive to the last
  int slipping_hub = -1;
  double hub_share = 0.0;        // maximum share of the rim's speed that is lost, once a turn
  double solar_softening = 0.0;  // share of friction and cohesion lost at noon
  // What the world does to the vehicle. Forces are in newtons; those of drags are against the travel.
  double push_forward_n = 0.0, push_left_n = 0.0;  // in the body's own frame, at its bumper
  double speed_drag_n = 0.0;                       // at 0.04 m/s, in proportion to the speed
  double slope_drag_n = 0.0;                       // downhill, at 10 deg, with the sine of the climb
  int dragged_axle = -1;                           // 0 front, 1 middle, 2 rear
  double axle_drag_n = 0.0;                        // at each of its two wheels
  int snagged_wheel = -1;
  double wheel_drag_n = 0.0;
  int gained_wheel = -1;
  double wheel_current_gain = 0.0;
};

// The names of the effects with their parameters in the units of the keys, as in answers.json.
using EffectAnswers = std::map<std::string, std::map<std::string, double>>;

}  // namespace slipway::gap_benchmark
