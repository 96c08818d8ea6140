#include "sim/wheel/wheel_forces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/angle.h"
#include "core/random.h"
#include "sim/soil/terzaghi.h"
#include "sim/wheel/entry_angle.h"
#include "sim/wheel/slip_ratio.h"
#include "sim/wheel/wheel_kernel.h"
#include "tests/sim/reference_models.h"

namespace slipway::sim {
namespace {

constexpr WheelGeometry kWheel{0.125, 0.16};

// The same equations again, one angle at a time and with slip instead of speed ratio, summed by the midpoint
// rule; what is not an integral is written out as in the papers, side walls by a sum over slices.
WheelForces by_midpoints(const WheelGeometry& w, const Soil& s, double theta_f, double slip,
                         double tan_beta) {
  const int n = 200'000;
  const double theta_m = (s.c1 + s.c2 * std::abs(slip)) * theta_f, theta_r = -s.exit_angle_ratio * theta_f;
  const double k = s.pressure.k_c / w.width_m + s.pressure.k_phi;
  const double whole = std::hypot(1.0, tan_beta) * speed_ratio_from_slip(slip);
  const double whole_slip = slip_from_speed_ratio(whole), beta = std::atan(tan_beta);
  const double exponent = s.pressure.n + s.n1 * std::abs(whole_slip) +
                          s.n1_skid * std::max(0.0, -whole_slip) + s.n1_lateral * std::pow(std::sin(beta), 2);
  const double n_phi = std::pow(std::tan(M_PI / 4 + s.friction_angle_rad / 2), 2);
  const double gamma = s.density_kg_m3 * s.gravity_m_s2, h = w.grousers.height_m;
  const double f_g = w.width_m * (0.5 * gamma * h * h * n_phi + 2.0 * s.cohesion_pa * h * std::sqrt(n_phi));
  WheelForces f;
  for (int i = 0; i < n; ++i) {
    const double step = (theta_f - theta_r) / n, theta = theta_r + (i + 0.5) * step;
    const double equivalent =
        theta > theta_m ? theta : theta_f - (theta - theta_r) / (theta_m - theta_r) * (theta_f - theta_m);
    const double z = w.radius_m * (std::cos(equivalent) - std::cos(theta_f));
    const double sigma = k * std::pow(z, exponent) +
                         s.crust.strength_pa * z / s.crust.depth_m * std::exp(1.0 - z / s.crust.depth_m) +
                         s.hardpan.modulus_pa_m * std::max(0.0, z - s.hardpan.depth_m);
    const double strength = w.rim_friction * (s.cohesion_pa + sigma * std::tan(s.friction_angle_rad));
    const double travel = std::sin(theta_f) - std::sin(theta);
    const double j_x = slip >= 0.0 ? w.radius_m * (theta_f - theta - (1.0 - slip) * travel)
                                   : w.radius_m * (theta_f - theta - travel / (1.0 + slip));
    const double j_y = slip >= 0.0 ? w.radius_m * (1.0 - slip) * (theta_f - theta) * tan_beta
                                   : w.radius_m * (theta_f - theta) * tan_beta / (1.0 + slip);
    double m_x = std::copysign(1.0 - std::exp(-std::abs(j_x) / s.shear_modulus_x_m), j_x);
    double m_y = std::copysign(1.0 - std::exp(-std::abs(j_y) / s.shear_modulus_y_m), j_y);
    const double a = j_x / s.shear_modulus_x_m, b = j_y / s.shear_modulus_y_m, j = std::hypot(a, b);
    m_x += s.shear_coupling * ((1.0 - std::exp(-j)) * a / j - m_x);
    m_y += s.shear_coupling * ((1.0 - std::exp(-j)) * b / j - m_y);
    const double tau = strength * m_x, area = w.width_m * w.radius_m * step;
    // Cleats with a mobilisation of their own take no part in the coupling across.
    double m_cleat = m_x;
    if (w.grousers.mobilisation != 1.0 || w.grousers.by_slip != 0.0) {
      const double by_slip = w.radius_m * (theta_f - theta) * (1.0 - speed_ratio_from_slip(slip));
      const double j_cleat = (1.0 - w.grousers.by_slip) * j_x + w.grousers.by_slip * by_slip;
      m_cleat = std::copysign(
          1.0 - std::exp(-std::abs(j_cleat) / (w.grousers.mobilisation * s.shear_modulus_x_m)), j_cleat);
    }
    const double grousers = w.grousers.count * step / (2.0 * M_PI) * f_g * m_cleat;
    f.drawbar_pull_n += area * (tau * std::cos(theta) - sigma * std::sin(theta)) + grousers * std::cos(theta);
    f.vertical_n += area * (sigma * std::cos(theta) + tau * std::sin(theta)) + grousers * std::sin(theta);
    f.lateral_n -= area * strength * m_y;
    f.torque_nm += area * w.radius_m * tau + grousers * (w.radius_m + 2.0 / 3.0 * h);
  }
  const double z0 = w.radius_m * (1.0 - std::cos(theta_f));
  const double x = std::cos(beta), moving = whole / std::hypot(whole, 0.05);
  const double front = x * moving / std::hypot(x * moving, 0.3) * std::hypot(1.0, 0.3);
  f.drawbar_pull_n -= s.bulldozing * front * w.width_m *
                      (0.5 * gamma * z0 * z0 * n_phi + 2.0 * s.cohesion_pa * z0 * std::sqrt(n_phi));
  const double phi = s.friction_angle_rad, tangent = std::tan(phi);
  const double n_q =
      std::exp((1.5 * M_PI - phi) * tangent) / (2.0 * std::pow(std::cos(M_PI / 4 + phi / 2), 2));
  const double n_gamma = 2.0 * (n_q + 1.0) * tangent / (1.0 + 0.4 * std::sin(4.0 * phi));
  const double reach = w.radius_m * std::sin(theta_f), a = s.side_mobilised_rad;
  const double mobilised = std::sin(beta) * moving / std::hypot(std::sin(a), std::cos(a) * std::sin(beta));
  for (int i = 0; i < 20'000; ++i) {
    const double at = -reach + (i + 0.5) * 2.0 * reach / 20'000;
    const double depth = std::sqrt(w.radius_m * w.radius_m - at * at) - (w.radius_m - z0);
    f.lateral_n -= s.side_bulldozing * mobilised * 2.0 * reach / 20'000 * depth *
                   (gamma * n_gamma * depth + s.cohesion_pa * (n_q - 1.0) / tangent);
  }
  return f;
}

void expect_agreement(const WheelGeometry& wheel, const Soil& soil, double theta_f, double slip,
                      double tolerance) {
  const double u = speed_ratio_from_slip(slip), tan_beta = 0.2;
  const WheelForces fast = wheel_forces(wheel, soil, theta_f, {u, u * tan_beta});
  const WheelForces fine = by_midpoints(wheel, soil, theta_f, slip, tan_beta);
  const double close = tolerance * fine.vertical_n;
  EXPECT_NEAR(fast.vertical_n, fine.vertical_n, close) << theta_f << " " << slip;
  EXPECT_NEAR(fast.drawbar_pull_n, fine.drawbar_pull_n, close) << theta_f << " " << slip;
  EXPECT_NEAR(fast.lateral_n, fine.lateral_n, close) << theta_f << " " << slip;
  EXPECT_NEAR(fast.torque_nm, fine.torque_nm, close * wheel.radius_m) << theta_f << " " << slip;
}

TEST(WheelForces, EightNodesAnArcAgreeWithAFineSumToOneInAHundredThousand) {
  for (const Soil& soil : {sandy_loam(), loose_sand()})
    for (const double theta_f : {0.1, 0.4, 0.9})
      for (const double slip : {-0.4, 0.0, 0.1, 0.8})
        // j_x has a kink in its sign under a braked wheel, which costs the quadrature two digits.
        expect_agreement(kWheel, soil, theta_f, slip, slip < 0.0 ? 2e-3 : 1e-5);
}

Soil every_effect(Soil soil) {
  soil.n1 = 0.3;
  soil.n1_skid = 0.2;
  soil.n1_lateral = 0.4;
  soil.exit_angle_ratio = 0.3;
  soil.shear_coupling = 0.6;
  soil.bulldozing = soil.side_bulldozing = 0.7;
  soil.crust = {2000.0, 0.01};
  soil.hardpan = {4e5, 0.02};
  return soil;
}

TEST(WheelForces, WithEveryEffectOnTheyAgreeWithTheEquationsWrittenOut) {
  const WheelGeometry wheel{0.125, 0.16, {0.01, 24.0}, 0.8};
  for (const Soil& soil : {every_effect(sandy_loam()), every_effect(loose_sand())})
    for (const double theta_f : {0.2, 0.4, 0.9})
      for (const double slip : {-0.4, 0.0, 0.1, 0.8})
        // The hard layer's kink costs digits too.
        expect_agreement(wheel, soil, theta_f, slip, 3e-3);
}

TEST(WheelForces, SideWallsThatResistFromSmallSlipAnglesOnAgreeWithTheEquationsWrittenOut) {
  Soil soil = every_effect(sandy_loam());
  for (const double degrees : {1.0, 5.0, 20.0}) {
    soil.side_mobilised_rad = rad_from_deg(degrees);
    for (const double theta_f : {0.2, 0.4, 0.9})
      for (const double slip : {-0.4, 0.0, 0.1, 0.8}) expect_agreement(kWheel, soil, theta_f, slip, 3e-3);
  }
}

// The two equations that are published are the ends of the family.
TEST(EarlyMobilisation, IsThatOfTheSineOfTheSlipAngleOrAllFromTheFirst) {
  const double with_sine = 1.0, at_once = std::pow(std::sin(rad_from_deg(0.001)), 2);
  for (const double degrees : {0.1, 2.0, 15.0, 80.0})
    for (const double speed : {0.01, 1.0, 30.0}) {
      const double beta = rad_from_deg(degrees), ahead = speed * std::cos(beta),
                   left = speed * std::sin(beta);
      EXPECT_EQ(early_mobilisation(ahead, left, with_sine), 1.0);
      EXPECT_NEAR(std::sin(beta) * early_mobilisation(ahead, left, at_once), 1.0, 0.01);
      EXPECT_EQ(early_mobilisation(ahead, left, at_once), early_mobilisation(-ahead, -left, at_once));
    }
  const double a = rad_from_deg(5.0), squared = std::sin(a) * std::sin(a);
  EXPECT_NEAR(std::sin(a) * early_mobilisation(std::cos(a), std::sin(a), squared),
              1.0 / std::sqrt(1.0 + std::pow(std::cos(a), 2)), 1e-9);
  EXPECT_EQ(early_mobilisation(0.0, 0.0, squared), 1.0);
}

// A wheel that spins on the spot with a little drift meets no wall, however soon that would act.
TEST(WheelForces, SideWallsPushNothingWhereTheWheelHardlyMoves) {
  Soil soil = sandy_loam();
  const auto side_n = [&](double forward, double leftward) {
    soil.side_bulldozing = 0.0;
    const double without = wheel_forces(kWheel, soil, 0.4, {forward, leftward}).lateral_n;
    soil.side_bulldozing = 1.0;
    return without - wheel_forces(kWheel, soil, 0.4, {forward, leftward}).lateral_n;
  };
  soil.side_mobilised_rad = rad_from_deg(1.0);
  const double in_motion = side_n(1.0, 0.1);
  EXPECT_GT(in_motion, 1.0);
  EXPECT_LT(side_n(0.001, 0.001), 0.05 * in_motion);
  EXPECT_EQ(side_n(0.0, 0.0), 0.0);
}

TEST(WheelForces, CleatsWithAMobilisationOfTheirOwnAgreeWithTheEquationsWrittenOut) {
  for (const double by_slip : {0.0, 0.4, 1.0}) {
    const WheelGeometry wheel{0.125, 0.16, {0.01, 24.0, 0.3, by_slip}};
    for (const double theta_f : {0.2, 0.4, 0.9})
      for (const double slip : {-0.4, 0.0, 0.05, 0.8})
        expect_agreement(wheel, sandy_loam(), theta_f, slip, 3e-3);
  }
}

TEST(WheelForces, CleatsMobilisedBySlipRestWithoutItAndBrakeAsTheyDrive) {
  const WheelGeometry smooth{0.125, 0.16}, cleated{0.125, 0.16, {0.01, 24.0, 0.3, 1.0}};
  const auto thrust = [&](double forward) {
    return wheel_forces(cleated, sandy_loam(), 0.4, {forward, 0.0}).drawbar_pull_n -
           wheel_forces(smooth, sandy_loam(), 0.4, {forward, 0.0}).drawbar_pull_n;
  };
  EXPECT_NEAR(thrust(1.0), 0.0, 1e-9);
  EXPECT_GT(thrust(0.95), 1.0);
  EXPECT_NEAR(thrust(0.95), -thrust(1.05), 1e-9);
}

TEST(WheelForces, ManyAtOnceAreTheSameAsOneByOneOnEveryInstructionSet) {
  std::vector<Soil> soils;
  std::vector<double> angles;
  std::vector<WheelMotion> motions;
  for (int k = 0; k < 67; ++k) {
    Soil soil = k % 3 == 0 ? sandy_loam() : every_effect(loose_sand());
    soil.pressure.n *= 1.0 + 0.003 * k;
    soil.side_mobilised_rad = rad_from_deg(1.0 + k);
    soils.push_back(soil);
    angles.push_back(0.2 + 0.01 * k);
    motions.push_back({1.6 - 0.02 * k, 0.05 * (k % 5 - 2)});
  }
  const WheelGeometry wheel{0.125, 0.16, {0.01, 24.0}, 0.9};
  std::vector<WheelForces> many(soils.size());
  wheel_forces(wheel, soils, angles, motions, many);
  for (std::size_t k = 0; k < soils.size(); ++k) {
    const WheelForces one = wheel_forces(wheel, soils[k], angles[k], motions[k]);
    const double close = 1e-12 * (std::abs(one.vertical_n) + 1.0);
    EXPECT_NEAR(many[k].drawbar_pull_n, one.drawbar_pull_n, close) << k;
    EXPECT_NEAR(many[k].lateral_n, one.lateral_n, close) << k;
    EXPECT_NEAR(many[k].vertical_n, one.vertical_n, close) << k;
    EXPECT_NEAR(many[k].torque_nm, one.torque_nm, close) << k;
  }
}

TEST(WheelKernel, AllInstructionSetsAgreeToRounding) {
  const WheelKernel* kernels[3] = {};
  const int count = wheel_kernels(kernels, 3);
  const WheelGeometry wheel{0.125, 0.16, {0.01, 24.0}, 0.9};
  for (int k = 0; k < count; ++k) {
    for (const double theta_f : {0.05, 0.4, 1.4}) {
      Soil soil = every_effect(sandy_loam());
      soil.side_mobilised_rad = rad_from_deg(5.0);
      const WheelNumbers numbers = numbers_of(wheel, soil, theta_f, {0.7, 0.1});
      LawParts parts;
      parts.include(numbers);
      WheelForces first, other;
      kernels[0]->one(numbers, parts, first);
      kernels[k]->one(numbers, parts, other);
      EXPECT_NEAR(first.drawbar_pull_n, other.drawbar_pull_n, 1e-11 * first.vertical_n)
          << kernels[k]->instruction_set;
      EXPECT_NEAR(first.lateral_n, other.lateral_n, 1e-11 * first.vertical_n) << kernels[k]->instruction_set;
      EXPECT_NEAR(first.vertical_n, other.vertical_n, 1e-11 * first.vertical_n)
          << kernels[k]->instruction_set;
    }
  }
}

// A wheel on random soil: every second one with slip sinkage, every fourth with bulldozing and cleats
// besides, every eighth with a crust and side walls too.
WheelNumbers random_wheel(std::uint64_t key) {
  const auto u = [&](std::uint64_t counter) { return random_uniform(key, counter); };
  Soil soil;
  soil.pressure = {.k_c = 1e3 + 3e4 * u(0), .k_phi = 1e5 + 1e6 * u(1), .n = 0.5 + u(2)};
  soil.cohesion_pa = 2000.0 * u(3);
  soil.friction_angle_rad = 0.4 + 0.4 * u(4);
  soil.shear_modulus_x_m = 0.005 + 0.03 * u(5);
  soil.shear_modulus_y_m = 0.005 + 0.03 * u(6);
  soil.c1 = 0.5 * u(7);
  soil.c2 = 0.3 * u(8);
  soil.n1 = key % 2 == 0 ? 0.4 * u(9) : 0.0;
  soil.bulldozing = key % 4 == 0 ? u(10) : 0.0;
  soil.side_bulldozing = key % 8 == 0 ? u(11) : 0.0;
  soil.crust = {key % 8 == 0 ? 2000.0 * u(12) : 0.0, 0.02};
  WheelGeometry wheel{0.12 + 0.2 * u(13), 0.1 + 0.3 * u(14)};
  if (key % 4 == 0) wheel.grousers = {0.01, 24.0};
  return numbers_of(wheel, soil, 0.1 + u(15), {0.1 + 1.6 * u(16), 0.2 * (u(17) - 0.5)});
}

// An answer is the same on every machine with fused multiply-add, whatever the width of its packs.
TEST(WheelKernel, InstructionSetsWithFusedMultiplyAddAgreeToTheBit) {
  const WheelKernel* kernels[3] = {};
  if (wheel_kernels(kernels, 3) < 3) GTEST_SKIP() << "this machine has no AVX-512";
  constexpr std::size_t kWheels = 16;
  const auto same = [](const WheelForces& a, const WheelForces& b) {
    return a.drawbar_pull_n == b.drawbar_pull_n && a.lateral_n == b.lateral_n &&
           a.vertical_n == b.vertical_n && a.torque_nm == b.torque_nm;
  };
  for (std::uint64_t batch = 0; batch < 2000; ++batch) {
    std::vector<WheelNumbers> wheels;
    LawParts parts;
    for (std::uint64_t k = 0; k < kWheels; ++k) {
      wheels.push_back(random_wheel(batch * 8 * kWheels + k * (batch % 8)));
      parts.include(wheels.back());
    }
    std::array<WheelForces, kWheels> narrow, wide;
    kernels[1]->many(wheels.data(), parts, narrow.data(), kWheels);
    kernels[2]->many(wheels.data(), parts, wide.data(), kWheels);
    for (std::size_t k = 0; k < kWheels; ++k) {
      ASSERT_TRUE(same(narrow[k], wide[k])) << "in a pack: " << batch << ", " << k;
      kernels[1]->one(wheels[k], parts, narrow[k]);
      kernels[2]->one(wheels[k], parts, wide[k]);
      ASSERT_TRUE(same(narrow[k], wide[k])) << "alone: " << batch << ", " << k;
    }
  }
}

TEST(WheelForces, CoupledShearKeepsTheResultantWithinTheStrength) {
  Soil soil = sandy_loam();
  soil.shear_modulus_x_m = soil.shear_modulus_y_m = 1e-5;  // fully mobilised everywhere
  const WheelMotion motion{0.5, 0.5};
  const auto share = [&](double coupling) {
    soil.shear_coupling = coupling;
    const WheelForces f = wheel_forces({2.0, 0.16}, soil, 0.02, motion);  // nearly flat
    return std::hypot(f.torque_nm / 2.0, f.lateral_n);
  };
  const WheelForces along = wheel_forces({2.0, 0.16}, soil, 0.02, {0.5, 0.0});
  EXPECT_NEAR(share(0.0), std::sqrt(2.0) * along.torque_nm / 2.0, 1e-2 * along.vertical_n);
  EXPECT_NEAR(share(1.0), along.torque_nm / 2.0, 1e-2 * along.vertical_n);
}

TEST(WheelForces, AContactBehindTheAxleCarriesMoreAndResistsLess) {
  Soil soil = sandy_loam();
  const WheelForces plastic = wheel_forces(kWheel, soil, 0.4, {0.9, 0.0});
  soil.exit_angle_ratio = 0.3;
  const WheelForces rebounding = wheel_forces(kWheel, soil, 0.4, {0.9, 0.0});
  EXPECT_GT(rebounding.vertical_n, plastic.vertical_n);
  EXPECT_GT(rebounding.drawbar_pull_n / rebounding.vertical_n, plastic.drawbar_pull_n / plastic.vertical_n);
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

}  // namespace
}  // namespace slipway::sim
