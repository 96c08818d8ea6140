#include "sim/quasi_static/newton_search.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "sim/quasi_static/small_solve.h"

namespace slipway::sim {
namespace {

using Vector = RoverBalance::Vector;
using Matrix = RoverBalance::Matrix;
constexpr int kMotions = RoverBalance::kMotions;

// Takes the largest part of a Newton step that keeps every entry angle positive and every change moderate.
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

// Halves a step that has not brought the residual down far enough.
template <class Residual>
void backtrack(const Vector& x, Vector step, double before, Residual residual, Vector& next, Vector& next_r) {
  for (int halving = 0; halving < 6 && next_r.norm() > (1.0 - 1e-4) * before; ++halving) {
    step *= 0.5;
    next = x + step;
    keep_in_range(next);
    next_r = residual(next);
  }
}

// Newton with Broyden's updates between fresh Jacobians [Broyden 1965]: near the answer an update costs one
// evaluation a wheel where a Jacobian costs four.
class NewtonSearch {
 public:
  // With `held`, its motion keeps its value and its equation is left out.
  NewtonSearch(RoverBalance& balance, const Primary* held, const NewtonMemory* memory)
      : balance_(balance), held_(held), have_inverse_(memory != nullptr && memory->inverse) {
    if (have_inverse_) inverse_ = *memory->inverse;
    if (memory != nullptr) tolerance_ = memory->tolerance;
  }

  bool solve(Vector& x, int max_iterations) {
    Vector r = residual(x);
    bool fresh = false;
    for (int iteration = 0; iteration < max_iterations; ++iteration) {
      if (r.cwiseAbs().maxCoeff() < tolerance_) return true;
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
        if (!fresh) {  // the direction is out of date: try again with a fresh Jacobian from the better point
          if (next_r.norm() < r.norm()) {
            x = next;
            r = next_r;
          } else {
            balance_.residual(x);
          }
          continue;
        }
        backtrack(
            x, step, r.norm(), [&](const Vector& at) { return residual(at); }, next, next_r);
      } else {
        update(next - x, next_r - r);
      }
      fresh = false;
      x = next;
      r = next_r;
    }
    return r.cwiseAbs().maxCoeff() < tolerance_;
  }

 private:
  Vector residual(const Vector& x) {
    Vector r = balance_.residual(x);
    if (held_) r[held_->equation] = 0.0;
    return r;
  }

  // The Jacobian at the point of the last residual.
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

  void update(const Vector& moved, const Vector& change) {
    const Vector by = inverse_ * change;
    const double denominator = moved.dot(by);
    if (std::abs(denominator) < 1e-300) return;
    const Vector row = inverse_.transpose() * moved;
    inverse_.noalias() += ((moved - by) / denominator) * row.transpose();
  }

  RoverBalance& balance_;
  const Primary* held_;
  Matrix inverse_;
  bool have_inverse_;
  double tolerance_ = kBalanceTolerance;
};

// The same with a slope of each wheel's loads in place of the inverse Jacobian: a step tells each wheel by
// itself of its slope, which is six times as much as it tells of the balance as a whole.
class WheelSlopeSearch {
 public:
  WheelSlopeSearch(RoverBalance& balance, const NewtonMemory& memory)
      : balance_(balance), slopes_(memory.slopes), tolerance_(memory.tolerance) {}

  const std::optional<RoverBalance::WheelSlopes>& slopes() const { return slopes_; }

  bool solve(Vector& x, int max_iterations) {
    Vector r = balance_.residual(x);
    bool fresh = !slopes_;
    slopes_ = slopes_ ? balance_.carried_over(*slopes_, x) : balance_.slopes(x);
    double last_size = 0.0;  // of the residual, one step ago
    for (int iteration = 0; iteration < max_iterations; ++iteration) {
      const double size = r.cwiseAbs().maxCoeff();
      if (size < tolerance_) return true;
      const Vector full = small_solve(balance_.jacobian(x, *slopes_), Vector(-r));
      if (!full.allFinite()) return false;
      const Vector step = limited_step(x, full);
      const PerWheel<RoverBalance::WheelPoint> before = balance_.points(x);
      Vector next = x + step;
      keep_in_range(next);
      if (size * size < tolerance_ * last_size) {
        // A step that brings the residual down as far as the last one did ends within the tolerance: it is
        // taken along the slopes, without the soil's forces at its end.
        balance_.move_along(*slopes_, next);
        x = next;
        return true;
      }
      last_size = size;
      Vector next_r = balance_.residual(next);
      const bool is_poor = next_r.norm() > 0.5 * r.norm();
      if (is_poor && !fresh) {  // the slopes are out of date: try again with new ones from the better point
        if (next_r.norm() < r.norm()) {
          x = next;
          r = next_r;
        } else {
          balance_.residual(x);
        }
        slopes_ = balance_.slopes(x);
        fresh = true;
        last_size = 0.0;
        continue;
      }
      if (is_poor)
        backtrack(
            x, step, r.norm(), [&](const Vector& at) { return balance_.residual(at); }, next, next_r);
      balance_.correct(before, next, *slopes_);
      fresh = false;
      x = next;
      r = next_r;
    }
    return r.cwiseAbs().maxCoeff() < tolerance_;
  }

 private:
  RoverBalance& balance_;
  std::optional<RoverBalance::WheelSlopes> slopes_;
  double tolerance_;
};

}  // namespace

void keep_in_range(Vector& x) {
  for (int k = kMotions; k < x.size(); ++k)
    x[k] = std::clamp(x[k], RoverBalance::kMinEntryAngleRad, kMaxEntryAngleRad);
}

bool newton(RoverBalance& balance, Vector& x, const Primary* held, int max_iterations, NewtonMemory* memory) {
  if (memory != nullptr && memory->by_wheel && held == nullptr) {
    WheelSlopeSearch search(balance, *memory);
    const bool solved = search.solve(x, max_iterations);
    memory->slopes = solved ? search.slopes() : std::nullopt;
    return solved;
  }
  NewtonSearch search(balance, held, memory);
  if (memory != nullptr) memory->inverse.reset();
  return search.solve(x, max_iterations);
}

std::optional<Matrix> inverse_jacobian(const RoverBalance& balance, const Vector& x) {
  const Matrix inverse = balance.jacobian(x).partialPivLu().inverse();
  return inverse.allFinite() ? std::optional(inverse) : std::nullopt;
}

}  // namespace slipway::sim
