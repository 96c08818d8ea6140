#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace slipway::sim {

// Bekker's moduli of sinkage. k_c and k_phi have units that depend on n, so they never travel alone.
// Pressure under a plate of width b at depth z: p = (k_c / b + k_phi) z^n  [Bekker 1956; ARTEMIS eq. 1].
struct BekkerModuli {
  double k_c = 0.0;    // N/m^(n+1); a fit may make it negative
  double k_phi = 0.0;  // N/m^(n+2)
  double n = 1.0;

  double stiffness(double width_m) const { return k_c / width_m + k_phi; }  // N/m^(n+2)
};

// What the constitutive laws need of a soil.
struct Soil {
  BekkerModuli pressure;
  double cohesion_pa = 0.0;
  double friction_angle_rad = 0.0;
  double shear_modulus_x_m = 0.01;  // Janosi-Hanamoto's K along the rolling direction
  double shear_modulus_y_m = 0.01;  // and across it
  double density_kg_m3 = 1500.0;
  // Angle of greatest normal stress: theta_m = (c1 + c2 |i|) theta_f [Wong & Reece 1967; ARTEMIS eq. 2].
  double c1 = 0.4;
  double c2 = 0.2;
  double n1 = 0.0;  // slip sinkage, n = n0 + n1 |i| [ARTEMIS eq. 22]; 0 unless the effect is on
};

// One standard deviation of what is uncertain, in the same units as the mean. Stiffness and shear modulus are
// ratios to the mean: both Bekker moduli scale together.
struct SoilStd {
  double stiffness_ratio = 0.0;
  double n = 0.0;
  double cohesion_pa = 0.0;
  double friction_angle_rad = 0.0;
  double shear_modulus_ratio = 0.0;
};

constexpr int kSoilDims = 5;  // stiffness, n, cohesion, tan(friction angle), shear modulus
using SoilNormals = Eigen::Matrix<double, kSoilDims, 1>;
using SoilCorrelation = Eigen::Matrix<double, kSoilDims, kSoilDims>;

// What is believed of a soil: a mean, its spread and how far along the ground one draw holds. The five
// uncertain quantities are log-normal with these means and standard deviations (so every draw is a soil), and
// their logarithms have the given correlation.
struct SoilDistribution {
  std::string name;                  // "mpf_drift"
  std::string summary;               // one line for people
  std::string source;                // "Zhurong paper, Table 3 [45]"
  std::vector<std::string> assumed;  // names of parameters that the source does not give
  Soil mean;
  SoilStd std;
  SoilCorrelation correlation = SoilCorrelation::Identity();
  double correlation_length_m = 5.0;
};

// Turns standard normal numbers into one soil of the distribution. `normals` are independent; the correlation
// is applied here. A zero standard deviation leaves the mean exactly.
Soil draw_soil(const SoilDistribution& distribution, const SoilNormals& normals);

}  // namespace slipway::sim
