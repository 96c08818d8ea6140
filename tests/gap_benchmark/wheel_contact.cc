#include "wheel_contact.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace slipway::gap_benchmark {
namespace {

constexpr int kPanels = 12;           // of Simpson's rule on either branch; even
constexpr double kMinRim_m_s = 1e-4;  // a locked wheel's shear displacement stays finite

double smooth_sign(double x, double width) {
  return std::tanh(x / width);
}

// Rankine's passive coefficient.
double passive(double tan_phi) {
  const double root = tan_phi + std::sqrt(1.0 + tan_phi * tan_phi);
  return root * root;
}

class Arc {
 public:
  Arc(double radius_m, double depth_m, double slip, const ContactSoil& soil, const Closure& closure,
      const HiddenTruth& hidden)
      : r_(radius_m), soil_(soil), hidden_(hidden), parabolic_(closure.parabolic_stress) {
    const double depth = std::clamp(depth_m * (1.0 + closure.rise_share), 1e-7, 0.98 * r_);
    theta_1_ = std::acos(1.0 - depth / r_);
    theta_2_ = -closure.exit_share * theta_1_;
    theta_m_ = std::clamp(soil.c1 + soil.c2 * std::abs(slip), 0.02, 0.9) * theta_1_;
    exponent_ = soil.n;
    factor_ = soil.stiffness;
    if (hidden.slip_sinkage > 0.0) {
      if (hidden.other_equations) {
        // Lyasko: a slipping wheel sinks z (1 + a s) / (1 - a s / 2)^(1/n) instead of z.
        const double a = hidden.slip_sinkage / 0.3, s = std::min(std::abs(slip), 0.95);
        factor_ *= std::max(1.0 - 0.5 * a * s, 0.1) / std::pow(1.0 + a * s, exponent_);
      } else {
        exponent_ += hidden.slip_sinkage * std::abs(slip);
      }
    }
  }

  double entry() const { return theta_1_; }
  double exit() const { return theta_2_; }
  double angle_of_max_stress() const { return theta_m_; }

  double pressure(double theta) const {
    if (parabolic_) {
      const double end = theta >= theta_m_ ? theta_1_ : theta_2_;
      const double x = (theta - theta_m_) / (end - theta_m_);
      return bekker(theta_m_) * (1.0 - x * x);
    }
    if (theta >= theta_m_) return bekker(theta);
    return bekker(theta_1_ - (theta - theta_2_) / (theta_m_ - theta_2_) * (theta_1_ - theta_m_));
  }

 private:
  double bekker(double theta) const {
    const double z = std::max(r_ * (std::cos(theta) - std::cos(theta_1_)), 0.0);
    return factor_ * std::pow(z, exponent_) + crust(z) + hardpan(z);
  }
  double crust(double z) const {
    const double x = z / hidden_.crust_depth_m;
    if (hidden_.crust_pa == 0.0) return 0.0;
    // A peak and a tail, or a ramp that drops to nothing.
    return hidden_.other_equations ? hidden_.crust_pa * x * std::exp(1.0 - x)
                                   : hidden_.crust_pa * std::max(0.0, std::min(x, 2.0 - x));
  }
  double hardpan(double z) const {
    const double into = z - hidden_.hardpan_depth_m;
    if (hidden_.hardpan_pa_m == 0.0 || into <= 0.0) return 0.0;
    return hidden_.hardpan_pa_m * into *
           (hidden_.other_equations ? 0.5 + into / hidden_.hardpan_depth_m : 1.0);
  }

