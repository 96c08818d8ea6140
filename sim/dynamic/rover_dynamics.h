#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "sim/dynamic/drive_sample.h"
#include "sim/dynamic/drive_soils.h"
#include "sim/dynamic/dynamic_options.h"
#include "sim/dynamic/leg_driver.h"
#include "sim/dynamic/motor_control.h"
#include "sim/dynamic/rover_multibody.h"
#include "sim/dynamic/rut_trail.h"
#include "sim/dynamic/wheel_contact.h"
#include "sim/rover/belly_clearance.h"

namespace slipway::sim {

// clang-format off
// The rover in motion as a first-order system y' = f(t, y). The state vector y has, in this order:
//
//   p_MB less the starting position (3), q_MB (w, x, y, z)   q' = q (0, omega) / 2 + (1 - |q|^2) q
//   angles of rockers, bogies, steering joints               in the tree's order
//   omega, v of B's origin (axes of B)                       see multibody.h
//   rates of all joints, wheels included                     in the tree's order
//   slip states (x, y) of each wheel                         see wheel_contact.h
//   integral voltage of each wheel's rate control
//
// The internal constraints are those of [ROAMS section 2.3]. The differential's torque on both rockers is
// -(k e + c e'), where e is the sum of their angles. The joint stops follow Hunt and Crossley,
// k d^(3/2) (1 + 3/2 c d'), where d is the angle beyond the stop.
//
// The drive motors are under rate control and the steering motors under angle control, see motor_control.h.
// Brakes hold the wheels while the rover is halted: before and after the drive, and while it steers.
// The soil does not resist steering, since a contact point on the steering axis has no lever arm.
//
// The model leaves out the forces on a body that touches the ground (see belly()), the motors' inductance, and the
// elasticity of the suspension.
// clang-format on
class RoverDynamics {
 public:
  // All arguments must outlive this object.
  RoverDynamics(const RoverModel& rover, double gravity_m_s2, const Ground& ground, const DriveSoils& soils,
                const DynamicOptions& options);

  int size() const { return size_; }
  // The number of states of position and attitude, which come first. Their error must not be scaled by their
  // values, since the map's origin and its east direction are arbitrary.
  int pose_size() const { return angles_at_; }
  // The absolute tolerance of each state that belongs to this relative tolerance, at rest or on the way.
  std::vector<double> tolerances(double relative, bool drives) const;
  // The state at rest in this stance, with the wheels sunk under equal loads.
  std::vector<double> at_rest(const Stance& stance);

  // From now on brakes hold the wheels, and the commanded steering angles are these.
  void halt(const PerWheel<double>& steered_rad);
  // From now on the wheels follow the commands of this driver, which must outlive the leg.
  void follow(const LegDriver* driver, const Pose2& leg_start);
  const LegDriver* driver() const { return driver_; }

  // The state's rate of change. Returns false where a wheel has no ground (see lost_ground()) or a state is
  // not finite.
  bool derivative(double t, const double* y, double* rate);
  // The place without ground that the last refusal since after_step() met, in the map frame [m].
  const std::optional<Eigen::Vector2d>& lost_ground() const { return lost_ground_; }

  // Must be called after each accepted step: looks up the soils under the wheels, presses their ruts, unwraps
  // the heading, and integrates energy and encoders.
  void after_step(double t, const double* y);

  // Event functions, of order one and zero where the event happens, in this order: the leg's goal, tilt; then
  // for each wheel the depth of its axle, lift-off, stall; then the stops of the joints. Returns false as
  // derivative() does.
  int event_count() const { return 2 + 3 * wheels() + joint_stops(); }
  bool events(double t, const double* y, double* value);

