#include "rover_balance.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace slipway::gap_benchmark {
namespace {

using Vector9 = Eigen::Matrix<double, 9, 1>;
using Matrix9 = Eigen::Matrix<double, 9, 9>;

constexpr double kDepthStep_m = 1e-6, kSpeedStep_m_s = 1e-7;
constexpr int kMaxSteps = 60;
constexpr double kBalanced = 1e-8;  // of the weight

class Balance {
 public:
  Balance(const RoverOnFile& rover, const BalanceTask& task, const WheelLaw& law, const Closure& closure,
          const HiddenTruth& hidden)
      : rover_(rover),
        task_(task),
        law_(law),
        closure_(closure),
        radius_(rover.radius_m * (1.0 + hidden.radius_scale)),
        weight_(rover.mass_kg * task.gravity_m_s2.norm()) {
    com_ = rover.com_m + Eigen::Vector3d(hidden.com_shift_m[0], hidden.com_shift_m[1], hidden.com_shift_m[2]);
  }

  bool solve(BalanceState& state, bool held) const {
    Vector9 x;
    x << state.forward_m_s, state.left_m_s, state.yaw_rate_rad_s, 0, 0, 0, 0, 0, 0;
    if (held) x.head<3>().setZero();
    for (int k = 0; k < kWheels; ++k) x[3 + k] = std::clamp(state.depth_m[k], 1e-4, 0.1);
    Matrix9 slope;
    std::array<WheelLoads, kWheels> loads;
    Vector9 residual = residual_of(x, held, &slope, loads);
    for (int step = 0; step < kMaxSteps; ++step) {
      if (residual.cwiseAbs().maxCoeff() < kBalanced) {
        state.forward_m_s = x[0];
        state.left_m_s = x[1];
        state.yaw_rate_rad_s = x[2];
        for (int k = 0; k < kWheels; ++k) state.depth_m[k] = x[3 + k];
        state.loads = loads;
        state.held = held;
        return true;
      }
      Vector9 move = slope.partialPivLu().solve(-residual);
      if (!move.allFinite()) return false;
      double share = 1.0;
      for (int k = 0; k < kWheels; ++k) share = std::min(share, 0.004 / (std::abs(move[3 + k]) + 1e-12));
      share = std::min(share, 0.02 / (move.head<2>().norm() + 1e-12));
      share = std::min(share, 0.03 / (std::abs(move[2]) + 1e-12));
      bool improved = false;
      for (int half = 0; half < 12; ++half, share *= 0.5) {
        Vector9 next = x + share * move;
        for (int k = 0; k < kWheels; ++k) next[3 + k] = std::clamp(next[3 + k], 1e-5, 0.115);
        std::array<WheelLoads, kWheels> next_loads;
        Matrix9 next_slope;
        const Vector9 next_residual = residual_of(next, held, &next_slope, next_loads);
        if (next_residual.norm() < residual.norm() * (1.0 - 1e-4 * share)) {
          x = next;
          residual = next_residual;
          slope = next_slope;
          loads = next_loads;
          improved = true;
          break;
        }
      }
      if (!improved) return false;
    }
    return false;
  }

 private:
  // Sums of one wheel: force x, y, z, moment x, y, z, pitch about its bogie's pivot, about its rocker's.
  using Entry = Eigen::Matrix<double, 8, 1>;

  Entry entry_of(int k, double forward, double left, double depth, WheelLoads& loads) const {
    const WheelPlace& place = task_.wheels[static_cast<std::size_t>(k)];
    const double steer = place.steer_rad, c = std::cos(steer), s = std::sin(steer);
    WheelMotion motion;
    motion.forward_m_s = c * forward + s * left;
    motion.left_m_s = -s * forward + c * left;
    motion.rate_rad_s = place.rate_rad_s;
    loads = law_.loads(depth, motion, place.soil);
    const Eigen::Vector3d along(c, s, c * place.grade_x + s * place.grade_y);
    const Eigen::Vector3d across(-s, c, -s * place.grade_x + c * place.grade_y);
    const Eigen::Vector3d up(-place.grade_x, -place.grade_y, 1.0);
    const Eigen::Vector3d force = loads.normal_n * up + loads.pull_n * along + loads.side_n * across +
                                  place.pull_n * Eigen::Vector3d::UnitX();
    const Eigen::Vector2d& at = rover_.wheel_m[static_cast<std::size_t>(k)];
    const Eigen::Vector3d axle(at.x(), at.y(), place.height_m + radius_);
    // Pull and side force act on the ground and have a moment about the axle; of the pull perhaps only a
    // share does.
    const double below = closure_.pull_below_axle;
    const double twist = below * radius_ * loads.pull_n + (1.0 - below) * loads.torque_nm;
    const Eigen::Vector3d moment = -twist * across + radius_ * loads.side_n * along;
    Entry entry;
    entry.head<3>() = force;
    entry.segment<3>(3) = axle.cross(force) + moment;
    const bool bogie = k % 3 != 0;
    entry[6] = bogie ? pitch_about(rover_.bogie_pivot_m, axle, force) + moment.y() : 0.0;
    entry[7] = pitch_about(rover_.rocker_pivot_m, axle, force) + moment.y();
    return entry;
  }

