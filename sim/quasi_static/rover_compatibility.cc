// The statically undetermined part of RoverBalance: which wheels carry load, and the compatibility of depths
// and gaps.
#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "sim/quasi_static/rover_balance.h"
#include "sim/wheel/entry_angle.h"

namespace slipway::sim {
namespace {

// The minimum of z_ref as a share of the radius, since wheels hardly sink into hard soil.
constexpr double kMinSinkageRatio = 0.01;

}  // namespace

void RoverBalance::set_sinkage_scale() {
  const int n = wheel_count();
  double sinkage = 0.0, radius = 0.0;
  for (int k = 0; k < n; ++k) {
    sinkage += bekker_sinkage_m(place(k).geometry, soils_[k], geometry_.weight_n / n) / n;
    radius += place(k).geometry.radius_m / n;
  }
  sinkage_scale_m_ = std::max(kMinSinkageRatio * radius, std::min(radius, sinkage));
}

void RoverBalance::set_compatibility() {
  const int spare = in_contact_ - (3 + geometry_.joints);
  compatibility_of_gap_.resize(spare);
  compatibility_of_depth_.setZero(spare, wheel_count());
  compatibility_.setZero(spare, wheel_count());
  if (spare == 0) return;
  GapGradient a(in_contact_, 3 + geometry_.joints);
  Loads gap(in_contact_);
  PerWheel<int> wheel(in_contact_);
  for (int k = 0, row = 0; k < wheel_count(); ++k) {
    if (in_air_[k]) continue;
    a.row(row) = geometry_.gap_gradient.row(k);
    gap[row] = geometry_.gap_m[k];
    wheel[row++] = k;
  }
  // The last columns of Q in A = Q R span the null space of A^T.
  using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxWheels, kMaxWheels>;
  const Square q = a.householderQr().householderQ() * Square::Identity(in_contact_, in_contact_);
  const Square z = q.rightCols(spare).transpose() / sinkage_scale_m_;
  compatibility_of_gap_ = z * gap;
  for (int row = 0; row < in_contact_; ++row) compatibility_of_depth_.col(wheel[row]) = z.col(row);
  set_compatibility_of_sinkages();
}

// Depths are linear in the wheels' own sinkages: column k has the depths that a unit sinkage of wheel k
// causes, its own and those of the wheels that follow in its rut.
void RoverBalance::set_compatibility_of_sinkages() {
  for (int k = 0; k < wheel_count(); ++k) {
    if (in_air_[k]) continue;
    PerWheel<double> unit(wheel_count());
    unit[k] = 1.0;
    const PerWheel<double> depth = sim::total_sinkages_m(tracks_, rut_shares_, unit);
    compatibility_.col(k).setZero();
    for (int m = 0; m < wheel_count(); ++m)
      compatibility_.col(k) += compatibility_of_depth_.col(m) * depth[m];
  }
}

void RoverBalance::set_in_air(int k, bool in_air) {
  if (in_air_[k] == in_air) return;
  in_air_[k] = in_air;
  at_.resize(0);
  in_contact_ += in_air ? -1 : 1;
  set_compatibility();
}

// Solves A_S^T A_S q = A_S^T height_S + push over the wheels S in contact.
RoverBalance::Freedoms RoverBalance::body_motion(const Loads& height_m, const Freedoms& push) const {
  using Normal = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxFreedoms, kMaxFreedoms>;
  Normal normal = Normal::Zero(push.size(), push.size());
  Freedoms right = push;
  for (int k = 0; k < wheel_count(); ++k) {
    if (in_air_[k]) continue;
    normal += geometry_.gap_gradient.row(k).transpose() * geometry_.gap_gradient.row(k);
    right += geometry_.gap_gradient.row(k).transpose() * height_m[k];
  }
  return normal.ldlt().solve(right);
}

// A spring's load is -stiffness (gap + A q), and A^T load + gravity = 0.
RoverBalance::Loads RoverBalance::resting_loads_n() {
  const int n = wheel_count();
  const double stiffness = 1.0 / (n * sinkage_scale_m_);  // per unit of weight
  Freedoms pull(3 + geometry_.joints);
  pull.head<3>() = geometry_.gravity.segment<3>(2);
  pull.tail(geometry_.joints) = geometry_.gravity.segment(6, geometry_.joints);
  Loads load = Loads::Zero(n);
  for (int round = 0; round < 2 * n; ++round) {
    const Freedoms q = body_motion(-geometry_.gap_m, pull / stiffness);
    int lightest = -1, deepest = -1;
    for (int k = 0; k < n; ++k) {
      load[k] = -stiffness * (geometry_.gap_m[k] + geometry_.gap_gradient.row(k).dot(q));
      if (!in_air_[k] && load[k] < 0.0 && (lightest < 0 || load[k] < load[lightest])) lightest = k;
      if (in_air_[k] && load[k] > 0.0 && (deepest < 0 || load[k] > load[deepest])) deepest = k;
    }
    if (lightest >= 0 && can_spare_a_wheel()) {
      set_in_air(lightest, true);
    } else if (deepest >= 0) {
      set_in_air(deepest, false);
    } else {
      break;
    }
  }
  for (int k = 0; k < n; ++k)
    if (in_air_[k]) load[k] = 0.0;
  return load * geometry_.weight_n;
}

PerWheel<double> RoverBalance::total_sinkages_m(const Vector& unknowns) const {
  return total_sinkages_m(unknowns, tracks_);
}

PerWheel<double> RoverBalance::total_sinkages_m(const Vector& unknowns, const TrackShares& tracks) const {
  PerWheel<double> own(wheel_count());
  for (int k = 0; k < wheel_count(); ++k)
    own[k] = in_air_[k] ? 0.0 : sinkage_m(place(k).geometry.radius_m, unknowns[kMotions + k]);
  return sim::total_sinkages_m(tracks, rut_shares_, own);
}

// Where every load is determined the suspension closed the stance's gaps, as far as the ground's kinks let
// it.
RoverBalance::Lean RoverBalance::lean(const Vector& unknowns) const {
  const PerWheel<double> depth = total_sinkages_m(unknowns);
  Loads height(wheel_count());
  for (int k = 0; k < wheel_count(); ++k)
    height[k] = -depth[k] - (geometry_.undetermined > 0 ? geometry_.gap_m[k] : -place(k).highest_m);
  if (all_in_contact()) {
    const Eigen::Vector2d turned = geometry_.lean_by_height * height;
    return {turned[0], turned[1]};
  }
  const Freedoms q = body_motion(height, Freedoms::Zero(3 + geometry_.joints));
  return {q[1] / geometry_.half_wheelbase_m, q[2] / geometry_.half_wheelbase_m};
}

double RoverBalance::height_in_air_m(int wheel, const Vector& unknowns) const {
  const PerWheel<double> depth = total_sinkages_m(unknowns);
  Loads height(wheel_count());
  for (int k = 0; k < wheel_count(); ++k) height[k] = -(geometry_.gap_m[k] + depth[k]);
  const Freedoms q = body_motion(height, Freedoms::Zero(3 + geometry_.joints));
  return geometry_.gap_gradient.row(wheel).dot(q) - height[wheel];
}

}  // namespace slipway::sim
