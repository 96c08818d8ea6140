#pragma once

#include <array>

#include "sim/dynamic/multibody.h"
#include "sim/rover/rover_model.h"
#include "sim/wheel/per_wheel.h"

namespace slipway::sim {

// A rover as bodies and joints. Steering joints turn about the z axis through their wheels' centres, all
// others about B's y axis:
//
//   base (body) -- rocker, left and right -- bogie, left and right -- steering -- wheel
//
// A rocker-bogie has all of these, an averaging suspension has no bogies, and a rigid one has neither rockers
// nor bogies. Wheels that are not steered are joined to their carrier directly. Locked wheels are welded.
// These values are assumed where the rover's file does not give them:
//
//   wheel, rocker, bogie   3 %, 3 %, 2 % of the rover's mass each
//   wheel's inertia        a uniform disc's
//   rocker's, bogie's      three equal points at its pivots and wheels' centres
//   body's mass, centre    the rover's less those of all other bodies
//   body's inertia         a uniform box's: body_length by body_width by com height
//   motors' rotors         as armature: gear ratio squared times the rotor's inertia
//   differential           stiffness: a hundredth of a degree under a tenth of the weight at half a wheelbase
//                          damping: half of critical for half the body's pitch inertia
//   stops                  0.8 rad, where settle() ends too
struct RoverMultibody {
  Multibody tree;
  // Indices of the joints in the tree, -1 where there is no such joint.
  std::array<int, 2> rocker{-1, -1}, bogie{-1, -1};  // left, right
  PerWheel<int> steering = {}, wheel = {};
  PerWheel<int> carrier = {};  // the body that carries the wheel's axle; -1 is the base
  double differential_stiffness_nm_rad = 0.0, differential_damping_nms_rad = 0.0;
  double rocker_stop_rad = 0.8, bogie_stop_rad = 0.8;
};

// Throws std::invalid_argument where suspension and wheels leave no mass for the body; faults_of() of the
// rover reports this beforehand.
RoverMultibody rover_multibody(const RoverModel& rover);

}  // namespace slipway::sim
