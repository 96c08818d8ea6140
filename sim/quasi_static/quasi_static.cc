#include "sim/quasi_static/quasi_static.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/quasi_static/balance_search.h"
#include "sim/quasi_static/rover_balance.h"
#include "sim/quasi_static/slip_curve_motion.h"
#include "sim/rover/motor.h"
#include "sim/wheel/slip_ratio.h"

namespace slipway::sim {
namespace {

using Vector = RoverBalance::Vector;

constexpr double kDrawTolerance = 1e-5;
// Where a draw takes more, the rover mostly has no traction, which the bracketing finds sooner.
constexpr int kMaxDrawIterations = 8;

// Slip of the rim against the ground; a locked wheel's is exactly -1.
double slip_of(const RoverBalance::WheelContact& contact) {
  const double forward = contact.motion.forward;
  const double u =
      contact.rate_rad_s != 0.0 ? forward : std::copysign(std::numeric_limits<double>::infinity(), forward);
  return bounded_slip(slip_from_speed_ratio(u));
}

WheelState wheel_state(const RoverBalance& balance, const Vector& x, int k) {
  const RoverBalance::WheelContact& contact = balance.contact(k);
  const double direction = balance.direction(k);
  WheelState state;
  state.rate_rad_s = contact.rate_rad_s;
  state.slip_ratio = slip_of(contact);
  state.slip_angle_rad = std::atan2(contact.motion.leftward, contact.motion.forward);
  state.in_air = balance.in_air(k);
  if (state.in_air) return state;
  state.load_n = contact.forces.vertical_n;
  state.entry_angle_rad = x[RoverBalance::kMotions + k];
  state.drawbar_pull_n = direction * contact.forces.drawbar_pull_n;
  state.lateral_force_n = contact.forces.lateral_n;
  state.torque_nm = direction * contact.forces.torque_nm;
  return state;
}

// Sets the sinkages below the undisturbed surface and the depths of the ruts that the rover leaves. A side's
// rut is that of its last wheel on the ground in the direction of travel; when turning in place, of its
// deepest.
void set_depths(const RoverModel& rover, const RoverBalance& balance, const Vector& x,
                const DriveCommand& command, StationState& state) {
  const PerWheel<double> depth = balance.total_sinkages_m(x);
  const Eigen::Vector2d travel = (command.speed_m_s < 0.0 ? -1.0 : 1.0) * balance.geometry().travel;
  for (const Side side : {Side::kLeft, Side::kRight}) {
    double last = std::numeric_limits<double>::infinity();
    double& rut = side == Side::kLeft ? state.left_rut_depth_m : state.right_rut_depth_m;
    for (std::size_t k = 0; k < depth.size(); ++k) {
      if (state.wheels[k].in_air) continue;
      state.wheels[k].sinkage_m = depth[k];
      if (rover.wheels[k].side != side) continue;
      const double place =
          command.turn_in_place ? -depth[k] : travel.dot(rover.wheels[k].position_m.head<2>());
      if (place >= last) continue;
      last = place;
      rut = depth[k];
    }
  }
}

// Sets the currents and the power of the driven wheels. The first wheel that exceeds its motor's limits
// stalls the rover.
void set_motors(const RoverModel& rover, const RoverBalance& balance, StationState& state) {
  const DriveMotor& drive = balance.geometry().drive;
  for (std::size_t k = 0; k < state.wheels.size(); ++k) {
    const WheelModel& wheel = rover.wheels[k];
    if (wheel.drive != WheelDrive::kDriven) continue;
    WheelState& at = state.wheels[k];
    const double drag = balance.direction(static_cast<int>(k)) * wheel.drag_nm;
    const MotorState motor = motor_state(drive, at.torque_nm + drag, at.rate_rad_s);
    at.current_a = motor.current_a;
    state.electric_power_w += motor.electric_power_w;
    if (state.moving() && stalls(drive, motor)) {
      state.outcome = Outcome::kStalled;
      state.wheel = static_cast<int>(k);
    }
  }
}

Attitude leant(const Stance& stance, const RoverBalance::Lean& lean) {
  const Eigen::Matrix3d turned =
      rotation_MB({.roll_rad = lean.roll_rad, .pitch_rad = lean.pitch_rad, .yaw_rad = 0.0});
  Attitude attitude = attitude_of(stance.R_MB * turned);
  attitude.yaw_rad = stance.attitude.yaw_rad;
  return attitude;
}

bool any_slip_curve(const PerWheel<Soil>& soils) {
  return std::any_of(soils.begin(), soils.end(), [](const Soil& soil) { return soil.slip_curve != nullptr; });
}

StationState state_of(const RoverModel& rover, RoverBalance& balance, const Vector& x,
                      const DriveCommand& command, const Attempt& attempt) {
  StationState state;
  state.outcome = attempt.outcome;
  state.wheel = attempt.wheel;
  balance.residual(x);
  const Stance& stance = *balance.geometry().stance;
  state.attitude = attempt.outcome == Outcome::kMoving ? leant(stance, balance.lean(x)) : stance.attitude;
  const double v = balance.speed_scale_m_s();
  const double along = x[0] * v, across = x[1] * v;
  const Eigen::Vector2d d = balance.geometry().travel;
  state.along_m_s = along;
  state.forward_m_s = along * d.x() - across * d.y();
  state.leftward_m_s = along * d.y() + across * d.x();
  state.yaw_rate_rad_s = x[2] * v / balance.half_wheelbase_m();
  const double commanded = balance.geometry().attainable_share *
                           (command.turn_in_place ? command.turn_rate_rad_s : command.speed_m_s);
  const double done = command.turn_in_place ? state.yaw_rate_rad_s : along;
  state.slip_ratio =
      attempt.outcome == Outcome::kNoTraction ? 1.0 : bounded_slip(slip_from_speed_ratio(done / commanded));
  state.side_slip_rad = command.turn_in_place ? 0.0 : std::atan2(across, std::abs(along));
  state.wheels = PerWheel<WheelState>(rover.wheels.size());
  for (int k = 0; k < balance.wheel_count(); ++k) state.wheels[k] = wheel_state(balance, x, k);
  set_depths(rover, balance, x, command, state);
  set_motors(rover, balance, state);
  return state;
}

}  // namespace

std::string_view describe(Outcome outcome) {
  switch (outcome) {
    case Outcome::kMoving:
      return "moving";
    case Outcome::kNoTraction:
      return "no traction";
    case Outcome::kWheelLifted:
      return "wheel lifted";
    case Outcome::kSunkToAxle:
      return "sunk to the axle";
    case Outcome::kStalled:
      return "motor stalled";
    case Outcome::kNotConverged:
      return "not converged";
    case Outcome::kOutsideSlipCurve:
      return "outside the slip curve";
  }
  return "unknown outcome";
}

double measured_slip(const StationState& state, const DriveCommand& command) {
  return command.turn_in_place ? 1.0 - state.yaw_rate_rad_s / command.turn_rate_rad_s
                               : 1.0 - state.along_m_s / command.speed_m_s;
}

QuasiStaticSolver::QuasiStaticSolver(const RoverModel& rover, double gravity_m_s2, Precision precision)
    : rover_(rover), gravity_m_s2_(gravity_m_s2), precision_(precision) {}

StationState QuasiStaticSolver::solve(const Stance& stance, const Soil& soil, const DriveCommand& command) {
  return solve(stance, PerWheel<Soil>(rover_.wheels.size(), soil), command);
}

// A balance can't be found with wheels whose forces are unknown. On the border of such ground the other
// ground's soil is put under all wheels, and the motion is the slower one.
StationState QuasiStaticSolver::solve_with_slip_curves(const Stance& stance, const PerWheel<Soil>& soils,
                                                       const DriveCommand& command,
                                                       Thoroughness thoroughness) {
  StationState state = motion_on_slip_curves(rover_, stance, soils, command);
  const auto modelled =
      std::find_if(soils.begin(), soils.end(), [](const Soil& s) { return s.slip_curve == nullptr; });
  if (modelled == soils.end() || !state.moving()) return state;
  PerWheel<Soil> replaced = soils;
  for (Soil& soil : replaced)
    if (soil.slip_curve != nullptr) soil = *modelled;
  StationState other = solve(stance, replaced, command, nullptr, thoroughness);
  if (other.moving() && std::abs(other.slip_ratio) <= std::abs(state.slip_ratio)) return state;
  other.by_slip_curve = true;
  other.attitude = stance.attitude;
  other.wheels = state.wheels;
  other.wheel = -1;
  other.electric_power_w = other.left_rut_depth_m = other.right_rut_depth_m = 0.0;
  return other;
}

StationState QuasiStaticSolver::solve(const Stance& stance, const PerWheel<Soil>& soils,
                                      const DriveCommand& command, const Start* start,
                                      Thoroughness thoroughness) {
  if (any_slip_curve(soils)) return solve_with_slip_curves(stance, soils, command, thoroughness);
  RoverBalance balance(rover_, gravity_m_s2_, stance, soils, command, outside_ ? &*outside_ : nullptr);
  return solve(balance, command, start, thoroughness);
}

StationState QuasiStaticSolver::solve(const BalanceGeometry& geometry, const PerWheel<Soil>& soils,
                                      const Start* start, Thoroughness thoroughness) {
  if (any_slip_curve(soils))
    return solve_with_slip_curves(*geometry.stance, soils, geometry.command, thoroughness);
  RoverBalance balance(geometry, soils);
  return solve(balance, geometry.command, start, thoroughness);
}

StationState QuasiStaticSolver::solve(RoverBalance& balance, const DriveCommand& command, const Start* start,
                                      Thoroughness thoroughness) {
  const Primary primary = primary_of(command);
  if (start != nullptr) {
    warm_ = true;
    last_ = start->unknowns;
  }
  // The answer of another kind of motion is a worse start than a cold one.
  if (warm_ && last_[primary.motion] * primary.sign <= 0.0) warm_ = false;
  NewtonMemory memory;
  if (precision_ == Precision::kDraws) {
    memory.by_wheel = true;
    if (warm_) memory.slopes = std::move(last_slopes_);
    memory.tolerance = kDrawTolerance;
    memory.max_iterations = kMaxDrawIterations;
  }
  if (start != nullptr) memory.inverse = start->inverse_jacobian;
  const Attempt attempt = find_balance(balance, primary, warm_, last_, &memory, thoroughness);
  last_slopes_ = std::move(memory.slopes);
  warm_ = attempt.outcome == Outcome::kMoving;
  return state_of(rover_, balance, last_, command, attempt);
}

void QuasiStaticSolver::follow(const RoverBalance::Vector& from, const RoverBalance::Vector& to) {
  if (!warm_) {
    warm_ = true;
    last_ = to;
    last_slopes_.reset();
    return;
  }
  constexpr int kMotions = RoverBalance::kMotions;
  last_.head<kMotions>() += to.head<kMotions>() - from.head<kMotions>();
  for (int k = kMotions; k < last_.size(); ++k) last_[k] *= to[k] / from[k];
  keep_in_range(last_);
}

std::optional<QuasiStaticSolver::Start> QuasiStaticSolver::start_of_last(const Stance& stance,
                                                                         const PerWheel<Soil>& soils,
                                                                         const DriveCommand& command) const {
  if (!warm_) return std::nullopt;
  RoverBalance balance(rover_, gravity_m_s2_, stance, soils, command, outside_ ? &*outside_ : nullptr);
  if (balance.can_spare_a_wheel()) balance.resting_loads_n();  // for the wheels that hang
  if (!balance.all_in_contact()) return std::nullopt;
  balance.residual(last_);
  const std::optional<RoverBalance::Matrix> inverse = inverse_jacobian(balance, last_);
  return inverse ? std::optional(Start{last_, *inverse}) : std::nullopt;
}

}  // namespace slipway::sim
