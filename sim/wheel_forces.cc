#include "sim/wheel_forces.h"

#include <algorithm>
#include <cmath>

#include "sim/bekker_pressure.h"
#include "sim/janosi_hanamoto.h"
#include "sim/slip_ratio.h"

namespace slipway::sim {
namespace {

// Gauss-Legendre with 8 points on s in [0, 1], taken to t = s^2: nodes t and weights 2 s w.
struct ArcQuadrature {
  ArcValues node, weight;
};

ArcQuadrature make_quadrature() {
  constexpr double x[4] = {0.1834346424956498049394761, 0.5255324099163289858177390,
                           0.7966664774136267395915539, 0.9602898564975362316835609};
  constexpr double w[4] = {0.3626837833783619829651504, 0.3137066458778872873379622,
                           0.2223810344533744705443560, 0.1012285362903762591525314};
  ArcQuadrature q;
  for (int k = 0; k < 4; ++k) {
    for (const int sign : {-1, 1}) {
      const int at = sign < 0 ? 3 - k : 4 + k;
      const double s = 0.5 * (1.0 + sign * x[k]);
      q.node[at] = s * s;
      q.weight[at] = s * w[k];  // 2 s times the half of the interval's length
    }
  }
  return q;
}

const ArcQuadrature kQuadrature = make_quadrature();

// Signed shear stress against the slipping, per unit of strength.
ArcValues signed_shear(const ArcValues& displacement_m, double shear_modulus_m) {
  const ArcValues mobilised = janosi_hanamoto_mobilised(displacement_m.abs(), shear_modulus_m);
  return (displacement_m < 0.0).select(-mobilised, mobilised);
}

struct ArcSums {
  double tau_cos = 0.0, tau_sin = 0.0, tau = 0.0, tau_lateral = 0.0, sigma_cos = 0.0, sigma_sin = 0.0;
};

// One of the two arcs: angles and their cosines, the normal stress at them, and the weights times the arc's
// length.
ArcSums integrate(const ArcValues& theta, const ArcValues& cosine, const ArcValues& sigma,
                  const ArcValues& weight, const WheelGeometry& wheel, const Soil& soil, double theta_f,
                  double sin_f, const WheelMotion& motion) {
  const ArcValues sine = theta.sin();
  const ArcValues strength = weight * (soil.cohesion_pa + sigma * std::tan(soil.friction_angle_rad));
  const ArcValues to_entry = theta_f - theta;
  const ArcValues j_x = wheel.radius_m * (to_entry - motion.forward * (sin_f - sine));
  const ArcValues tau = strength * signed_shear(j_x, soil.shear_modulus_x_m);
  const ArcValues weighted = weight * sigma;
  ArcSums sums;
  sums.tau = tau.sum();
  sums.tau_cos = (tau * cosine).sum();
  sums.tau_sin = (tau * sine).sum();
  sums.sigma_cos = (weighted * cosine).sum();
  sums.sigma_sin = (weighted * sine).sum();
  if (motion.leftward != 0.0) {
    const ArcValues j_y = (wheel.radius_m * motion.leftward) * to_entry;
    sums.tau_lateral = -(strength * signed_shear(j_y, soil.shear_modulus_y_m)).sum();
  }
  return sums;
}

}  // namespace

WheelForces wheel_forces(const WheelGeometry& wheel, const Soil& soil, double entry_angle_rad,
                         const WheelMotion& motion) {
  const double theta_f = entry_angle_rad;
  const double slip = std::min(1.0, std::abs(slip_from_speed_ratio(motion.forward)));
  const double theta_m = (soil.c1 + soil.c2 * slip) * theta_f;
  const double n = soil.pressure.n + soil.n1 * slip;
  const double cos_f = std::cos(theta_f), sin_f = std::sin(theta_f);

  const double front_length = theta_f - theta_m;
  const ArcValues front = theta_f - kQuadrature.node * front_length;
  const ArcValues front_cosine = front.cos();
  const ArcValues depth = wheel.radius_m * (front_cosine - cos_f);
  // The rear arc repeats the front one's stresses at its own angles, so they are computed once.
  const ArcValues sigma = bekker_pressure_pa(soil.pressure, n, wheel.width_m, depth);
  const ArcValues rear = kQuadrature.node * theta_m;

  const ArcSums f = integrate(front, front_cosine, sigma, kQuadrature.weight * front_length, wheel, soil,
                              theta_f, sin_f, motion);
  const ArcSums b =
      integrate(rear, rear.cos(), sigma, kQuadrature.weight * theta_m, wheel, soil, theta_f, sin_f, motion);

  const double area = wheel.width_m * wheel.radius_m;
  return {.drawbar_pull_n = area * (f.tau_cos + b.tau_cos - f.sigma_sin - b.sigma_sin),
          .lateral_n = area * (f.tau_lateral + b.tau_lateral),
          .vertical_n = area * (f.sigma_cos + b.sigma_cos + f.tau_sin + b.tau_sin),
          .torque_nm = area * wheel.radius_m * (f.tau + b.tau)};
}

double sinkage_m(double radius_m, double entry_angle_rad) {
  const double half = std::sin(0.5 * entry_angle_rad);
  return 2.0 * radius_m * half * half;
}

double entry_angle_rad(double radius_m, double sinkage_m) {
  return 2.0 * std::asin(std::sqrt(std::clamp(0.5 * sinkage_m / radius_m, 0.0, 1.0)));
}

}  // namespace slipway::sim