  static double pitch_about(const Eigen::Vector3d& pivot, const Eigen::Vector3d& at,
                            const Eigen::Vector3d& force) {
    return (at.z() - pivot.z()) * force.x() - (at.x() - pivot.x()) * force.z();
  }

  Vector9 place_entry(int k, const Entry& entry, bool held) const {
    Vector9 out = Vector9::Zero();
    const double side = k < 3 ? 1.0 : -1.0;
    out[0] = held ? 0.0 : entry[0];
    out[1] = held ? 0.0 : entry[1];
    out[2] = held ? 0.0 : entry[5];
    out[3] = entry[2];
    out[4] = entry[3];
    out[5] = entry[4];
    out[6] = k < 3 ? entry[6] : 0.0;
    out[7] = k >= 3 ? entry[6] : 0.0;
    out[8] = side * entry[7];
    return out / weight_;
  }

  Vector9 residual_of(const Vector9& x, bool held, Matrix9* slope,
                      std::array<WheelLoads, kWheels>& loads) const {
    const Eigen::Vector3d gravity = rover_.mass_kg * task_.gravity_m_s2;
    const Eigen::Vector3d turning = com_.cross(gravity) + task_.pull_at_m.cross(task_.pull_n);
    Vector9 sum = Vector9::Zero();
    const Eigen::Vector3d force = gravity + task_.pull_n;
    if (!held) sum.head<3>() << force.x(), force.y(), turning.z();
    sum.segment<3>(3) << force.z(), turning.x(), turning.y();
    sum /= weight_;
    slope->setZero();
    if (held) {
      sum.head<3>() = x.head<3>();
      slope->topLeftCorner<3, 3>().setIdentity();
    }
    for (int k = 0; k < kWheels; ++k) {
      const Eigen::Vector2d& at = rover_.wheel_m[static_cast<std::size_t>(k)];
      const double forward = x[0] - x[2] * at.y(), left = x[1] + x[2] * at.x(), depth = x[3 + k];
      WheelLoads other;
      const Vector9 here =
          place_entry(k, entry_of(k, forward, left, depth, loads[static_cast<std::size_t>(k)]), held);
      sum += here;
      const Vector9 by_depth =
          (place_entry(k, entry_of(k, forward, left, depth + kDepthStep_m, other), held) - here) /
          kDepthStep_m;
      slope->col(3 + k) += by_depth;
      if (held) continue;
      const Vector9 by_forward =
          (place_entry(k, entry_of(k, forward + kSpeedStep_m_s, left, depth, other), held) - here) /
          kSpeedStep_m_s;
      const Vector9 by_left =
          (place_entry(k, entry_of(k, forward, left + kSpeedStep_m_s, depth, other), held) - here) /
          kSpeedStep_m_s;
      slope->col(0) += by_forward;
      slope->col(1) += by_left;
      slope->col(2) += -at.y() * by_forward + at.x() * by_left;
    }
    return sum;
  }

  const RoverOnFile& rover_;
  const BalanceTask& task_;
  const WheelLaw& law_;
  const Closure& closure_;
  double radius_, weight_;
  Eigen::Vector3d com_;
};

}  // namespace

bool balance_rover(const RoverOnFile& rover, const BalanceTask& task, const WheelLaw& law,
                   const Closure& closure, const HiddenTruth& hidden, BalanceState& state) {
  const Balance balance(rover, task, law, closure, hidden);
  const BalanceState start = state;
  if (balance.solve(state, false)) return true;
  // The search starts from the loads at rest, at several shares of the commanded speed.
  for (const double share : {0.9, 0.6, 0.3, 0.1}) {
    state = BalanceState{};
    double rim = 0.0, turn = 0.0;
    for (std::size_t k = 0; k < kWheels; ++k) {
      const WheelPlace& place = task.wheels[k];
      rim += place.rate_rad_s * rover.radius_m * std::cos(place.steer_rad) / kWheels;
      turn -= place.rate_rad_s * rover.radius_m * (rover.wheel_m[k].y() > 0 ? 1.0 : -1.0) / 0.7 / kWheels;
    }
    state.forward_m_s = share * rim;
    state.yaw_rate_rad_s = share * turn;
    if (balance.solve(state, false)) return true;
  }
  state = start;
  state.depth_m.fill(0.015);
  return balance.solve(state, true);
}

}  // namespace slipway::gap_benchmark
