#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "sim/quasi_static/outside_wrench.h"
#include "sim/rover/drive_command.h"
#include "sim/rover/motor.h"
#include "sim/rover/rover_model.h"
#include "sim/rover/stance.h"
#include "sim/rover/suspension.h"
#include "sim/wheel/per_wheel.h"

namespace slipway::sim {

// What the equations of RoverBalance need of a rover on a stance under a command, whatever the soil: made
// once for a station, it serves all draws of the soil there, on any thread.
struct BalanceGeometry {
  static constexpr int kMaxEquilibrium = 6 + kMaxJoints;
  // One row more than can be needed, so that columns fill whole packs; unused rows are 0.
  static constexpr int kPaddedEquilibrium = kMaxEquilibrium + 1;
  // A wheel that does not turn is treated as one that turns at this share of the fastest wheel's rate, since
  // its slip would be infinite otherwise. All shear is mobilised at much lower slip.
  static constexpr double kMinRateRatio = 1e-3;
  using Equilibrium = Eigen::Matrix<double, kPaddedEquilibrium, 1>;
  static constexpr int kMaxFreedoms = 3 + kMaxJoints;
  using GapGradient = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxWheels, kMaxFreedoms>;
  using Loads = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxWheels, 1>;

  struct Wheel {
    WheelGeometry geometry;
    WheelCommand motion;     // true steering and rate
    double direction = 1.0;  // of rolling
    double commanded_rim_speed_m_s = 0.0;
    bool is_free = false, is_sliced = false;
    // Coefficients of (pull, lateral, vertical, torque, overturning moment) in the equations of equilibrium.
    Eigen::Matrix<double, kPaddedEquilibrium, 5> effect;
    // For a sliced wheel, the ground under each slice relative to the highest. The wheel's entry angle is
    // that of the slice on the highest ground, so that the wheel touches the ground at any entry angle.
    SliceHeights slice_height_m{};
    double highest_m = 0.0;                     // height of that ground over the wheel's contact plane
    std::array<JointMotion, kMaxJoints> joint;  // what each joint moves it by
    Eigen::RowVector3d forward_ratio,
        leftward_ratio;  // derivatives of u and v_y / (r |w|) by the three motions
  };

  // Rover and stance must outlive it.
  BalanceGeometry(const RoverModel& rover, double gravity_m_s2, const Stance& stance,
                  const DriveCommand& command);

  // Adds what acts from outside to the weight. A force on the body does not turn the joints, as its weight
  // does not; one at a wheel does.
  void add(const OutsideWrench& wrench);

  int equilibrium_count() const { return 6 + joints; }

  const RoverModel* rover;
  const Stance* stance;
  DriveCommand command;
  double gravity_m_s2;
  int joints, undetermined;
  Eigen::Vector2d travel;  // the direction
  double weight_n;
  double half_wheelbase_m;
  double speed_scale_m_s;
  double attainable_share;  // of the commanded speed
  DriveMotor drive;         // at its temperature
  std::vector<Wheel> wheels;
  Equilibrium gravity =
      Equilibrium::Zero();  // its part in the equations of equilibrium, with all that is added
  // Of each wheel to the ground, and their derivatives by heave, roll, pitch (times half the wheelbase) and
  // joints.
  Loads gap_m;
  GapGradient gap_gradient;
  // Roll (first row) and pitch of the body for a unit of height of each wheel, all being in contact, by least
  // squares over heave, roll, pitch and joints [rad / m].
  Eigen::Matrix<double, 2, Eigen::Dynamic, 0, 2, kMaxWheels> lean_by_height;

 private:
  void place_wheel(std::size_t wheel, const WheelCommand& commanded);
  void place_slices(std::size_t wheel);
  void set_gaps();
  void set_gravity();
};

}  // namespace slipway::sim
