#include "gap/estimate/plate_sinkage.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/angle.h"
#include "core/random.h"

namespace slipway::gap {
namespace {

// Exact tests of a soil with these moduli, with relative noise.
std::vector<PlateRecord> tests_of(const sim::BekkerModuli& moduli, std::vector<double> radii, double noise) {
  std::vector<PlateRecord> tests;
  for (const double radius : radii) {
    PlateRecord test{radius, {}, {}};
    for (int i = 1; i <= 20; ++i) {
      const double z = 0.002 * i;
      test.sinkage_m.push_back(z);
      test.pressure_pa.push_back(moduli.stiffness(radius) * std::pow(z, moduli.n) *
                                 (1.0 + noise * random_normal(tests.size(), i)));
    }
    tests.push_back(test);
  }
  return tests;
}

TEST(FitModuli, EveryMeasureGivesBackTheModuliOfExactTestsAlsoWithANegativeKc) {
  const sim::BekkerModuli truth{-110000.0, 2.2e6, 1.2};
  const auto tests = tests_of(truth, {0.2, 0.3}, 0.0);
  for (const PlateMeasure measure : {PlateMeasure::kForce, PlateMeasure::kPressure,
                                     PlateMeasure::kWongWeighted, PlateMeasure::kLogPressure}) {
    NoProgress progress;
    const auto fit = fit_moduli(tests, {.measure = measure}, progress);
    ASSERT_TRUE(fit) << fit.error().detail;
    EXPECT_NEAR(fit->moduli.k_c / truth.k_c, 1.0, 1e-4);
    EXPECT_NEAR(fit->moduli.k_phi / truth.k_phi, 1.0, 1e-5);
    EXPECT_NEAR(fit->moduli.n, truth.n, 1e-6);
    EXPECT_NEAR(fit->explained_variance, 1.0, 1e-9);
  }
}

TEST(FitModuli, TheCovarianceCoversTheTruthOfNoisyTests) {
  const sim::BekkerModuli truth{20000.0, 1.2e6, 0.95};
  NoProgress progress;
  const auto fit = fit_moduli(tests_of(truth, {0.03, 0.04, 0.05}, 0.02),
                              {.measure = PlateMeasure::kLogPressure}, progress);
  ASSERT_TRUE(fit) << fit.error().detail;
  const double errors[] = {fit->moduli.k_c - truth.k_c, fit->moduli.k_phi - truth.k_phi,
                           fit->moduli.n - truth.n};
  for (int k = 0; k < 3; ++k) {
    const double std = std::sqrt(fit->covariance(k, k));
    EXPECT_GT(std, 0.0) << k;
    EXPECT_LT(std::abs(errors[k]), 3.0 * std) << k;
  }
  EXPECT_LT(std::sqrt(fit->covariance(2, 2)), 0.01);
}

TEST(FitModuli, PlatesOfOneSizeDoNotTellKcFromKphi) {
  NoProgress progress;
  const auto tests = tests_of({20000.0, 1.2e6, 0.95}, {0.04, 0.04}, 0.01);
  const auto both = fit_moduli(tests, {}, progress);
  ASSERT_TRUE(both) << both.error().detail;
  ASSERT_EQ(both->undetermined.size(), 1U);
  EXPECT_NE(both->undetermined[0].words.find("k_c"), std::string::npos);
  EXPECT_NE(both->undetermined[0].words.find("k_phi"), std::string::npos);
  const auto one = fit_moduli(tests, {.cohesive_modulus = false}, progress);
  ASSERT_TRUE(one) << one.error().detail;
  EXPECT_TRUE(one->undetermined.empty());
  EXPECT_EQ(one->moduli.k_c, 0.0);
  EXPECT_NEAR(one->moduli.k_phi / (20000.0 / 0.04 + 1.2e6), 1.0, 0.05);
}

TEST(FitModuli, TooFewSamplesAreRefused) {
  NoProgress progress;
  const std::vector<PlateRecord> tests{{0.1, {0.0, 0.01, 0.02}, {0.0, 1e3, 2e3}}};
  const auto fit = fit_moduli(tests, {}, progress);
  ASSERT_FALSE(fit);
  EXPECT_EQ(fit.error().code, ErrorCode::kNoData);
}

TEST(FitShearStrength, GivesBackMohrCoulombOfExactTests) {
  AnnulusRecord test{0.15, 0.2, {}, {}};
  for (int i = 1; i <= 6; ++i) {
    const double load = 250.0 * i;
    const double tau = 2000.0 + test.mean_stress_pa(load) * std::tan(rad_from_deg(30.0));
    test.load_n.push_back(load);
    test.peak_torque_nm.push_back(tau * 2.0 / 3.0 * std::numbers::pi * (0.008 - 0.003375));
    EXPECT_NEAR(test.shear_stress_pa(test.peak_torque_nm.back()), tau, 1e-9 * tau);
  }
  NoProgress progress;
  const auto fit = fit_shear_strength(test, progress);
  ASSERT_TRUE(fit) << fit.error().detail;
  EXPECT_NEAR(fit->cohesion_pa, 2000.0, 0.01);
  EXPECT_NEAR(deg_from_rad(fit->friction_angle_rad), 30.0, 1e-5);
  EXPECT_NEAR(fit->rms_pa, 0.0, 0.01);
}

}  // namespace
}  // namespace slipway::gap