  // Maxima over the wheels at the last after_step(), and the slip as in DriveSample, which is empty between
  // legs.
  struct Figures {
    double current_a = 0.0, sinkage_m = 0.0;
    std::optional<double> slip_ratio = {};
  };
  const Figures& figures() const { return figures_; }
  // A motor that its limit kept far below its commanded rate in the last step with full commands of the
  // present leg: what stops a rover whose wheels hardly turn.
  struct Stall {
    std::size_t wheel = 0;
    MotorLimit limit = MotorLimit::kNone;
    double current_a = 0.0;
  };
  const std::optional<Stall>& stall() const { return stall_; }

  // The whole sample at a state, by a new evaluation of the equations.
  DriveSample sample(double t, const double* y);
  Pose2 pose(const double* y) const;  // its yaw is unwrapped from the last after_step()
  double tilt_rad(const double* y) const;
  BellyClearance belly(const double* y) const;          // over the ground without ruts
  double speed_m_s(const double* y) const;              // of B's origin
  PerWheel<double> steered_rad(const double* y) const;  // true angles less the wheels' steering offsets
  LegPlace place(const double* y) const;                // on the leg that is followed
  // Electric energy since the start or the last reset_counts(), integrated by after_step().
  double energy_j() const { return energy_j_; }
  void reset_counts();  // sets energy and encoder angles to 0
  RutMap& ruts() { return ruts_; }
  int wheels() const { return static_cast<int>(rover_.wheels.size()); }
  // Kinetic and potential energy of the bodies [J], for tests of the energy's drift.
  double mechanical_energy_j(const double* y);

 private:
  struct WheelDriveState {
    MotorDrive motor;        // all values are 0 for a wheel without a motor
    double torque_nm = 0.0;  // about the axle, drag included
  };

  int joints() const { return bodies_.tree.joint_count(); }
  int joint_stops() const;
  void lay_out();
  void unpack(const double* y);
  bool find_contacts(const double* y);
  bool look_at_grounds(const double* y);
  void find_kinematics(const double* y);
  std::optional<double> slip_ratio(double t, const double* y) const;
  void add_suspension_torques();
  WheelDriveState drive_of(std::size_t wheel, const double* y) const;
  double integral_rate_v_s(std::size_t wheel) const;
  void note_stall(double t);
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
  std::vector<int> angle_state_;  // index of each joint's angle in y, -1 for wheels

  const LegDriver* driver_ = nullptr;
  Pose2 leg_start_;
  PerWheel<double> halted_rad_, halted_rate_rad_s_;
  double halted_t_ = 0.0, halted_share_ = 1.0;
  PerWheel<WheelCommand> commanded_;
  bool braked_ = true;
  // Of the commands above: most of a Jacobian's evaluations change neither.
  double commanded_t_ = -1.0;
  LegPlace commanded_at_;

  // The starting position, from which the state's position counts: map coordinates are thousands of
  // kilometres and would leave too few digits for the millimetres of a drive.
  Eigen::Vector3d origin_M_ = Eigen::Vector3d::Zero();

  // Values at the state that was unpacked last.
  Eigen::Vector3d p_MB_;
  Eigen::Matrix3d R_MB_ = Eigen::Matrix3d::Identity();
  std::vector<double> angles_, rates_, accelerations_;
  PerWheel<WheelKinematics> kinematics_;
  PerWheel<ContactState> contact_;
  // The grounds at the state that events() saw last: most steps end there.
  std::vector<double> looked_at_;
  PerWheel<ContactState> looked_;
  PerWheel<WheelDriveState> drive_;
  SpatialVector base_rate_ = SpatialVector::Zero();
  std::optional<Eigen::Vector2d> lost_ground_;

  // Kept from step to step.
  double yaw_rad_ = 0.0, last_t_ = 0.0, last_power_w_ = 0.0, energy_j_ = 0.0;
  bool stepped_ = false;
  Figures figures_;
  std::optional<Stall> stall_;
  PerWheel<std::optional<std::size_t>> soil_;
  PerWheel<bool> has_soil_;
  PerWheel<double> turned_rad_, last_rate_rad_s_;
  PerWheel<RutTrail> trails_;
};

}  // namespace slipway::sim
