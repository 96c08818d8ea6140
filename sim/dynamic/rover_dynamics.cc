#include "sim/dynamic/rover_dynamics.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "sim/dynamic/drive_result.h"
#include "sim/wheel/entry_angle.h"

namespace slipway::sim {
namespace {

using Eigen::Vector3d;

constexpr double kStandstillShare = 0.01;  // of the wheels' cruise rate; slower wheels count as passing rest
constexpr double kStallShare = 0.2;        // of the commanded rate; a slower wheel counts as stalled
constexpr double kCoarseSpeeds = 30.0;  // cruise speeds that the tolerance of speeds and rates is relative to
constexpr double kHalting_s = 1.0;      // in which a wheel that was braked forgets which way it rolled
constexpr double kStop_nm_rad = 2e4, kStopDamping_s_rad = 1.0;
constexpr double kSunkenAxle_radii = 0.929;  // 1 - cos of the laws' maximum entry angle
constexpr double kForgotten_lengths = 8.0;   // body lengths; the wheels cannot return to ruts farther away

double min_cruise_rate(const RoverModel& rover) {
  double radius = 0.0;
  for (const WheelModel& wheel : rover.wheels) radius = std::max(radius, wheel.radius_m);
  return rover.cruise_speed_m_s / radius;
}

}  // namespace

RoverDynamics::RoverDynamics(const RoverModel& rover, double gravity_m_s2, const Ground& ground,
                             const DriveSoils& soils, const DynamicOptions& options)
    : rover_(rover),
      gravity_m_s2_(gravity_m_s2),
      ground_(ground),
      soils_(soils),
      options_(options),
      bodies_(rover_multibody(rover)),
      dynamics_(bodies_.tree),
      contacts_(rover, gravity_m_s2, options.contact_points, kStandstillShare * min_cruise_rate(rover)),
      standstill_rad_s_(kStandstillShare * min_cruise_rate(rover)),
      drive_control_(
          control_of(at_temperature(rover.drive, options.motor_temp_c.value_or(rover.drive.reference_temp_c)),
                     gripping_load_kg_m2())),
      steering_control_(control_of(rover.steering.value_or(rover.drive), 0.0)),
      halted_rad_(rover.wheels.size()),
      halted_rate_rad_s_(rover.wheels.size()),
      commanded_(rover.wheels.size()),
      angles_(bodies_.tree.joint_count()),
      rates_(bodies_.tree.joint_count()),
      accelerations_(bodies_.tree.joint_count()),
      kinematics_(rover.wheels.size()),
      contact_(rover.wheels.size()),
      looked_(rover.wheels.size()),
      drive_(rover.wheels.size()),
      soil_(rover.wheels.size()),
      has_soil_(rover.wheels.size(), false),
      turned_rad_(rover.wheels.size()),
      last_rate_rad_s_(rover.wheels.size()),
      trails_(rover.wheels.size()) {
  lay_out();
  for (std::size_t k = 0; k < rover_.wheels.size(); ++k)
    contacts_.set_soil(k, soils_.of(soil_[k]), rover_.cruise_speed_m_s);
}

void RoverDynamics::lay_out() {
  int next = angles_at_;
  for (const RevoluteBody& body : bodies_.tree.bodies()) angle_state_.push_back(body.round ? -1 : next++);
  twist_at_ = next;
  rates_at_ = twist_at_ + 6;
  slips_at_ = rates_at_ + joints();
  integrals_at_ = slips_at_ + 2 * wheels();
  size_ = integrals_at_ + wheels();
}

// The moment of inertia about the axle that a wheel's share of the rover's mass has at its rim.
double RoverDynamics::gripping_load_kg_m2() const {
  const double radius = rover_.smallest_wheel_radius_m();
  return rover_.mass_kg / wheels() * radius * radius;
}

// The inertia is computed from the motor's rotor rather than from the tree, because a locked wheel's armature
// is infinite and not all rovers steer. A driven wheel that grips also moves its share of the rover. Without
// that share the controller's integral would take tens of seconds to find the load behind a motor of low
// gear, and each leg would begin below its commanded speed.
MotorControl RoverDynamics::control_of(const DriveMotor& motor, double load_kg_m2) const {
  const double rotor = motor.gear_ratio * motor.gear_ratio * motor.rotor_inertia_kg_m2;
  const RevoluteBody& wheel = bodies_.tree.bodies()[bodies_.wheel[0]];
  return {motor, rotor + wheel.mass.inertia_kg_m2(1, 1) + load_kg_m2, standstill_rad_s_};
}

std::vector<double> RoverDynamics::tolerances(double relative, bool drives) const {
  // Relative to the scales that matter to a drive: 0.1 m, 0.1 rad, cruise speed, a slip of 0.1, and 10 V.
  std::vector<double> absolute(size_, relative * 0.1);
  for (int i = twist_at_; i < slips_at_; ++i) absolute[i] = relative * rover_.cruise_speed_m_s;
  for (int i = integrals_at_; i < size_; ++i) absolute[i] = relative * 10.0;
  if (!drives) return absolute;
  // On the way, the speeds of the body and of its suspension settle on the soil within a wheel's contact
  // length: what their errors do to a drive is held by the tolerances of places, angles and slips.
  for (int i = twist_at_; i < rates_at_; ++i) absolute[i] *= kCoarseSpeeds;
  for (int j = 0; j < joints(); ++j)
    if (angle_state_[j] >= 0) absolute[rates_at_ + j] *= kCoarseSpeeds;
  return absolute;
}

std::vector<double> RoverDynamics::at_rest(const Stance& stance) {
  std::vector<double> y(size_, 0.0);
  const double load = rover_.mass_kg * gravity_m_s2_ / wheels();
  double sunk = 0.0;
  for (int k = 0; k < wheels(); ++k) {
    const Eigen::Vector3d p = stance.p_MB + stance.R_MB * stance.p_B_wheel[k];
    const Soil& soil = soils_.of(ground_.soil_at(p.x(), p.y()));
    const WheelGeometry wheel = rover_.wheels[k].geometry();
    const auto theta = balanced_entry_angle_rad(wheel, soil, load, {});
    sunk += sinkage_m(wheel.radius_m, theta.value_or(0.5 * kMaxEntryAngleRad)) / wheels();
  }
  const Eigen::Quaterniond q(stance.R_MB);
  origin_M_ = stance.p_MB - sunk * stance.R_MB.col(2);
  y[3] = q.w(), y[4] = q.x(), y[5] = q.y(), y[6] = q.z();
  for (int s = 0; s < 2; ++s) {
    if (bodies_.rocker[s] >= 0)
      y[angle_state_[bodies_.rocker[s]]] = s == 0 ? stance.rocker_rad : -stance.rocker_rad;
    if (bodies_.bogie[s] >= 0) y[angle_state_[bodies_.bogie[s]]] = stance.bogie_rad[s];
  }
  for (int k = 0; k < wheels(); ++k)
    if (bodies_.steering[k] >= 0) y[angle_state_[bodies_.steering[k]]] = rover_.wheels[k].steering_offset_rad;
  return y;
}

void RoverDynamics::halt(const PerWheel<double>& steered_rad) {
  driver_ = nullptr;
  commanded_t_ = -1.0;
  halted_rad_ = steered_rad;
  halted_rate_rad_s_ = last_rate_rad_s_;
  halted_t_ = last_t_;
}

void RoverDynamics::follow(const LegDriver* driver, const Pose2& leg_start) {
  driver_ = driver;
  leg_start_ = leg_start;
  stall_.reset();
  commanded_t_ = -1.0;
  const PerWheel<WheelCommand> plain = wheel_commands(rover_, driver->leg().command);
  for (std::size_t k = 0; k < plain.size(); ++k)
    contacts_.set_commanded_direction(k, plain[k].rate_rad_s < 0.0 ? -1.0 : 1.0);
}

void RoverDynamics::unpack(const double* y) {
  p_MB_ = origin_M_ + Vector3d(y[0], y[1], y[2]);
  R_MB_ = Eigen::Quaterniond(y[3], y[4], y[5], y[6]).normalized().toRotationMatrix();
  for (int j = 0; j < joints(); ++j) {
    angles_[j] = angle_state_[j] >= 0 ? y[angle_state_[j]] : 0.0;
    rates_[j] = y[rates_at_ + j];
  }
  dynamics_.set_state(R_MB_, Eigen::Map<const SpatialVector>(y + twist_at_), angles_.data(), rates_.data());
}

void RoverDynamics::find_kinematics(const double* y) {
  for (std::size_t k = 0; k < kinematics_.size(); ++k) {
    const int joint = bodies_.wheel[k];
    WheelKinematics& at = kinematics_[k];
    const Vector3d& p_B = dynamics_.pivot_B(joint);
    at.centre = p_MB_ + R_MB_ * p_B;
    at.axle.noalias() = R_MB_ * dynamics_.axis_B(joint);
    at.velocity.noalias() = R_MB_ * dynamics_.point_velocity(joint, p_B);
    at.rate_rad_s = rates_[joint];
    at.braked = braked_ && rover_.wheels[k].drive == WheelDrive::kDriven;
    at.halted_turning = halted_rate_rad_s_[k] / standstill_rad_s_ * halted_share_;
    at.slip_x = y[slips_at_ + 2 * k];
    at.slip_y = y[slips_at_ + 2 * k + 1];
  }
}

bool RoverDynamics::find_contacts(const double* y) {
  unpack(y);
  find_kinematics(y);
  if (contacts_.find(ground_, ruts_, kinematics_, contact_)) return true;
  for (std::size_t k = 0; k < kinematics_.size(); ++k)
    if (!contacts_.find_ground(ground_, ruts_, k, kinematics_[k], contact_[k]))
      lost_ground_ = kinematics_[k].centre.head<2>();
  return false;
}

void RoverDynamics::add_suspension_torques() {
  const auto stop = [&](int joint, double limit) {
    const double beyond = std::abs(angles_[joint]) - limit;
    if (beyond <= 0.0) return;
    const double side = angles_[joint] > 0.0 ? 1.0 : -1.0;
    const double stiff = kStop_nm_rad * beyond * std::sqrt(beyond);
    dynamics_.add_torque(
        joint, -side * stiff * std::max(0.0, 1.0 + 1.5 * kStopDamping_s_rad * side * rates_[joint]));
  };
  const auto [left, right] = bodies_.rocker;
  if (left < 0) return;
  const double e = angles_[left] + angles_[right], e_rate = rates_[left] + rates_[right];
  const double torque =
      -bodies_.differential_stiffness_nm_rad * e - bodies_.differential_damping_nms_rad * e_rate;
  for (const int rocker : bodies_.rocker) {
    dynamics_.add_torque(rocker, torque);
    stop(rocker, bodies_.rocker_stop_rad);
  }
  for (const int bogie : bodies_.bogie)
    if (bogie >= 0) stop(bogie, bodies_.bogie_stop_rad);
}

int RoverDynamics::joint_stops() const {
  int stops = 0;
  for (int s = 0; s < 2; ++s) stops += (bodies_.rocker[s] >= 0 ? 1 : 0) + (bodies_.bogie[s] >= 0 ? 1 : 0);
  return stops;
}

RoverDynamics::WheelDriveState RoverDynamics::drive_of(std::size_t k, const double* y) const {
  const WheelModel& wheel = rover_.wheels[k];
  const double rate = rates_[bodies_.wheel[k]];
  WheelDriveState out;
  double driving = 0.0;
  if (wheel.drive == WheelDrive::kDriven && braked_) {
    driving = drive_control_.brake_torque_nm(rate, y[integrals_at_ + k]);
  } else if (wheel.drive == WheelDrive::kDriven) {
    out.motor = drive_control_.keep_rate(commanded_[k].rate_rad_s, rate, y[integrals_at_ + k]);
    driving = out.motor.torque_nm;
  }
  out.torque_nm = driving - wheel.drag_nm * std::tanh(rate / standstill_rad_s_);
  return out;
}

double RoverDynamics::integral_rate_v_s(std::size_t k) const {
  if (rover_.wheels[k].drive != WheelDrive::kDriven) return 0.0;
  const double rate = rates_[bodies_.wheel[k]];
  if (braked_) return drive_control_.brake_integral_rate_v_s(rate);
  return drive_control_.integral_rate_v_s(drive_[k].motor, commanded_[k].rate_rad_s, rate);
}

// As at the quasi-static level, the true attitude is the one that the ground gives plus the rover's attitude
// bias.
Vector3d RoverDynamics::gravity_M() const {
  const Vector3d down(0.0, 0.0, -gravity_m_s2_);
  if (rover_.roll_bias_rad == 0.0 && rover_.pitch_bias_rad == 0.0) return down;
  Attitude truth = attitude_of(R_MB_);
  truth.roll_rad += rover_.roll_bias_rad;
  truth.pitch_rad += rover_.pitch_bias_rad;
  return R_MB_ * (rotation_MB(truth).transpose() * down);
}

void RoverDynamics::set_commanded(double t, const double* y) {
  braked_ = !driver_ || driver_->halts(t);
  halted_share_ = std::exp(-std::max(0.0, t - halted_t_) / kHalting_s);
  if (driver_) {
    const LegPlace at = driver_->uses_pose() ? place(y) : LegPlace{};
    if (t == commanded_t_ && at.across_m == commanded_at_.across_m &&
        at.heading_rad == commanded_at_.heading_rad)
      return;
    commanded_ = driver_->commanded(t, at);
    commanded_t_ = t;
    commanded_at_ = at;
  } else {
    for (std::size_t k = 0; k < commanded_.size(); ++k) commanded_[k] = {halted_rad_[k], 0.0};
  }
  for (std::size_t k = 0; k < commanded_.size(); ++k)
    commanded_[k] = true_motion(rover_.wheels[k], commanded_[k]);
}

// Needs find_kinematics().
bool RoverDynamics::look_at_grounds(const double* y) {
  if (std::equal(looked_at_.begin(), looked_at_.end(), y, y + size_)) return true;
  looked_at_.clear();
  for (std::size_t k = 0; k < kinematics_.size(); ++k) {
    looked_[k] = {};
    if (contacts_.find_ground(ground_, ruts_, k, kinematics_[k], looked_[k])) continue;
    lost_ground_ = kinematics_[k].centre.head<2>();
    return false;
  }
  looked_at_.assign(y, y + size_);
  return true;
}

bool RoverDynamics::derivative(double t, const double* y, double* rate) {
  if (!std::all_of(y, y + size_, [](double value) { return std::isfinite(value); })) return false;
  set_commanded(t, y);
  if (!find_contacts(y)) return false;
  add_suspension_torques();
  for (std::size_t k = 0; k < kinematics_.size(); ++k) {
    const int joint = bodies_.wheel[k];
    const ContactState& contact = contact_[k];
    if (contact.depth_m > 0.0)
      dynamics_.add_force(joint, dynamics_.pivot_B(joint), R_MB_.transpose() * contact.force,
                          R_MB_.transpose() * contact.moment);
    if (const int steering = bodies_.steering[k]; steering >= 0)
      dynamics_.add_torque(
          steering, steering_control_.keep_angle(commanded_[k].steer_rad, angles_[steering], rates_[steering])
                        .torque_nm);
    drive_[k] = drive_of(k, y);
    dynamics_.add_torque(joint, drive_[k].torque_nm);
    rate[slips_at_ + 2 * k] = contact.slip_x_rate;
    rate[slips_at_ + 2 * k + 1] = contact.slip_y_rate;
    rate[integrals_at_ + k] = integral_rate_v_s(k);
  }
  dynamics_.accelerations(gravity_M(), base_rate_, accelerations_.data());

  const Vector3d omega(y[twist_at_], y[twist_at_ + 1], y[twist_at_ + 2]);
  const Vector3d v(y[twist_at_ + 3], y[twist_at_ + 4], y[twist_at_ + 5]);
  Eigen::Map<Vector3d>{rate} = R_MB_ * v;
  const Eigen::Quaterniond q(y[3], y[4], y[5], y[6]);
  const Eigen::Quaterniond turning = q * Eigen::Quaterniond(0.0, omega.x(), omega.y(), omega.z());
  const double to_unit = 1.0 - q.squaredNorm();
  rate[3] = 0.5 * turning.w() + to_unit * q.w();
  rate[4] = 0.5 * turning.x() + to_unit * q.x();
  rate[5] = 0.5 * turning.y() + to_unit * q.y();
  rate[6] = 0.5 * turning.z() + to_unit * q.z();
  for (int j = 0; j < joints(); ++j) {
    if (angle_state_[j] >= 0) rate[angle_state_[j]] = rates_[j];
    rate[rates_at_ + j] = accelerations_[j];
  }
  Eigen::Map<SpatialVector>{rate + twist_at_} = base_rate_;
  return true;
}

bool RoverDynamics::events(double t, const double* y, double* value) {
  if (!std::all_of(y, y + size_, [](double v) { return std::isfinite(v); })) return false;
  unpack(y);
  find_kinematics(y);
  if (!look_at_grounds(y)) return false;
  set_commanded(t, y);
  const bool seeks = driver_ && options_.feedback == Feedback::kPose && t < driver_->cruised_s();
  *value++ = seeks ? 1.0 - driver_->stopping_share() - place(y).share : 1.0;
  *value++ = kTippedRad - tilt_rad(y);
  for (std::size_t k = 0; k < kinematics_.size(); ++k) {
    const double depth = looked_[k].depth_m / rover_.wheels[k].radius_m;
    *value++ = kSunkenAxle_radii - depth;
    *value++ = depth;
    // During the ramps a wheel may be slow without being stalled.
    const bool driven = rover_.wheels[k].drive == WheelDrive::kDriven && driver_ && t > driver_->ramped_s() &&
                        t < driver_->cruised_s();
    const double commanded = std::abs(commanded_[k].rate_rad_s);
    *value++ = driven
                   ? (std::abs(kinematics_[k].rate_rad_s) - kStallShare * commanded) / standstill_rad_s_ + 1.0
                   : 1.0;
  }
  for (int s = 0; s < 2; ++s)
    if (bodies_.rocker[s] >= 0) *value++ = bodies_.rocker_stop_rad - std::abs(angles_[bodies_.rocker[s]]);
  for (int s = 0; s < 2; ++s)
    if (bodies_.bogie[s] >= 0) *value++ = bodies_.bogie_stop_rad - std::abs(angles_[bodies_.bogie[s]]);
  return true;
}

void RoverDynamics::after_step(double t, const double* y) {
  yaw_rad_ = pose(y).yaw_rad;
  lost_ground_.reset();
  unpack(y);
  find_kinematics(y);
  set_commanded(t, y);
  figures_ = {.slip_ratio = slip_ratio(t, y)};
  double power = 0.0;
  for (std::size_t k = 0; k < kinematics_.size(); ++k) {
    const WheelKinematics& at = kinematics_[k];
    const std::optional<std::size_t> soil = ground_.soil_at(at.centre.x(), at.centre.y());
    const Soil& here = soils_.of(soil);
    const double rim = rover_.wheels[k].radius_m * std::abs(at.rate_rad_s);
    if (!has_soil_[k] || soil != soil_[k] || here.rate_shear_exponent != 0.0)
      contacts_.set_soil(k, here, rim);
    has_soil_[k] = true;
    soil_[k] = soil;
    drive_[k] = drive_of(k, y);
    const MotorDrive& motor = drive_[k].motor;
    power += motor.electric_power_w;
    figures_.current_a = std::max(figures_.current_a, std::abs(motor.current_a));
    if (stepped_) turned_rad_[k] += 0.5 * (at.rate_rad_s + last_rate_rad_s_[k]) * (t - last_t_);
    last_rate_rad_s_[k] = at.rate_rad_s;
  }
  note_stall(t);
  if (stepped_) energy_j_ += 0.5 * (power + last_power_w_) * (t - last_t_);
  last_power_w_ = power;
  last_t_ = t;
  stepped_ = true;
  const bool has_grounds = look_at_grounds(y);
  for (std::size_t k = 0; has_grounds && k < kinematics_.size(); ++k) {
    const ContactState& contact = looked_[k];
    if (contact.depth_m <= 0.0) continue;
    figures_.sinkage_m = std::max(figures_.sinkage_m, contact.depth_m + contact.rut_m);
    const WheelModel& wheel = rover_.wheels[k];
    trails_[k].move_to(kinematics_[k].centre.head<2>(), contact.depth_m + contact.rut_m, wheel.width_m,
                       wheel.radius_m + 2.0 * ruts_.cell_m(), ruts_);
  }
  // The ruts have changed, and the driver's trim may change now.
  looked_at_.clear();
  commanded_t_ = -1.0;
  if (!options_.keep_ruts) ruts_.forget_beyond(p_MB_.head<2>(), kForgotten_lengths * rover_.body_length_m);
}

// During the ramps a wheel may be slow without being stalled.
void RoverDynamics::note_stall(double t) {
  if (!driver_ || driver_->rate_share(t) < 1.0) return;
  stall_.reset();
  for (std::size_t k = 0; k < kinematics_.size() && !stall_; ++k) {
    const MotorDrive& motor = drive_[k].motor;
    const double share = kinematics_[k].rate_rad_s / commanded_[k].rate_rad_s;
    if (motor.limit != MotorLimit::kNone && !(share >= kStallShare))
      stall_ = {k, motor.limit, motor.current_a};
  }
}

void RoverDynamics::reset_counts() {
  energy_j_ = 0.0;
  for (double& turned : turned_rad_) turned = 0.0;
}

}  // namespace slipway::sim
