#include "sim/quasi_static.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>

#include "sim/entry_angle.h"
#include "sim/motor.h"
#include "sim/rover_balance.h"
#include "sim/slip_ratio.h"

namespace slipway::sim {
namespace {

using Vector = RoverBalance::Vector;
using Matrix = RoverBalance::Matrix;
constexpr int kMotions = RoverBalance::kMotions;

constexpr double kTolerance = 1e-9;  // of the weight, and of the weight times half the wheelbase
constexpr double kLeastEntryAngleRad = 1e-3;
constexpr double kSpinningSpeedRatio = 0.02;  // at 98 % slip a drive counts as immobilised
constexpr double kFastestSpeedRatio = 3.0;    // and at 200 % of the wheels' speed it slides away downhill

// The motion that the driver asks for, and the equation that fixes it.
struct Primary {
  int motion = 0;     // 0 forward, 2 yaw
  int equation = 0;   // 0 force along x, 5 moment about z
  double sign = 1.0;  // of the commanded motion
};

Primary primary_of(const DriveCommand& command) {
  if (command.turn_in_place) return {2, 5, command.turn_rate_rad_s < 0.0 ? -1.0 : 1.0};
  return {0, 0, command.speed_m_s < 0.0 ? -1.0 : 1.0};
}

// Takes as much of a Newton step as keeps every entry angle positive and every change moderate.
Vector limited_step(const Vector& x, const Vector& full) {
  double share = 1.0;
  const double fastest = full.head<kMotions>().cwiseAbs().maxCoeff();
  if (fastest > 0.5) share = 0.5 / fastest;
  for (int k = kMotions; k < full.size(); ++k) {
    if (full[k] < -0.6 * x[k]) share = std::min(share, -0.6 * x[k] / full[k]);
    if (full[k] > 0.2) share = std::min(share, 0.2 / full[k]);
  }
  return share * full;
}

void keep_in_range(Vector& x) {
  for (int k = kMotions; k < x.size(); ++k)
    x[k] = std::clamp(x[k], kLeastEntryAngleRad, kLargestEntryAngleRad);
}

// Newton with Broyden's updates between fresh Jacobians [Broyden 1965]: near the answer an update costs six
// wheel evaluations where a Jacobian costs twenty-four.
class NewtonSearch {
 public:
  // With `held`, its motion keeps its value and its equation is left out.
  NewtonSearch(RoverBalance& balance, const Primary* held) : balance_(balance), held_(held) {}

  bool solve(Vector& x, int most_iterations) {
    Vector r = residual(x);
    bool fresh = false;
    for (int iteration = 0; iteration < most_iterations; ++iteration) {
      if (r.cwiseAbs().maxCoeff() < kTolerance) return true;
      if (!have_inverse_) {
        if (!invert_jacobian(x)) return false;
        fresh = true;
      }
      const Vector step = limited_step(x, -(inverse_ * r));
      Vector next = x + step;
      keep_in_range(next);
      Vector next_r = residual(next);
      if (next_r.norm() > 0.5 * r.norm()) {
        have_inverse_ = false;
        if (!fresh) {  // a stale direction: look again from here, or from there where that is better
          if (next_r.norm() < r.norm()) {
            x = next;
            r = next_r;
          } else {
            balance_.residual(x);
          }
          continue;
        }
        backtrack(x, step, r.norm(), next, next_r);
      } else {
        update(next - x, next_r - r);
      }
      fresh = false;
      x = next;
      r = next_r;
    }
    return r.cwiseAbs().maxCoeff() < kTolerance;
  }

 private:
  Vector residual(const Vector& x) {
    Vector r = balance_.residual(x);
    if (held_) r[held_->equation] = 0.0;
    return r;
  }

  // At the point of the last residual.
  bool invert_jacobian(const Vector& x) {
    Matrix jacobian = balance_.jacobian(x);
    if (held_) {
      jacobian.row(held_->equation).setZero();
      jacobian(held_->equation, held_->motion) = 1.0;
    }
    inverse_ = jacobian.partialPivLu().inverse();
    have_inverse_ = inverse_.allFinite();
    return have_inverse_;
  }

