#include "sim/wheel_forces.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/entry_angle.h"
#include "sim/slip_ratio.h"
#include "sim/soil_law_catalogue.h"
#include "sim/zhurong_literal.h"
#include "tests/sim/reference_models.h"

namespace slipway::sim {
namespace {

constexpr WheelGeometry kWheel{0.125, 0.16};

// The same equations again, one angle at a time and with slip instead of speed ratio, summed by the midpoint
// rule.
WheelForces by_midpoints(const WheelGeometry& w, const Soil& s, double theta_f, double slip,
                         double tan_beta) {
  const int n = 400'000;
  const double theta_m = (s.c1 + s.c2 * std::abs(slip)) * theta_f;
  const double k = s.pressure.k_c / w.width_m + s.pressure.k_phi;
  WheelForces f;
  for (int i = 0; i < n; ++i) {
    const double theta = (i + 0.5) * theta_f / n;
    const double equivalent = theta > theta_m ? theta : theta_f - theta / theta_m * (theta_f - theta_m);
    const double z = w.radius_m * (std::cos(equivalent) - std::cos(theta_f));
    const double sigma = k * std::pow(z, s.pressure.n + s.n1 * std::abs(slip));
    const double strength = s.cohesion_pa + sigma * std::tan(s.friction_angle_rad);
    const double travel = std::sin(theta_f) - std::sin(theta);
    const double j_x = slip >= 0.0 ? w.radius_m * (theta_f - theta - (1.0 - slip) * travel)
                                   : w.radius_m * (theta_f - theta - travel / (1.0 + slip));
    const double j_y = slip >= 0.0 ? w.radius_m * (1.0 - slip) * (theta_f - theta) * tan_beta
                                   : w.radius_m * (theta_f - theta) * tan_beta / (1.0 + slip);
    const double tau = std::copysign(strength * (1.0 - std::exp(-std::abs(j_x) / s.shear_modulus_x_m)), j_x);
    const double side =
        std::copysign(strength * (1.0 - std::exp(-std::abs(j_y) / s.shear_modulus_y_m)), -j_y);
    const double area = w.width_m * w.radius_m * theta_f / n;
    f.drawbar_pull_n += area * (tau * std::cos(theta) - sigma * std::sin(theta));
    f.vertical_n += area * (sigma * std::cos(theta) + tau * std::sin(theta));
    f.lateral_n += area * side;
    f.torque_nm += area * w.radius_m * tau;
  }
  return f;
}

TEST(WheelForces, EightNodesAnArcAgreeWithAFineSumToOneInAHundredThousand) {
  for (const Soil& soil : {sandy_loam(), loose_sand()}) {
    for (const double theta_f : {0.1, 0.4, 0.9}) {
      for (const double slip : {-0.4, 0.0, 0.1, 0.8}) {
        const double u = speed_ratio_from_slip(slip), tan_beta = 0.2;
        const WheelForces fast = wheel_forces(kWheel, soil, theta_f, {u, u * tan_beta});
        const WheelForces fine = by_midpoints(kWheel, soil, theta_f, slip, tan_beta);
        const double scale = fine.vertical_n;
        // j_x has a kink in its sign under a braked wheel, which costs the quadrature two digits.
        const double tolerance = (slip < 0.0 ? 2e-3 : 1e-5) * scale;
        EXPECT_NEAR(fast.vertical_n, fine.vertical_n, tolerance) << theta_f << " " << slip;
        EXPECT_NEAR(fast.drawbar_pull_n, fine.drawbar_pull_n, tolerance) << theta_f << " " << slip;
        EXPECT_NEAR(fast.lateral_n, fine.lateral_n, tolerance) << theta_f << " " << slip;
        EXPECT_NEAR(fast.torque_nm, fine.torque_nm, tolerance * kWheel.radius_m) << theta_f << " " << slip;
      }
    }
  }
}

// Without shear and with the greatest stress at the lowest point, the integrals have closed forms.
Soil frictionless(double n) {
  Soil soil = make_soil({1000.0, 5e5, n}, 0.0, 0.0, 0.01, 0.0, 0.0);
  return soil;
}

TEST(WheelForces, CompactionResistanceIsBekkersClosedForm) {
  for (const double n : {0.7, 1.0, 1.4}) {
    const Soil soil = frictionless(n);
    const double theta_f = 0.5, z = sinkage_m(kWheel.radius_m, theta_f);
    const double expected =
        kWheel.width_m * soil.pressure.stiffness(kWheel.width_m) * std::pow(z, n + 1.0) / (n + 1.0);
    EXPECT_NEAR(-wheel_forces(kWheel, soil, theta_f, {1.0, 0.0}).drawbar_pull_n / expected, 1.0, 1e-6);
  }
}

TEST(WheelForces, TheLoadCarriedWithoutFrictionIsTheClosedFormForLinearSoil) {
  const Soil soil = frictionless(1.0);
  const double theta_f = 0.5, r = kWheel.radius_m;
  const double expected = kWheel.width_m * soil.pressure.stiffness(kWheel.width_m) * r * r *
                          (0.5 * theta_f - 0.25 * std::sin(2.0 * theta_f));
  EXPECT_NEAR(wheel_forces(kWheel, soil, theta_f, {1.0, 0.0}).vertical_n / expected, 1.0, 1e-7);
}

TEST(WheelForces, ALockedWheelOnCohesionlessSoilSlidesWithTheFrictionAngle) {
  Soil soil = sandy_loam();
  soil.cohesion_pa = 0.0;
  soil.shear_modulus_x_m = 1e-6;  // fully mobilised everywhere
  // Nearly flat contact: the force's direction is the friction angle.
  const WheelForces f = wheel_forces({2.0, 0.16}, soil, 0.02, {0.0, 0.0});
  EXPECT_NEAR(std::atan2(f.drawbar_pull_n, f.vertical_n), soil.friction_angle_rad, 0.02);
}

TEST(WheelForces, DrivingAndBrakingMeetAtZeroSlip) {
  const Soil soil = sandy_loam();
  const WheelForces driving = wheel_forces(kWheel, soil, 0.4, {1.0 - 1e-9, 0.05});
  const WheelForces braking = wheel_forces(kWheel, soil, 0.4, {1.0 + 1e-9, 0.05});
  EXPECT_NEAR(driving.drawbar_pull_n, braking.drawbar_pull_n, 1e-5);
  EXPECT_NEAR(driving.torque_nm, braking.torque_nm, 1e-6);
  EXPECT_NEAR(driving.lateral_n, braking.lateral_n, 1e-6);
}

TEST(WheelForces, MirroringTheSideMotionMirrorsOnlyTheSideForce) {
  const Soil soil = sandy_loam();
  const WheelForces left = wheel_forces(kWheel, soil, 0.4, {0.8, 0.1});
  const WheelForces right = wheel_forces(kWheel, soil, 0.4, {0.8, -0.1});
  EXPECT_LT(left.lateral_n, 0.0) << "the soil pushes against the motion";
  EXPECT_EQ(left.lateral_n, -right.lateral_n);
  EXPECT_EQ(left.drawbar_pull_n, right.drawbar_pull_n);
}

TEST(WheelForces, PullAndTorqueRiseWithSlip) {
  const Soil soil = sandy_loam();
  double pull = -1e9, torque = -1e9;
  for (double slip = -0.6; slip < 0.96; slip += 0.05) {
    const WheelMotion motion{speed_ratio_from_slip(slip), 0.0};
    const auto theta = balanced_entry_angle_rad(kWheel, soil, 110.0, motion);
    ASSERT_TRUE(theta);
    const WheelForces f = wheel_forces(kWheel, soil, *theta, motion);
    EXPECT_GT(f.drawbar_pull_n, pull) << slip;
    EXPECT_GT(f.torque_nm, torque) << slip;
    pull = f.drawbar_pull_n;
    torque = f.torque_nm;
  }
}

TEST(WheelForces, AWheelGivesNeverMorePowerThanItIsDrivenWith) {
  for (const Soil& soil : {sandy_loam(), loose_sand()}) {
    for (double slip = -0.5; slip < 0.99; slip += 0.07) {
      const double u = speed_ratio_from_slip(slip);
      for (const double leftward : {0.0, 0.2}) {
        const WheelForces f = wheel_forces(kWheel, soil, 0.4, {u, leftward});
        // Per rim speed: torque / r in, pull times u and side force times the side speed out.
        const double lost = f.torque_nm / kWheel.radius_m - f.drawbar_pull_n * u - f.lateral_n * leftward;
        EXPECT_GT(lost, 0.0) << "slip " << slip << " leftward " << leftward;
      }
    }
  }
}

TEST(EntryAngle, TheBalancedWheelCarriesItsLoad) {
  for (const double load : {5.0, 50.0, 300.0}) {
    const WheelMotion motion{0.8, 0.05};
    const auto theta = balanced_entry_angle_rad(kWheel, sandy_loam(), load, motion);
    ASSERT_TRUE(theta);
    EXPECT_NEAR(wheel_forces(kWheel, sandy_loam(), *theta, motion).vertical_n, load, 1e-9 * load);
  }
}

TEST(EntryAngle, ALoadThatNoDepthCarriesIsRefusedWithWhatItWouldCarry) {
  const auto theta = balanced_entry_angle_rad(kWheel, loose_sand(), 1e6, {0.9, 0.0});
  ASSERT_FALSE(theta);
  EXPECT_EQ(theta.error().code, ErrorCode::kNotConverged);
  EXPECT_NE(theta.error().detail.find("sunk to the axle"), std::string::npos);
}

TEST(ZhurongLiteral, ZeroSlipInTheDenseSecondSimulantGivesThePublishedTorqueAndCurrent) {
  Soil soil = make_soil({314413.0, 7432759.0, 1.12}, 800.0, 39.3, 0.0192, 0.43, 0.32);
  const ZhurongLiteral literal = zhurong_literal({0.1475, 0.2}, soil, 34.08 * 9.81, 0.0);
  EXPECT_NEAR(literal.torque_nm, 1.427, 0.001);
  EXPECT_NEAR(literal.sinkage_m, 0.0097, 0.00005);
  EXPECT_NEAR(literal.torque_nm / kZhurongTorqueFactor / kZhurongImpliedGearRatio, 0.114, 0.0005);
}

TEST(SlipRatio, SpeedRatioAndSlipAreInverse) {
  for (const double slip : {-0.9, -0.3, 0.0, 0.4, 0.99})
    EXPECT_NEAR(slip_from_speed_ratio(speed_ratio_from_slip(slip)), slip, 1e-15);
}

class PressureSinkageRow : public testing::TestWithParam<PressureSinkageLaw> {};

TEST_P(PressureSinkageRow, IsZeroAtTheSurfaceAndRisesWithDepth) {
  ArcValues depth;
  depth << 0.0, 1e-4, 1e-3, 5e-3, 1e-2, 5e-2, 0.1, 0.2;
  const ArcValues p = GetParam().pressure_pa({2000.0, 8e5, 0.9}, 0.9, 0.16, depth);
  EXPECT_NEAR(p[0], 0.0, 1e-100);
  for (int k = 1; k < kArcNodes; ++k) EXPECT_GT(p[k], p[k - 1]);
}
INSTANTIATE_TEST_SUITE_P(Catalogue, PressureSinkageRow,
                         testing::ValuesIn(pressure_sinkage_catalogue().begin(),
                                           pressure_sinkage_catalogue().end()),
                         [](const auto& row) { return std::string(row.param.name); });

class ShearRow : public testing::TestWithParam<ShearLaw> {};

TEST_P(ShearRow, RisesFromNothingToAtMostTheWholeStrength) {
  ArcValues j;
  j << 0.0, 1e-5, 1e-3, 5e-3, 1e-2, 5e-2, 0.2, 1.0;
  const ArcValues share = GetParam().mobilised(j, 0.01);
  EXPECT_EQ(share[0], 0.0);
  for (int k = 1; k < kArcNodes; ++k) EXPECT_GE(share[k], share[k - 1]);
  EXPECT_LE(share[kArcNodes - 1], 1.0);
  EXPECT_NEAR(share[1], 1e-5 / 0.01, 1e-6) << "the slope at the origin is 1 / K";
}
INSTANTIATE_TEST_SUITE_P(Catalogue, ShearRow,
                         testing::ValuesIn(shear_catalogue().begin(), shear_catalogue().end()),
                         [](const auto& row) { return std::string(row.param.name); });

TEST(BekkerPressureSinkage, DoublingDepthRaisesPressureByTwoToTheN) {
  const ArcValues depth = ArcValues::LinSpaced(0.01, 0.08);
  const auto law = pressure_sinkage_catalogue().front().pressure_pa;
  const ArcValues ratio = law({2e3, 8e5, 1.3}, 1.3, 0.1, 2.0 * depth) / law({2e3, 8e5, 1.3}, 1.3, 0.1, depth);
  for (int k = 0; k < kArcNodes; ++k) EXPECT_NEAR(ratio[k], std::pow(2.0, 1.3), 1e-12);
}

}  // namespace
}  // namespace slipway::sim
