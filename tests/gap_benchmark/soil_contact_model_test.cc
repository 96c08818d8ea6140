#include "soil_contact_model.h"

#include <gtest/gtest.h>

#include <cmath>

namespace slipway::gap_benchmark {
namespace {

constexpr double kRadius_m = 0.125, kWidth_m = 0.16, kSpeed_m_s = 0.04;

ContactSoil sandy_loam() {
  ContactSoil soil;
  soil.modulus_ratio_m = 20000.0 / 1.2e6;
  soil.stiffness = 20000.0 / kWidth_m + 1.2e6;
  soil.n = 0.95;
  soil.cohesion_pa = 1500.0;
  soil.tan_phi = std::tan(0.628);
  soil.shear_modulus_m = 0.01;
  return soil;
}

// Without strength: pressure alone.
ContactSoil smooth_soil() {
  ContactSoil soil = sandy_loam();
  soil.cohesion_pa = soil.tan_phi = 0.0;
  return soil;
}

WheelMotion at_slip(double slip, double slip_angle_rad = 0.0) {
  const double ahead = kSpeed_m_s * (1.0 - slip);
  return {ahead, -ahead * std::tan(slip_angle_rad), kSpeed_m_s / kRadius_m};
}

double depth_under(const WheelLaw& law, double load_n, const WheelMotion& motion, const ContactSoil& soil) {
  double low = 0.0, high = 0.06;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (law.loads(middle, motion, soil).normal_n < load_n ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

// Depth below the heap's top and length of the patch before the lowest point, of a wheel on undisturbed soil.
struct Sunk {
  double depth_m, length_m;
};
Sunk sunk(double radius_m, double width_m, double depth_m) {
  const double side = std::sqrt(depth_m * (2.0 * radius_m - depth_m));
  const double front = 0.25 * width_m / (width_m + 2.0 * side);  // of what is displaced
  const double depth = depth_m / (1.0 - front);
  return {depth, std::sqrt(depth * (2.0 * radius_m - depth))};
}

TEST(SoilContactModel, LowestPressureIsBekkers) {
  // Without the cohesive modulus it is that of any plate; with it, that of a plate as narrow as the patch.
  for (const double k_c : {0.0, 20000.0}) {
    ContactSoil soil = smooth_soil();
    soil.modulus_ratio_m = k_c / 1.2e6;
    soil.stiffness = k_c / kWidth_m + 1.2e6;
    const SoilContactModel law(kRadius_m, kWidth_m);
    const Rut rut = law.rut(0.01, soil);
    const Sunk under = sunk(kRadius_m, kWidth_m, 0.01);
    const double rebound = rut.across.front().yield_pa / 2e8;
    const double length = under.length_m + std::sqrt(rebound * (2.0 * kRadius_m - rebound));
    const double b = kWidth_m * length / (kWidth_m + length);  // 2 area / perimeter
    const double pressure = (k_c / b + 1.2e6) * std::pow(under.depth_m, 0.95);
    for (const SoilNode& node : rut.across) {
      EXPECT_NEAR(node.yield_pa, pressure, 2e-4 * pressure);
      EXPECT_NEAR(node.level_m(), -0.01 + rebound, 1e-9);
    }
  }
}

TEST(SoilContactModel, WideFlatWheelIsAPlate) {
  // A very large and wide wheel in a rut hardly deeper than it has been: its pressure is that of a plate at
  // the rut's depth or a little below, all over the front, and falls as a parabola over the elastic rear.
  ContactSoil soil = smooth_soil();
  soil.modulus_ratio_m = 0.0;
  soil.stiffness = 1.2e6;
  constexpr double kLarge_m = 500.0, kWide_m = 5.0, kDeep_m = 0.02, kFurther_m = 1e-3;
  const SoilContactModel law(kLarge_m, kWide_m, {.strips = 8, .nodes_before = 400, .nodes_behind = 50});
  const auto plate = [&](double depth_m) { return soil.stiffness * std::pow(depth_m, soil.n); };
  soil.met.assign(8,
                  {.origin_m = 0.0, .plastic_m = kDeep_m - plate(kDeep_m) / 2e8, .yield_pa = plate(kDeep_m)});
  const Sunk further = sunk(kLarge_m, kWide_m, kFurther_m);
  const double lowest = plate(kDeep_m + further.depth_m);
  const double area = kWide_m * (further.length_m + 2.0 / 3.0 * std::sqrt(2.0 * kLarge_m * lowest / 2e8));
  const double normal = law.loads(kFurther_m, {kSpeed_m_s, 0.0, kSpeed_m_s / kLarge_m}, soil).normal_n;
  EXPECT_NEAR(normal, area * plate(kDeep_m), 0.05 * normal);
  EXPECT_LT(normal, area * lowest);
}

TEST(SoilContactModel, StandingLoadIsTheIntegralOfPressure) {
  const ContactSoil soil = smooth_soil();
  const SoilContactModel law(kRadius_m, kWidth_m);
  const Sunk under = sunk(kRadius_m, kWidth_m, 0.01);
  const auto pressure_at = [&](double stiffness, double x) {
    const double rise = kRadius_m - std::sqrt(kRadius_m * kRadius_m - x * x);
    const double lowest = stiffness * std::pow(under.depth_m, soil.n);
    return x >= 0.0 ? stiffness * std::pow(std::max(under.depth_m - rise, 0.0), soil.n)
                    : std::max(lowest - 2e8 * rise, 0.0);
  };
  const double yield = law.rut(0.01, soil).across.front().yield_pa;
  const double stiffness = yield / std::pow(under.depth_m, soil.n);
  double load = 0.0, resistance = 0.0;
  constexpr int kPanels = 400000;
  const double step = 2.0 * under.length_m / kPanels;
  for (int i = 0; i < kPanels; ++i) {
    const double x = -under.length_m + (i + 0.5) * step;
    const double force = kWidth_m * step * pressure_at(stiffness, x);
    load += force;
    resistance += force * x / std::sqrt(kRadius_m * kRadius_m - x * x);
  }
  const WheelLoads loads = law.loads(0.01, at_slip(0.0), soil);
  EXPECT_NEAR(loads.normal_n, load, 3e-3 * load);
  EXPECT_NEAR(loads.pull_n, -resistance, 5e-3 * resistance);
  EXPECT_EQ(loads.torque_nm, 0.0);
}

TEST(SoilContactModel, PullRisesWithSlipAndSaturates) {
  const ContactSoil soil = sandy_loam();
  const SoilContactModel law(kRadius_m, kWidth_m);
  const auto pull = [&](double slip) { return law.loads(0.01, at_slip(slip), soil).pull_n; };
  EXPECT_LT(pull(0.0), 0.0);
  for (double slip = 0.0; slip < 0.9; slip += 0.05) EXPECT_LT(pull(slip), pull(slip + 0.05));
  EXPECT_LT(pull(0.95) - pull(0.85), 0.02 * (pull(0.85) - pull(0.0)));
  // No more than the strength on the patch.
  const WheelLoads loads = law.loads(0.01, at_slip(0.95), soil);
  const double area =
      kWidth_m * kRadius_m * std::acos(1.0 - sunk(kRadius_m, kWidth_m, 0.01).depth_m / kRadius_m);
  EXPECT_LT(loads.torque_nm, kRadius_m * 1.1 * (soil.cohesion_pa * area + loads.normal_n * soil.tan_phi));
}

TEST(SoilContactModel, SideForceIsOddInTheSlipAngle) {
  const ContactSoil soil = sandy_loam();
  const SoilContactModel law(kRadius_m, kWidth_m);
  EXPECT_EQ(law.loads(0.01, at_slip(0.2), soil).side_n, 0.0);
  double before = 0.0;
  for (const double angle : {0.02, 0.05, 0.1, 0.2, 0.4}) {
    const WheelLoads one = law.loads(0.01, at_slip(0.2, angle), soil),
                     other = law.loads(0.01, at_slip(0.2, -angle), soil);
    EXPECT_NEAR(one.side_n, -other.side_n, 1e-9);
    EXPECT_NEAR(one.pull_n, other.pull_n, 1e-9);
    EXPECT_GT(one.side_n, before);
    before = one.side_n;
  }
}

TEST(SoilContactModel, DrivingBackwardsMirrorsTheWheel) {
  const ContactSoil soil = sandy_loam();
  const SoilContactModel law(kRadius_m, kWidth_m);
  const WheelMotion motion = at_slip(0.3, 0.1);
  const WheelLoads one = law.loads(0.01, motion, soil),
                   other = law.loads(0.01, {-motion.forward_m_s, -motion.left_m_s, -motion.rate_rad_s}, soil);
  EXPECT_EQ(one.normal_n, other.normal_n);
  EXPECT_EQ(one.pull_n, -other.pull_n);
  EXPECT_EQ(one.side_n, -other.side_n);
  EXPECT_EQ(one.torque_nm, -other.torque_nm);
}

TEST(SoilContactModel, SlidingSidewaysTheDirectionOfCreepDoesNotMatter) {
  const ContactSoil soil = sandy_loam();
  const SoilContactModel law(kRadius_m, kWidth_m);
  for (const double left : {-0.02, 0.01}) {
    const WheelLoads on = law.loads(0.01, {1e-6, left, 0.3}, soil),
                     back = law.loads(0.01, {-1e-6, left, 0.3}, soil);
    EXPECT_NEAR(on.normal_n, back.normal_n, 0.01 * on.normal_n);
    EXPECT_NEAR(on.pull_n, back.pull_n, 0.01 * on.normal_n);
    EXPECT_NEAR(on.side_n, back.side_n, 0.01 * on.normal_n);
    EXPECT_NEAR(on.torque_nm, back.torque_nm, 0.01 * on.torque_nm);
  }
}

TEST(SoilContactModel, LaterPassesSinkLess) {
  ContactSoil soil = sandy_loam();
  const SoilContactModel law(kRadius_m, kWidth_m);
  constexpr double kLoad_n = 110.0;
  double before = 1.0, level = 0.0;
  for (int pass = 0; pass < 4; ++pass) {
    const double depth = depth_under(law, kLoad_n, at_slip(0.1), soil);
    EXPECT_LT(depth, (pass == 1 ? 0.5 : 1.0) * before) << pass;
    soil.met = law.rut(depth, soil).across;
    EXPECT_LT(soil.met.front().level_m(), level);
    before = depth;
    level = soil.met.front().level_m();
  }
}

TEST(SoilContactModel, TheStatedShareOfThePushedSoilIsHeapedAtTheSides) {
  const SoilContactModel law(kRadius_m, kWidth_m);
  const Rut rut = law.rut(0.012, sandy_loam());
  const double side = std::sqrt(0.012 * (2.0 * kRadius_m - 0.012));
  const double displaced = 0.012 * kWidth_m;
  EXPECT_NEAR(rut.berm_height_m * rut.berm_width_m, 0.25 * displaced * side / (kWidth_m + 2.0 * side), 1e-9);
}

TEST(SoilContactModel, LoadsConvergeWithTheSpacingOfNodes) {
  const ContactGrid as_used;
  const SoilContactModel law(kRadius_m, kWidth_m, as_used),
      finer(kRadius_m, kWidth_m,
            {2 * as_used.strips, 2 * as_used.nodes_before, 2 * as_used.nodes_behind,
             2 * as_used.nodes_far_behind});
  ContactSoil virgin = sandy_loam(), rut = virgin, finer_rut = virgin;
  rut.met = law.rut(0.012, virgin).across;
  finer_rut.met = finer.rut(0.012, virgin).across;
  for (const double slip : {0.05, 0.2, 0.6})
    for (const double angle : {0.0, 0.05, 0.3})
      for (const bool again : {false, true}) {
        const double depth = again ? 0.003 : 0.012;
        const WheelLoads coarse = law.loads(depth, at_slip(slip, angle), again ? rut : virgin),
                         fine = finer.loads(depth, at_slip(slip, angle), again ? finer_rut : virgin);
        const double thrust = std::hypot(fine.torque_nm / kRadius_m, fine.side_n);
        EXPECT_NEAR(coarse.normal_n, fine.normal_n, 0.01 * fine.normal_n) << slip << ' ' << angle;
        EXPECT_NEAR(coarse.torque_nm, fine.torque_nm, 0.01 * fine.torque_nm) << slip << ' ' << angle;
        EXPECT_NEAR(coarse.pull_n, fine.pull_n, 0.01 * thrust) << slip << ' ' << angle;
        EXPECT_NEAR(coarse.side_n, fine.side_n, 0.01 * thrust) << slip << ' ' << angle;
      }
}

}  // namespace
}  // namespace slipway::gap_benchmark
