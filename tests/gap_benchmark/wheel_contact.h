#pragma once

#include <vector>

#include "hidden_truth.h"

namespace slipway::gap_benchmark {

// The history of a strip of soil along the track. Heights are above the undisturbed surface.
struct SoilNode {
  double origin_m = 0.0;   // height of its surface before it was pressed; heaps raise it
  double plastic_m = 0.0;  // permanent sinkage since then
  double yield_pa = 0.0;   // maximum pressure that it has carried

  double level_m() const { return origin_m - plastic_m; }
  bool operator==(const SoilNode&) const = default;
};
double highest_level(const std::vector<SoilNode>& across);

// The rut that a wheel leaves behind.
struct Rut {
  std::vector<SoilNode>
      across;  // from right to left in the direction of travel; empty means undisturbed soil
  double berm_height_m = 0.0, berm_width_m = 0.0;  // on either side
};

// The soil under one wheel at one instant, with all changes by place, pass and time.
struct ContactSoil {
  double stiffness = 0.0;  // k_c / b + k_phi, N/m^(n+2), with b the wheel's width
  double n = 1.0, cohesion_pa = 0.0, tan_phi = 0.0, shear_modulus_m = 0.01, weight_n_m3 = 0.0;
  double c1 = 0.18, c2 = 0.32;
  double modulus_ratio_m = 0.0;  // k_c / k_phi
  std::vector<SoilNode> met;     // across the wheel, as in Rut; empty: undisturbed
};

// The motion of a wheel: forward and left over the ground in its own axes, and the rotation of the rim.
struct WheelMotion {
  double forward_m_s = 0.0, left_m_s = 0.0, rate_rad_s = 0.0;
};

struct WheelLoads {
  double normal_n = 0.0, pull_n = 0.0, side_n = 0.0;  // on the wheel; pull forward, side to the left
  double torque_nm = 0.0;                             // of the motor, positive turning forward
};

// A wheel law: the forces of the soil on a wheel, and the rut that the wheel leaves.
class WheelLaw {
 public:
  virtual ~WheelLaw() = default;
  // The forces on a wheel at a sinkage.
  virtual WheelLoads loads(double depth_m, const WheelMotion& motion, const ContactSoil& soil) const = 0;
  // The rut that the wheel leaves; empty for laws that keep no record of the soil.
  virtual Rut rut(double /*depth_m*/, const ContactSoil& /*soil*/) const { return {}; }
};

// A law with stresses as functions of the angle on the rim: Bekker's pressure with Wong and Reece's angle of
// maximum stress, Mohr-Coulomb strength, and Janosi and Hanamoto's mobilisation, integrated by Simpson's rule
// over the arc.
class ArcLaw : public WheelLaw {
 public:
  ArcLaw(double radius_m, double width_m, const Closure& closure, const HiddenTruth& hidden)
      : radius_m_(radius_m), width_m_(width_m), closure_(closure), hidden_(hidden) {}
  WheelLoads loads(double depth_m, const WheelMotion& motion, const ContactSoil& soil) const override;

 private:
  double radius_m_, width_m_;
  const Closure& closure_;
  const HiddenTruth& hidden_;
};

}  // namespace slipway::gap_benchmark
