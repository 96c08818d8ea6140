#include "sim/soil/soil.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.h"
#include "tests/sim/reference_models.h"

namespace slipway::sim {
namespace {

SoilNormals normals(std::uint64_t draw) {
  SoilNormals z;
  for (int k = 0; k < kSoilDims; ++k) z[k] = random_normal(11, draw * kSoilDims + k);
  return z;
}

TEST(SoilDraw, WithoutSpreadEveryDrawIsTheMeanExactly) {
  const SoilDistribution belief = certain("loam", sandy_loam());
  const Soil drawn = draw_soil(belief, normals(3));
  EXPECT_EQ(drawn.pressure.k_phi, belief.mean.pressure.k_phi);
  EXPECT_EQ(drawn.friction_angle_rad, belief.mean.friction_angle_rad);
  EXPECT_EQ(drawn.cohesion_pa, belief.mean.cohesion_pa);
}

TEST(SoilDraw, ManyDrawsHaveTheStatedMeansAndSpreads) {
  SoilDistribution belief = certain("drift", sandy_loam());
  belief.std = {0.3, 0.1, 900.0, rad_from_deg(3.0), 0.25};
  const int n = 100'000;
  double stiffness = 0, stiffness2 = 0, cohesion = 0, cohesion2 = 0, phi = 0, phi2 = 0;
  for (int d = 0; d < n; ++d) {
    const Soil soil = draw_soil(belief, normals(d));
    const double ratio = soil.pressure.k_phi / belief.mean.pressure.k_phi;
    EXPECT_NEAR(soil.pressure.k_c / belief.mean.pressure.k_c, ratio, 1e-12);
    stiffness += ratio;
    stiffness2 += ratio * ratio;
    cohesion += soil.cohesion_pa;
    cohesion2 += soil.cohesion_pa * soil.cohesion_pa;
    phi += soil.friction_angle_rad;
    phi2 += soil.friction_angle_rad * soil.friction_angle_rad;
  }
  const auto std = [n](double sum, double squares) { return std::sqrt(squares / n - sum / n * sum / n); };
  EXPECT_NEAR(stiffness / n, 1.0, 0.01);
  EXPECT_NEAR(std(stiffness, stiffness2), 0.3, 0.01);
  EXPECT_NEAR(cohesion / n, 1500.0, 15.0);
  EXPECT_NEAR(std(cohesion, cohesion2), 900.0, 30.0);
  EXPECT_NEAR(phi / n, rad_from_deg(36.0), rad_from_deg(0.3));
  EXPECT_NEAR(std(phi, phi2), rad_from_deg(3.0), rad_from_deg(0.2));
}

TEST(SoilDraw, ClosuresAreDrawnOnTheirOwnWithTheStatedMeansAndSpreads) {
  SoilDistribution belief = certain("drift", sandy_loam());
  belief.std = {0.3, 0.1, 500.0, rad_from_deg(3.0), 0.25};
  const Soil without = draw_soil(belief, normals(5), {1.0, -1.0});
  EXPECT_EQ(without.c1, belief.mean.c1);
  EXPECT_EQ(without.c2, belief.mean.c2);
  belief.std.c1 = 0.1;
  belief.std.c2 = 0.05;
  EXPECT_EQ(draw_soil(belief, normals(5), {1.0, -1.0}).cohesion_pa, without.cohesion_pa);
  const int n = 50'000;
  double c1 = 0, c1_squares = 0, c2 = 0, c2_squares = 0;
  for (int d = 0; d < n; ++d) {
    const auto key = static_cast<std::uint64_t>(d);
    const Soil soil =
        draw_soil(belief, SoilNormals::Zero(), {random_normal(5, 2 * key), random_normal(5, 2 * key + 1)});
    c1 += soil.c1 / n;
    c1_squares += soil.c1 * soil.c1 / n;
    c2 += soil.c2 / n;
    c2_squares += soil.c2 * soil.c2 / n;
  }
  EXPECT_NEAR(c1, belief.mean.c1, 0.002);
  EXPECT_NEAR(std::sqrt(c1_squares - c1 * c1), 0.1, 0.003);
  EXPECT_NEAR(c2, belief.mean.c2, 0.001);
  EXPECT_NEAR(std::sqrt(c2_squares - c2 * c2), 0.05, 0.002);
}

TEST(SoilDraw, ClosuresAreDrawnAsAPair) {
  SoilDistribution belief = certain("drift", sandy_loam());
  belief.std.c1 = 0.1;
  belief.std.c2 = 0.1;
  belief.closure_correlation = -0.7;
  const int n = 50'000;
  double a = 0, b = 0, aa = 0, bb = 0, ab = 0;
  for (int d = 0; d < n; ++d) {
    const auto key = static_cast<std::uint64_t>(d);
    const Soil soil =
        draw_soil(belief, SoilNormals::Zero(), {random_normal(6, 2 * key), random_normal(6, 2 * key + 1)});
    const double x = std::log(soil.c1), y = std::log(soil.c2);
    a += x / n;
    b += y / n;
    aa += x * x / n;
    bb += y * y / n;
    ab += x * y / n;
  }
  EXPECT_NEAR((ab - a * b) / std::sqrt((aa - a * a) * (bb - b * b)), -0.7, 0.01);
}

TEST(SoilDraw, EveryDrawIsASoilHoweverWideTheBelief) {
  SoilDistribution belief = certain("anything", loose_sand());
  belief.std = {3.0, 0.8, 5000.0, rad_from_deg(30.0), 3.0};
  for (int d = 0; d < 20'000; ++d) {
    const Soil soil = draw_soil(belief, normals(d));
    ASSERT_GT(soil.pressure.stiffness(0.16), 0.0);
    ASSERT_GT(soil.pressure.n, 0.0);
    ASSERT_GT(soil.cohesion_pa, 0.0);
    ASSERT_GT(soil.friction_angle_rad, 0.0);
    ASSERT_LT(soil.friction_angle_rad, 1.5708);
    ASSERT_GT(soil.shear_modulus_x_m, 0.0);
  }
}

TEST(SoilDraw, TheCorrelationOfTheLogarithmsIsTheStatedOne) {
  SoilDistribution belief = certain("drift", sandy_loam());
  belief.std = {0.3, 0.1, 500.0, rad_from_deg(3.0), 0.25};
  belief.correlation(0, 2) = belief.correlation(2, 0) = -0.6;
  const int n = 100'000;
  double a = 0, b = 0, aa = 0, bb = 0, ab = 0;
  for (int d = 0; d < n; ++d) {
    const Soil soil = draw_soil(belief, normals(d));
    const double x = std::log(soil.pressure.k_phi), y = std::log(soil.cohesion_pa);
    a += x;
    b += y;
    aa += x * x;
    bb += y * y;
    ab += x * y;
  }
  const double correlation =
      (ab / n - a / n * b / n) / std::sqrt((aa / n - a / n * a / n) * (bb / n - b / n * b / n));
  EXPECT_NEAR(correlation, -0.6, 0.01);
}

}  // namespace
}  // namespace slipway::sim
