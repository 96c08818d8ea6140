#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/progress.h"
#include "core/result.h"
#include "gap/estimate/least_squares.h"
#include "sim/soil/soil.h"

namespace slipway::gap {

// A round plate pressed into level soil.
struct PlateRecord {
  double radius_m = 0.1;            // Bekker's b of a round plate
  std::vector<double> sinkage_m;    // > 0, one per pressure
  std::vector<double> pressure_pa;  // force over the plate's area
};

// What is made small over all samples of all plates:
enum class PlateMeasure {
  kForce,         // error of the plate's force, N: what the instrument measures
  kPressure,      // error of pressure, Pa: all plates count alike
  kWongWeighted,  // p (ln p - ln k z^n), Pa: Wong's weighted logarithms [Wong 1980]
  kLogPressure,   // error of ln p: every decade of depth counts alike; samples with p > 0 only
};

struct ModuliOptions {
  PlateMeasure measure = PlateMeasure::kForce;
  bool cohesive_modulus = true;  // false: k_c = 0, one modulus for plates of every size
};

struct ModuliFit {
  sim::BekkerModuli moduli;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // of k_c, k_phi, n; 0 for a k_c that was not fitted
  std::vector<UndeterminedDirection> undetermined;       // k_c against k_phi where all plates have one size
  double rms_pa = 0.0;                                   // of p - k z^n over the samples
  double explained_variance = 0.0;                       // 1 - sum (p - k z^n)^2 / sum (p - mean p)^2
  bool converged = false;
};

// Bekker's moduli from plate tests, p = (k_c / b + k_phi) z^n [Bekker 1956; Wong 2010]. k_c may
// come out negative. Errors: no_data with fewer usable samples than unknowns; those of fit_least_squares.
Result<ModuliFit> fit_moduli(std::span<const PlateRecord> tests, const ModuliOptions& options,
                             Progress& progress);

// An annulus turned on level soil under loads, to its peak torque at each.
struct AnnulusRecord {
  double inner_radius_m = 0.0, outer_radius_m = 0.0;
  std::vector<double> load_n;
  std::vector<double> peak_torque_nm;  // one per load

  double mean_stress_pa(double load) const;     // sigma = W / (pi (r_o^2 - r_i^2))
  double shear_stress_pa(double torque) const;  // tau = T / (2 pi / 3 (r_o^3 - r_i^3)), even over the ring
};

struct ShearStrengthFit {
  double cohesion_pa = 0.0;
  double friction_angle_rad = 0.0;
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  // of cohesion, Pa, and friction angle, rad
  double rms_pa = 0.0;
};

// Mohr-Coulomb's tau = c + sigma tan phi through the peaks, every peak's torque counting alike [Wong 2010].
// Cohesion is not kept from being negative. Errors: no_data with fewer than three loads; those of
// fit_least_squares.
Result<ShearStrengthFit> fit_shear_strength(const AnnulusRecord& test, Progress& progress);

}  // namespace slipway::gap
