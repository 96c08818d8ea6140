#include "sim/quasi_static/newton_search.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

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

  std::optional<Matrix> inverse() const { return have_inverse_ ? std::optional(inverse_) : std::nullopt; }

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
        backtrack(x, step, r.norm(), next, next_r);
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
    const Vector row = inverse_.transpose() * moved;
    inverse_.noalias() += ((moved - by) / denominator) * row.transpose();
  }

  RoverBalance& balance_;
  const Primary* held_;
  Matrix inverse_;
  bool have_inverse_;
  double tolerance_ = kBalanceTolerance;
};

}  // namespace

void keep_in_range(Vector& x) {
  for (int k = kMotions; k < x.size(); ++k)
    x[k] = std::clamp(x[k], RoverBalance::kMinEntryAngleRad, kMaxEntryAngleRad);
}

bool newton(RoverBalance& balance, Vector& x, const Primary* held, int max_iterations, NewtonMemory* memory) {
  NewtonSearch search(balance, held, memory);
  const bool solved = search.solve(x, max_iterations);
  if (memory != nullptr) memory->inverse = memory->keep && solved ? search.inverse() : std::nullopt;
  return solved;
}

std::optional<Matrix> inverse_jacobian(const RoverBalance& balance, const Vector& x) {
  const Matrix inverse = balance.jacobian(x).partialPivLu().inverse();
  return inverse.allFinite() ? std::optional(inverse) : std::nullopt;
}

}  // namespace slipway::sim
