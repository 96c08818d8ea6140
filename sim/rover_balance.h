#pragma once

#include <Eigen/Core>
#include <array>

#include "sim/drive_command.h"
#include "sim/rover_model.h"
#include "sim/soil.h"
#include "sim/stance.h"
#include "sim/wheel_forces.h"

namespace slipway::sim {

// The nine equations of a six-wheel rocker-bogie in quasi-static motion, frame B, moments about B's origin:
//
//   0..2   force        sum F_k + m g = 0
//   3..5   moment       sum (p_k x F_k + M_k) + p_com x m g = 0           roll, pitch, yaw
//   6, 7   bogies       y . sum_bogie ((p_k - p_bogie) x F_k + M_k) = 0   left, right
//   8      differential y . (left side's moment about its rocker pivot - the right side's) = 0
//
// F_k is the soil's force at wheel k's centre, M_k = -T_k about its axle, and the suspension has no mass of
// its own. Forces are divided by the weight, moments by weight and half the wheelbase. The nine unknowns:
// forward and leftward speed of B over `speed_scale`, yaw rate times half the wheelbase over the same, and
// the six entry angles.
class RoverBalance {
 public:
  static constexpr int kEquations = 9;
  static constexpr int kMotions = 3;
  using Vector = Eigen::Matrix<double, kEquations, 1>;
  using Matrix = Eigen::Matrix<double, kEquations, kEquations>;

  // The arguments must outlive the balance.
  RoverBalance(const RoverModel& rover, double gravity_m_s2, const Stance& stance,
               const std::array<Soil, kWheels>& soils, const DriveCommand& command);

  Vector residual(const Vector& unknowns);
  // At the unknowns of the last residual, by one-sided differences of each wheel's four forces over its three
  // arguments.
  Matrix jacobian(const Vector& unknowns) const;

  WheelMotion motion_of(int wheel, const Vector& unknowns) const;
  // The forces of the last residual.
  const WheelForces& forces(int wheel) const { return forces_[wheel]; }
  const WheelCommand& command(int wheel) const { return told_[wheel]; }
  double speed_scale_m_s() const { return speed_scale_; }
  double half_wheelbase_m() const { return length_; }
  double weight_n() const { return weight_; }
  // Wheel loads if nothing pulled or pushed along the ground: the start of a solve.
  Eigen::Matrix<double, kWheels, 1> resting_loads_n() const;

 private:
  struct WheelPlace {
    Eigen::Matrix<double, kEquations, 4> effect;  // of (pull, lateral, vertical, torque) on the equations
    Eigen::RowVector3d forward_ratio, leftward_ratio;  // of the three motions on u and v_y / (r |w|)
  };

  void place_wheel(int wheel);

  const RoverModel& rover_;
  const Stance& stance_;
  const std::array<Soil, kWheels>& soils_;
  std::array<WheelCommand, kWheels> told_;
  std::array<WheelPlace, kWheels> places_;
  std::array<WheelForces, kWheels> forces_;
  double weight_, length_, speed_scale_;
  Vector gravity_;
};

}  // namespace slipway::sim