  double r_;
  const ContactSoil& soil_;
  const HiddenTruth& hidden_;
  bool parabolic_;
  double theta_1_ = 0.0, theta_2_ = 0.0, theta_m_ = 0.0, exponent_ = 1.0, factor_ = 0.0;
};

WheelLoads wheel_loads(double radius_m, double width_m, double depth_m, const WheelMotion& motion,
                       const ContactSoil& soil, const Closure& closure, const HiddenTruth& hidden) {
  // A wheel that turns backward is the mirror of one that turns forward.
  const double sense = motion.rate_rad_s != 0.0 ? (motion.rate_rad_s > 0.0 ? 1.0 : -1.0)
                                                : (motion.forward_m_s >= 0.0 ? 1.0 : -1.0);
  const double ahead = sense * motion.forward_m_s;
  const double rim = std::max(radius_m * std::abs(motion.rate_rad_s), kMinRim_m_s);
  const double travel = ahead / rim;  // 1 - slip while driving
  const double slip = travel <= 1.0 ? std::min(1.0 - travel, 1.0) : 1.0 / travel - 1.0;
  const double sideways = motion.left_m_s / rim;

  const double depth = std::max(depth_m, 0.0);
  const Arc arc(radius_m, depth, slip, soil, closure, hidden);
  const double theta_1 = arc.entry(), sine_1 = std::sin(theta_1);
  const bool lugs = hidden.grouser_height_m > 0.0;
  const double lug = hidden.grouser_height_m;
  // Cleats shear the soil a little outside the rim.
  const double shear_radius = radius_m + (lugs && hidden.other_equations ? 0.15 * lug : 0.0);

  double normal = 0.0, pull = 0.0, side = 0.0, torque = 0.0;
  const auto add = [&](double theta, double weight) {
    const double sigma = arc.pressure(theta);
    const double strength = soil.cohesion_pa + sigma * soil.tan_phi;
    const double swept = theta_1 - theta;
    const double j_x = shear_radius * swept - radius_m * travel * (sine_1 - std::sin(theta));
    const double j_y = radius_m * sideways * swept, as_along = j_y / closure.lateral_modulus;
    double tau_x, tau_y;
    if (closure.coupled_shear) {
      const double j = std::sqrt(j_x * j_x + as_along * as_along) + 1e-15;
      const double tau = strength * (1.0 - std::exp(-j / soil.shear_modulus_m));
      tau_x = tau * j_x / j;
      tau_y = tau * as_along / j;
    } else {
      tau_x = std::copysign(strength * (1.0 - std::exp(-std::abs(j_x) / soil.shear_modulus_m)), j_x);
      tau_y = std::copysign(strength * (1.0 - std::exp(-std::abs(as_along) / soil.shear_modulus_m)), j_y);
    }
    const double cosine = std::cos(theta), sine = std::sin(theta);
    normal += weight * (sigma * cosine + tau_x * sine);
    pull += weight * (tau_x * cosine - sigma * sine);
    torque += weight * tau_x * shear_radius;
    side -= weight * tau_y;
    if (lugs) {
      // Passive pressure on the cleats in the ground, smeared over the arc, as far as the soil is sheared.
      const double kp = passive(soil.tan_phi);
      const double deep =
          hidden.other_equations
              ? lug * (2.0 * soil.cohesion_pa * std::sqrt(kp) +
                       kp * (0.5 * soil.weight_n_m3 * lug + 0.15 * sigma))
              : lug * (2.0 * soil.cohesion_pa * std::sqrt(kp) + 0.5 * kp * soil.weight_n_m3 * lug);
      const double mobilised =
          hidden.other_equations ? std::tanh(j_x / soil.shear_modulus_m)
                                 : std::copysign(1.0 - std::exp(-std::abs(j_x) / soil.shear_modulus_m), j_x);
      const double line = deep * mobilised * hidden.grouser_count / (2.0 * std::numbers::pi) / radius_m;
      pull += weight * line * cosine;
      normal += weight * line * sine;
      torque += weight * line * (radius_m + 0.5 * lug);
    }
  };
  const auto simpson = [&](double from, double to) {
    const double step = (to - from) / kPanels;
    for (int i = 0; i <= kPanels; ++i) {
      const double share = i == 0 || i == kPanels ? 1.0 : (i % 2 == 1 ? 4.0 : 2.0);
      add(from + i * step, radius_m * width_m * share * step / 3.0);
    }
  };
  simpson(arc.exit(), arc.angle_of_max_stress());
  simpson(arc.angle_of_max_stress(), theta_1);

  const double kp = passive(soil.tan_phi);
  if (hidden.bulldozing > 0.0) {
    // Passive pressure before the rim; the other equation has Hegedus' smaller share of cohesion and a heap
    // that grows with slip.
    const double heap = hidden.other_equations ? depth * (1.0 + 0.8 * std::max(slip, 0.0)) : depth;
    const double cohesion = (hidden.other_equations ? 0.67 : 1.0) * 2.0 * soil.cohesion_pa * std::sqrt(kp);
    const double force = hidden.bulldozing * width_m * heap * (cohesion + 0.5 * kp * soil.weight_n_m3 * heap);
    pull -= force * smooth_sign(ahead, 1e-3);
  }
  if (hidden.side_bulldozing > 0.0) {
    // Passive pressure on the sunk segment of the side wall, mobilised with the slip angle.
    const double chord = 2.0 * std::sqrt(std::max(depth * (2.0 * radius_m - depth), 0.0));
    const double area = 2.0 / 3.0 * chord * depth;
    const double mean_depth = 0.4 * depth;
    const double bearing = hidden.other_equations
                               ? 2.0 * soil.cohesion_pa * std::sqrt(kp) + kp * soil.weight_n_m3 * mean_depth
                               : 3.0 * soil.cohesion_pa * kp + 2.0 * kp * soil.weight_n_m3 * mean_depth;
    const double angle = std::atan2(motion.left_m_s, std::max(std::abs(motion.forward_m_s), 1e-4));
    side -=
        hidden.side_bulldozing * area * bearing * smooth_sign(angle, hidden.other_equations ? 0.12 : 0.05);
  }
  return {.normal_n = normal, .pull_n = sense * pull, .side_n = side, .torque_nm = sense * torque};
}

}  // namespace

WheelLoads ArcLaw::loads(double depth_m, const WheelMotion& motion, const ContactSoil& soil) const {
  return wheel_loads(radius_m_, width_m_, depth_m, motion, soil, closure_, hidden_);
}

double highest_level(const std::vector<SoilNode>& across) {
  double highest = across.empty() ? 0.0 : across.front().level_m();
  for (const SoilNode& node : across) highest = std::max(highest, node.level_m());
  return highest;
}

}  // namespace slipway::gap_benchmark
