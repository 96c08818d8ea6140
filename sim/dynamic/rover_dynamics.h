#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "sim/dynamic/dynamic_drive.h"
#include "sim/dynamic/leg_driver.h"
#include "sim/dynamic/motor_control.h"
#include "sim/dynamic/rover_multibody.h"
#include "sim/dynamic/rut_trail.h"
#include "sim/dynamic/wheel_contact.h"
#include "sim/rover/belly_clearance.h"

namespace slipway::sim {

// clang-format off
// The rover in motion as a system of first order, y:
//
//   p_MB less where it set out (3), q_MB (w, ...)  q' = q (0, omega) / 2 + (1 - |q|^2) q
//   angles of rockers, bogies, steerings           in the tree's order
//   omega, v of B's origin (axes of B)             multibody.h
//   rates of all joints, wheels too                in the tree's order
//   slip states (x, y) of each wheel               wheel_contact.h
//   integral voltage of each wheel's rate control
//
// Internal constraints [ROAMS section 2.3]: the differential's torque on both rockers -(k e + c e'), e the sum of
// their angles; stops by Hunt and Crossley, k d^(3/2) (1 + 3/2 c d'), d the angle beyond the stop.
//
// Drive and steering motors under rate and angle control: motor_control.h.
// Soil does not resist steering: a point on the steering's axis has no arm.
//
// Not modelled: the forces on a body that touches the ground (see belly()), inductance, the legs' elasticity.
// clang-format on
class RoverDynamics {
 public:
  // All must outlive it.
  RoverDynamics(const RoverModel& rover, double gravity_m_s2, const Ground& ground, const DriveSoils& soils,
                const DynamicOptions& options);

  int size() const { return size_; }
  // Place and attitude come first; where the map's origin lies and which way is east is no measure of an
  // error.
  int pose_size() const { return angles_at_; }
  // Absolute tolerances that go with a relative one.
  std::vector<double> tolerances(double relative) const;
  // At rest as settle() leaves it, sunk under equal loads.
  std::vector<double> at_rest(const Stance& stance);

  // Nothing told: wheels halted, steered as they are.
  void halt(const PerWheel<double>& steered_rad);
  void follow(const LegDriver* driver, const Pose2& leg_start);  // must stay where it is
  const LegDriver* driver() const { return driver_; }

  // False off the ground: see lost_ground().
  bool derivative(double t, const double* y, double* rate);
  // Where the last refusal since after_step() was.
  const std::optional<Eigen::Vector2d>& lost_ground() const { return lost_ground_; }

  // Soils under the wheels, what they leave behind, headings unwrapped: after each step that counts.
  void after_step(double t, const double* y);

  // Events, of order one, zero where they happen; in this order: leg's goal, tilt, then for each wheel depth
  // of the axle, lift-off, stall; then stops of the joints.
  int event_count() const { return 2 + 3 * wheels() + joint_stops(); }
  bool events(double t, const double* y, double* value);

  // At the last after_step(): largest of the wheels; slip as in DriveSample, nothing between the drives.
  struct Figures {
    double current_a = 0.0, sinkage_m = 0.0;
    std::optional<double> slip_ratio = {};
  };
  const Figures& figures() const { return figures_; }

  // At a state; found by a new evaluation.
  DriveSample sample(double t, const double* y);
  Pose2 pose(const double* y) const;  // yaw unwrapped from the last after_step()
  double tilt_rad(const double* y) const;
  BellyClearance belly(const double* y) const;  // over undeformed ground
  double speed_m_s(const double* y) const;      // of B's origin
  double fastest_wheel_rad_s(const double* y) const;
  PerWheel<double> steered_rad(const double* y) const;
  LegPlace place(const double* y) const;
  // Since the start or reset_counts(), integrated by after_step().
  double energy_j() const { return energy_j_; }
  void reset_counts();  // of energy and encoders
  RutMap& ruts() { return ruts_; }
  int wheels() const { return static_cast<int>(rover_.wheels.size()); }
  // Kinetic and potential energy of the bodies, J: for tests of drift.
  double mechanical_energy_j(const double* y);

 private:
  struct WheelDriveState {
    MotorDrive motor;        // all 0 of a wheel without a motor
    double torque_nm = 0.0;  // about the axle, drag included
  };

  int joints() const { return bodies_.tree.joint_count(); }
  int joint_stops() const;
  void lay_out();
  void unpack(const double* y);
  bool find_contacts(const double* y);
  void find_kinematics(const double* y);
  std::optional<double> slip_ratio(double t, const double* y) const;
  void add_suspension_torques();
  WheelDriveState drive_of(std::size_t wheel, const double* y) const;
  Eigen::Vector3d gravity_M() const;
  void set_commanded(double t, const double* y);
  double gripping_load_kg_m2() const;
  MotorControl control_of(const DriveMotor& motor, double load_kg_m2) const;

  const RoverModel& rover_;
  double gravity_m_s2_;
  const Ground& ground_;
  const DriveSoils& soils_;
  DynamicOptions options_;
  RoverMultibody bodies_;
  MultibodyDynamics dynamics_;
  WheelContacts contacts_;
  RutMap ruts_;
  double standstill_rad_s_;
  MotorControl drive_control_, steering_control_;

  int size_ = 0, angles_at_ = 7, twist_at_ = 0, rates_at_ = 0, slips_at_ = 0, integrals_at_ = 0;
  std::vector<int> angle_state_;  // of each joint in y, -1 for wheels

  const LegDriver* driver_ = nullptr;
  Pose2 leg_start_;
  PerWheel<double> halted_rad_;
  PerWheel<WheelCommand> told_;

  // Where it was set down: maps count in thousands of kilometres, a drive in millimetres.
  Eigen::Vector3d origin_M_ = Eigen::Vector3d::Zero();

  // Of the state last unpacked.
  Eigen::Vector3d p_MB_;
  Eigen::Matrix3d R_MB_ = Eigen::Matrix3d::Identity();
  std::vector<double> angles_, rates_, accelerations_;
  PerWheel<WheelKinematics> kinematics_;
  PerWheel<ContactState> contact_;
  PerWheel<WheelDriveState> drive_;
  SpatialVector base_rate_ = SpatialVector::Zero();
  std::optional<Eigen::Vector2d> lost_ground_;

  // Kept from step to step.
  double yaw_rad_ = 0.0, last_t_ = 0.0, last_power_w_ = 0.0, energy_j_ = 0.0;
  bool stepped_ = false;
  Figures figures_;
  PerWheel<std::optional<std::size_t>> soil_;
  PerWheel<bool> has_soil_;
  PerWheel<double> turned_rad_, last_rate_rad_s_;
  PerWheel<RutTrail> trails_;
};

}  // namespace slipway::sim
