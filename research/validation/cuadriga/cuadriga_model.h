#pragma once

#include <optional>
#include <vector>

#include "sim/rover/rover_model.h"
#include "sim/soil/soil.h"
#include "sim/wheel/per_wheel.h"

namespace slipway::validation {

// The free parameters of the fit of Cuadriga's drives. All others of rover and soil are as shipped or as in
// ground_of().
struct CuadrigaParameters {
  double k_phi = 0.0;  // N/m^(n+2), with k_c = 0 and n as in ground_of()
  double friction_angle_rad = 0.0;
  double shear_modulus_m = 0.0;
  double torque_per_ampere_nm = 0.0;  // wheel torque over motor current, k_t N eta
  double idle_current_a = 0.0;        // of all motors without load, with gears and electronics
  // The share of the current of a wheel's torque that is returned where the ground drives the wheel: 1 is all
  // of it, 0 is nothing, and with -1 braking costs as much as driving.
  double returned_share = 1.0;
};

// The soil of a parameter set.
sim::Soil ground_of(const CuadrigaParameters& parameters);

// The inputs of the model for a window. Without roll, left and right turns are equivalent.
struct ClimbConditions {
  double gradient_rad = 0.0;     // positive uphill
  double turn_rate_rad_s = 0.0;  // the true one of the rover
};

struct ClimbState {
  double slip_ratio = 0.0;
  double turn_rate_rad_s = 0.0;
  sim::PerWheel<double> torque_nm;
};

// Slip and torques over gradient and turn, tabulated at the quasi-static level: 21 gradients by up to four
// commanded curvatures. Skid steering makes the rover turn more slowly than commanded, so the curvature is
// looked up by the turn rate that results from it. Interpolation is linear between curvatures, and in
// gradient it is the cubic through the four nearest. A turn beyond the table has the state of its sharpest
// turn; steeper than 12 deg a turn adds what it adds at 12 deg.
class ClimbTable {
 public:
  static constexpr double kMinGradient_deg = -24.0, kMaxGradient_deg = 26.0, kStep_deg = 2.5;

  // Empty where the rover does not climb straight ahead at every gradient of the table, as Cuadriga did.
  static std::optional<ClimbTable> tabulate(const sim::RoverModel& rover, const sim::Soil& soil);

  // The gradient must be in [kMinGradient_deg, kMaxGradient_deg].
  ClimbState at(const ClimbConditions& conditions) const;

 private:
  std::vector<std::vector<ClimbState>> stations_;  // by gradient, by rising turn rate
};

// One station with a commanded curvature, solved without interpolation; empty where the rover does not move.
std::optional<ClimbState> solve_climb(const sim::RoverModel& rover, const sim::Soil& soil,
                                      double gradient_rad, double curvature_1_m);

// The current of all motors [A].
double current_of(const CuadrigaParameters& parameters, const ClimbState& state);

// Predicts the quantities of the logs.
class CuadrigaModel {
 public:
  CuadrigaModel(CuadrigaParameters parameters, ClimbTable table)
      : parameters_(parameters), table_(std::move(table)), level_slip_(table_.at({}).slip_ratio) {}

  // The slip as logged. The wheel speed was calibrated on level driving, where it equals the rover's own
  // speed, so that slip counts from that on level ground: 1 - (1 - s) / (1 - s_level).
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
