#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "core/result.h"
#include "sim/rover/effect_setting.h"
#include "sim/rover/motor.h"
#include "sim/rover/power_supply.h"
#include "sim/wheel/per_wheel.h"
#include "sim/wheel/wheel_forces.h"

namespace slipway::sim {

enum class Side { kLeft, kRight };

// What turns a wheel.
enum class WheelDrive {
  kDriven,  // its motor keeps the commanded rate
  kLocked,  // it does not turn: a dead motor behind a gear that can't be driven back
  kFree,    // no torque but the drag of its bearing and gear: it turns as the ground turns it
};

// A rigid wheel. Frame B: x forward, y left, z up, origin on the ground under the wheels' centre at rest.
struct WheelModel {
  std::string name;  // lf lm lr rf rm rr of six, lf lr rf rr of four; any unique name otherwise
  Eigen::Vector3d position_m =
      Eigen::Vector3d::Zero();  // of the wheel's centre in B, at rest on level ground
  double radius_m = 0.125;
  double width_m = 0.16;
  std::optional<Grousers> grousers;
  double rim_friction = 1.0;  // see WheelGeometry
  bool steerable = false;
  Side side = Side::kLeft;
  bool on_bogie = false;  // of a rocker-bogie: carried by the side's bogie, otherwise by its rocker
  WheelDrive drive = WheelDrive::kDriven;
  double drag_nm = 0.0;              // resisting torque at the axle besides the soil's, >= 0
  double rate_share = 1.0;           // of the commanded rate that the wheel really turns at, (0, 1]
  double steering_offset_rad = 0.0;  // true less commanded steering angle
  std::optional<double>
      software_radius_m;  // that the rover's own software reckons with; radius_m where absent

  bool operator==(const WheelModel&) const = default;

  WheelGeometry geometry() const { return {radius_m, width_m, grousers.value_or(Grousers{}), rim_friction}; }
  double reckoned_radius_m() const { return software_radius_m.value_or(radius_m); }
};

enum class SuspensionType {
  kRockerBogie,  // six wheels: rockers turn against each other through a differential, each carries one wheel
                 // and a bogie with the two others
  kAveraging,  // a rocker a side carries all wheels of that side; the body averages the two by a differential
  kRigid,      // wheels fixed to the body
};

// How the wheels hang on the body. Left side given; right mirrored in y. A type reads the pivots it has.
// What is optional is read by the dynamic level only; rover_multibody.h says what stands in for it.
struct Suspension {
  SuspensionType type = SuspensionType::kRockerBogie;
  Eigen::Vector3d rocker_pivot_m = Eigen::Vector3d::Zero();  // rocker-bogie, averaging
  Eigen::Vector3d bogie_pivot_m = Eigen::Vector3d::Zero();   // rocker-bogie
  // Of the differential: torque on each rocker per sum of the rockers' angles [ROAMS section 2.3].
  std::optional<double> differential_stiffness_nm_rad = {}, differential_damping_nms_rad = {};
  // Stops of the joints, either way from their places at rest.
  std::optional<double> rocker_stop_rad = {}, bogie_stop_rad = {};

  bool operator==(const Suspension&) const = default;
};

// Where the mass is: what the dynamic level needs besides the whole mass and its centre; rover_multibody.h
// says what stands in for what is not given.
struct MassDistribution {
  std::optional<double> wheel_kg = {};   // each wheel with its motors
  std::optional<double> rocker_kg = {};  // each
  std::optional<double> bogie_kg = {};   // each
  // Of the body without its suspension about its own centre of mass, along x, y, z.
  std::optional<Eigen::Vector3d> body_inertia_kg_m2 = {};

  bool operator==(const MassDistribution&) const = default;
};

// A rover on any number of wheels from 3 to kMaxWheels: immutable once built, shared by pointer.
struct RoverModel {
  std::string name;
  std::string summary;
  std::vector<std::string> sources;
  std::vector<std::string> assumed;  // names of parameters that no source gives
  double mass_kg = 0.0;
  Eigen::Vector3d com_m = Eigen::Vector3d::Zero();
  std::vector<WheelModel> wheels;  // left and right sides both have at least one
  // Across each wheel, 1 to kMaxSlices: with more than one the ground's height may differ over its width
  // (see sliced_wheel.h). Free wheels stay whole.
  int wheel_slices = 1;
  Suspension suspension;
  MassDistribution masses;
  DriveMotor drive;
  std::optional<DriveMotor> steering = {};  // of each steerable wheel; nothing: motors like the drive's
  std::optional<PowerSupply> power = {};    // nothing where no source gives it
  // Where a wheel's pull acts on the vehicle: 0, as the laws have it, with the soil's resistance ahead of the
  // axle; 1, at the rim's lowest point and nothing ahead of it, as simpler simulators have it. Read by the
  // balance; a closure that a diagnosis may re-tune.
  double pull_below_axle = 0.0;
  // How much of the wheels' own weight hangs at the wheels and turns the suspension's joints on slopes: 0, as
  // if all mass were in the body; 1, all of it, as in the dynamic level. Read by the balance; a closure that
  // a diagnosis may re-tune.
  double wheel_weight = 0.0;
  double belly_clearance_m = 0.3;  // lowest point of the body between the wheels, above level ground
  double body_length_m = 1.6;      // of the rectangle that must stay on the map and out of keep-outs
  double body_width_m = 1.5;
  double max_tilt_rad = 0.5;
  double cruise_speed_m_s = 0.04;  // of the body, commanded on the straight
  double turn_rate_rad_s = 0.03;   // commanded, turning in place
  double min_turn_radius_m = 1.5;  // of an arc
  // What the file says is at work on this rover; requests add to it and switch off.
  std::vector<EffectSetting> effects;
  // True less reckoned attitude: what the ground's map or the rover's inclinometer has wrong.
  double roll_bias_rad = 0.0, pitch_bias_rad = 0.0;

  bool operator==(const RoverModel&) const = default;

  double smallest_wheel_radius_m() const;
  double wheel_mass_kg() const;  // of each wheel with its motors; 3 % of the whole where none is given
  double rocker_mass_kg()
      const;  // of each rocker; 0 where the suspension has none, 3 % of the whole where none is given
  double bogie_mass_kg()
      const;  // of each bogie; 0 where the suspension has none, 2 % of the whole where none is given
  double body_mass_kg() const;     // what wheels, rockers and bogies leave for the body
  double circumscribed_m() const;  // radius of the circle around the body's rectangle
  double track_m() const;          // widest distance between left and right wheel centres
};

// Everything that a model must satisfy before it is used: 3 to kMaxWheels wheels with unique names, each
// side with one; a rocker-bogie has six named lf lm lr rf rm rr, two of each side on its bogie; an averaging
// suspension has two or more a side, one behind the other; masses, radii, efficiencies in range, the centre
// of mass inside the wheels. Returns every fault; pointers are those of the rover file
// ("/wheels/2/radius_m").
std::vector<Fault> faults_of(const RoverModel& rover);

}  // namespace slipway::sim