  void backtrack(const Vector& x, Vector step, double before, Vector& next, Vector& next_r) {
    for (int halving = 0; halving < 6 && next_r.norm() > (1.0 - 1e-4) * before; ++halving) {
      step *= 0.5;
      next = x + step;
      keep_in_range(next);
      next_r = residual(next);
    }
  }

  void update(const Vector& moved, const Vector& change) {
    const Vector by = inverse_ * change;
    const double denominator = moved.dot(by);
    if (std::abs(denominator) < 1e-300) return;
    const Eigen::Matrix<double, 1, RoverBalance::kEquations> row = moved.transpose() * inverse_;
    inverse_ += ((moved - by) / denominator) * row;
  }

  RoverBalance& balance_;
  const Primary* held_;
  Matrix inverse_;
  bool have_inverse_ = false;
};

bool newton(RoverBalance& balance, Vector& x, const Primary* held, int most_iterations) {
  return NewtonSearch(balance, held).solve(x, most_iterations);
}

// Entry angles for resting loads by Bekker's closed form; the primary motion at a share of what was
// commanded.
Vector cold_start(const RoverModel& rover, const std::array<Soil, kWheels>& soils,
                  const RoverBalance& balance, const Primary& primary, double share) {
  Vector x = Vector::Zero();
  x[primary.motion] = primary.sign * share;
  const auto loads = balance.resting_loads_n();
  for (int k = 0; k < kWheels; ++k) {
    const WheelGeometry wheel{rover.wheels[k].radius_m, rover.wheels[k].width_m};
    const double load = std::max(loads[k], 0.02 * balance.weight_n());
    x[kMotions + k] = entry_angle_rad(wheel.radius_m, bekker_sinkage_m(wheel, soils[k], load));
  }
  keep_in_range(x);
  return x;
}

struct Attempt {
  Outcome outcome = Outcome::kMoving;
  int wheel = -1;
};

// Why no balance was found, read off the last iterate.
Attempt reason_of(const Vector& x) {
  if (x.head<kMotions>().cwiseAbs().maxCoeff() > kFastestSpeedRatio) return {Outcome::kNoTraction, -1};
  for (int k = 0; k < kWheels; ++k)
    if (x[kMotions + k] > 0.95 * kLargestEntryAngleRad) return {Outcome::kSunkToAxle, k};
  for (int k = 0; k < kWheels; ++k)
    if (x[kMotions + k] < 10.0 * kLeastEntryAngleRad) return {Outcome::kWheelLifted, k};
  return {Outcome::kNotConverged, -1};
}

// The slow and certain way: the net push along the commanded motion falls as the rover goes faster, so its
// zero is bracketed. No push left at full spin: no traction. Still pushed at three times the wheels' speed:
// it slides away.
Attempt bracketed(const RoverModel& rover, const std::array<Soil, kWheels>& soils, RoverBalance& balance,
                  const Primary& primary, Vector& x) {
  const auto push_at = [&](double ratio, Vector& state) -> std::optional<double> {
    state[primary.motion] = primary.sign * ratio;
    if (!newton(balance, state, &primary, 60)) return std::nullopt;
    return primary.sign * balance.residual(state)[primary.equation];
  };
  constexpr std::array<double, 7> kRatios{kSpinningSpeedRatio, 0.2, 0.5, 0.8, 1.0, 1.5, kFastestSpeedRatio};
  std::optional<double> slower_ratio;
  Vector state = cold_start(rover, soils, balance, primary, kRatios[2]);
  x = state;
  bool solved_any = false;
  for (const double ratio : kRatios) {
    Vector trial = state;
    const std::optional<double> push = push_at(ratio, trial);
    x = trial;
    if (!push) continue;
    solved_any = true;
    state = trial;
    if (*push <= 0.0) {
      if (!slower_ratio) return {Outcome::kNoTraction, -1};
      double low = *slower_ratio, high = ratio;
      for (int iteration = 0; iteration < 60 && high - low > 1e-12; ++iteration) {
        Vector full = state;
        if (newton(balance, full, nullptr, 20)) {
          x = full;
          return {};
        }
        const double middle = 0.5 * (low + high);
        const std::optional<double> there = push_at(middle, state);
        if (!there) return reason_of(state);
        (*there > 0.0 ? low : high) = middle;
      }
      x = state;
      return {};
    }
    slower_ratio = ratio;
  }
  return solved_any && slower_ratio == kFastestSpeedRatio ? Attempt{Outcome::kNoTraction, -1} : reason_of(x);
}

WheelState wheel_state(const RoverModel& rover, const RoverBalance& balance, const Vector& x, int k) {
  const WheelForces& f = balance.forces(k);
  const WheelMotion motion = balance.motion_of(k, x);
  const double direction = balance.command(k).rate_rad_s < 0.0 ? -1.0 : 1.0;
  const double torque = direction * f.torque_nm;
  return {.load_n = f.vertical_n,
          .slip_ratio = bounded_slip(slip_from_speed_ratio(motion.forward)),
          .slip_angle_rad = std::atan2(motion.leftward, motion.forward),
          .entry_angle_rad = x[kMotions + k],
          .sinkage_m = sinkage_m(rover.wheels[k].radius_m, x[kMotions + k]),
          .drawbar_pull_n = direction * f.drawbar_pull_n,
          .lateral_force_n = f.lateral_n,
          .torque_nm = torque,
          .current_a = motor_state(rover.drive, torque, balance.command(k).rate_rad_s).current_a};
}

StationState state_of(const RoverModel& rover, RoverBalance& balance, const Vector& x,
                      const DriveCommand& command, const Primary& primary, const Attempt& attempt) {
  StationState state;
  state.outcome = attempt.outcome;
  state.wheel = attempt.wheel;
  balance.residual(x);
  const double v = balance.speed_scale_m_s();
  state.forward_m_s = x[0] * v;
  state.leftward_m_s = x[1] * v;
  state.yaw_rate_rad_s = x[2] * v / balance.half_wheelbase_m();
  const double told = attainable_share(rover, command) *
                      (command.turn_in_place ? command.turn_rate_rad_s : command.speed_m_s);
  const double done = primary.motion == 2 ? state.yaw_rate_rad_s : state.forward_m_s;
  state.slip_ratio =
      attempt.outcome == Outcome::kNoTraction ? 1.0 : bounded_slip(slip_from_speed_ratio(done / told));
  state.side_slip_rad =
      command.turn_in_place ? 0.0 : std::atan2(state.leftward_m_s, std::abs(state.forward_m_s));
  for (int k = 0; k < kWheels; ++k) {
    state.wheels[k] = wheel_state(rover, balance, x, k);
    const MotorState motor =
        motor_state(rover.drive, state.wheels[k].torque_nm, balance.command(k).rate_rad_s);
    state.electric_power_w += motor.electric_power_w;
    if (state.moving() && stalls(rover.drive, motor)) {
      state.outcome = Outcome::kStalled;
      state.wheel = k;
    }
  }
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
  }
  return "unknown outcome";
}

QuasiStaticSolver::QuasiStaticSolver(const RoverModel& rover, double gravity_m_s2)
    : rover_(rover), gravity_m_s2_(gravity_m_s2) {}

StationState QuasiStaticSolver::solve(const Stance& stance, const Soil& soil, const DriveCommand& command) {
  std::array<Soil, kWheels> soils;
  soils.fill(soil);
  return solve(stance, soils, command);
}

StationState QuasiStaticSolver::solve(const Stance& stance, const std::array<Soil, kWheels>& soils,
                                      const DriveCommand& command) {
  RoverBalance balance(rover_, gravity_m_s2_, stance, soils, command);
  const Primary primary = primary_of(command);
  // A start from another kind of motion is worse than a cold one.
  if (last_[primary.motion] * primary.sign <= 0.0) warm_ = false;
  Vector x = warm_ ? last_ : cold_start(rover_, soils, balance, primary, 0.9);
  Attempt attempt;
  bool solved = newton(balance, x, nullptr, warm_ ? 20 : 40);
  if (!solved && warm_) {
    x = cold_start(rover_, soils, balance, primary, 0.9);
    solved = newton(balance, x, nullptr, 40);
  }
  // A root beyond full spin is the rover sliding back against its wheels.
  if (solved && x[primary.motion] * primary.sign < kSpinningSpeedRatio) attempt = {Outcome::kNoTraction, -1};
  if (!solved) attempt = bracketed(rover_, soils, balance, primary, x);
  warm_ = attempt.outcome == Outcome::kMoving;
  if (warm_) last_ = x;
  return state_of(rover_, balance, x, command, primary, attempt);
}

}  // namespace slipway::sim
