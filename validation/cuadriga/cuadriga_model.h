#pragma once

#include <optional>
#include <vector>

#include "sim/rover/rover_model.h"
#include "sim/soil/soil.h"
#include "sim/wheel/per_wheel.h"

namespace slipway::validation {

// What the fit of Cuadriga's drives may choose; everything else of rover and soil is as it is shipped or as
// ground_of() says.
struct CuadrigaParameters {
  double k_phi = 0.0;  // N/m^(n+2), with k_c = 0 and n as in ground_of()
  double friction_angle_rad = 0.0;
  double shear_modulus_m = 0.0;
  double torque_per_ampere_nm = 0.0;  // of a wheel's torque and its motor's current: k_t N eta
  double idle_current_a = 0.0;        // of all motors: no load, gears, electronics
  // Of the current that a wheel's torque means, what comes back where the ground drives the wheel: 1 all of
  // it, 0 nothing, -1 braking costs what driving does.
  double returned_share = 1.0;
};

// The soil of a parameter set.
sim::Soil ground_of(const CuadrigaParameters& parameters);

// What sets windows apart for the model. Left turns and right ones are alike without roll.
struct ClimbConditions {
  double gradient_rad = 0.0;     // positive uphill
  double turn_rate_rad_s = 0.0;  // that the rover really turns at
};

struct ClimbState {
  double slip_ratio = 0.0;
  double turn_rate_rad_s = 0.0;
  sim::PerWheel<double> torque_nm;
};

// Slip and torques against gradient and turn, tabulated on the quasi-static rung: 21 gradients by up to four
// told curvatures. Skidding, the rover turns slower than told, so the curvature is looked up by the turn that
// comes of it: linear between curvatures, in gradient the cubic through the four nearest. A turn that the
// table does not reach has the state of the sharpest it holds; steeper than 12 deg a turn adds what it adds
// there.
class ClimbTable {
 public:
  static constexpr double kLowest_deg = -24.0, kHighest_deg = 26.0, kStep_deg = 2.5;

  // Nothing where the rover does not climb straight ahead at every gradient of the table: Cuadriga did.
  static std::optional<ClimbTable> tabulate(const sim::RoverModel& rover, const sim::Soil& soil);

  // Gradient in [kLowest, kHighest].
  ClimbState at(const ClimbConditions& conditions) const;

 private:
  std::vector<std::vector<ClimbState>> stations_;  // by gradient, by rising turn rate
};

// One station, solved and not interpolated, told to turn at a curvature; nothing where it does not move.
std::optional<ClimbState> solve_climb(const sim::RoverModel& rover, const sim::Soil& soil,
                                      double gradient_rad, double curvature_1_m);

// Of all motors.
double current_of(const CuadrigaParameters& parameters, const ClimbState& state);

// Predicts what the logs hold.
class CuadrigaModel {
 public:
  CuadrigaModel(CuadrigaParameters parameters, ClimbTable table)
      : parameters_(parameters), table_(std::move(table)), level_slip_(table_.at({}).slip_ratio) {}

  // As logged: the wheel speed was calibrated on level driving, so that it reads the rover's own speed there
  // and slip counts from that on level ground, 1 - (1 - s) / (1 - s_level).
  double slip(const ClimbConditions& conditions) const;
  double current_a(const ClimbConditions& conditions) const;
  // Current over speed, at the wheel speed as logged.
  double charge_per_metre_as(const ClimbConditions& conditions, double wheel_speed_m_s) const;

  const CuadrigaParameters& parameters() const { return parameters_; }
  double level_slip() const { return level_slip_; }

 private:
  CuadrigaParameters parameters_;
  ClimbTable table_;
  double level_slip_;
};

}  // namespace slipway::validation
