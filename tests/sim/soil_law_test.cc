// The laws that a soil may choose: each row of the catalogue, and what a choice does to a wheel.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "sim/soil/janosi_hanamoto.h"
#include "sim/soil/reece_pressure.h"
#include "sim/soil/soil_field.h"
#include "sim/soil/soil_in_force.h"
#include "sim/soil/wong_shear.h"
#include "sim/wheel/entry_angle.h"
#include "sim/wheel/wheel_kernel.h"
#include "tests/sim/reference_models.h"

namespace slipway::sim {
namespace {

constexpr WheelGeometry kWheel{0.125, 0.16};

Soil reece_soil() {
  Soil soil = sandy_loam();
  soil.pressure_law = {.row = &kReecePressure, .parameters = {40.0, 200.0}};
  return soil;
}

Soil wong_soil(double residual_ratio) {
  Soil soil = sandy_loam();
  soil.shear_law = {.row = &kWongShear, .parameters = {residual_ratio}};
  return soil;
}

LawParameters in_the_middle(std::span<const Field> fields) {
  LawParameters parameters{};
  for (std::size_t i = 0; i < fields.size(); ++i) parameters[i] = fields[i].initial;
  return parameters;
}

void expect_near(const WheelForces& a, const WheelForces& b, double share) {
  const double close = share * (std::abs(b.vertical_n) + 1.0);
  EXPECT_NEAR(a.drawbar_pull_n, b.drawbar_pull_n, close);
  EXPECT_NEAR(a.lateral_n, b.lateral_n, close);
  EXPECT_NEAR(a.vertical_n, b.vertical_n, close);
  EXPECT_NEAR(a.torque_nm, b.torque_nm, close);
}

class PressureRow : public testing::TestWithParam<const PressureSinkageLaw*> {};

TEST_P(PressureRow, CarriesNothingAtTheSurfaceAndMoreTheDeeperAWheelSits) {
  Soil soil = sandy_loam();
  soil.pressure_law = {.row = GetParam(), .parameters = in_the_middle(GetParam()->fields)};
  EXPECT_NEAR(wheel_forces(kWheel, soil, 1e-4, {}).vertical_n, 0.0, 0.05);
  double above = 0.0;
  for (const double theta : {0.05, 0.1, 0.2, 0.4, 0.8}) {
    const double load = wheel_forces(kWheel, soil, theta, {}).vertical_n;
    EXPECT_GT(load, above);
    above = load;
  }
  EXPECT_FALSE(GetParam()->summary.empty() || GetParam()->reference.empty());
}
INSTANTIATE_TEST_SUITE_P(Catalogue, PressureRow,
                         testing::ValuesIn(soil_law_catalogue().pressure.begin(),
                                           soil_law_catalogue().pressure.end()),
                         [](const auto& row) { return std::string(row.param->name); });

class ShearRow : public testing::TestWithParam<const ShearLaw*> {};

TEST_P(ShearRow, RisesFromNothingAndStaysWithinTheStrength) {
  const ShearForm form = GetParam()->form(in_the_middle(GetParam()->fields));
  const auto mobilised = [&](double x) {
    return (form.end + form.hump * std::exp(-x)) * (1.0 - std::exp(-x));
  };
  EXPECT_EQ(mobilised(0.0), 0.0);
  for (const double x : {1e-3, 0.1, 0.5, 1.0, 5.0, 20.0, 100.0}) {
    EXPECT_GT(mobilised(x), 0.0);
    EXPECT_LT(mobilised(x), 1.05);
  }
}
INSTANTIATE_TEST_SUITE_P(Catalogue, ShearRow,
                         testing::ValuesIn(soil_law_catalogue().shear.begin(),
                                           soil_law_catalogue().shear.end()),
                         [](const auto& row) { return std::string(row.param->name); });

TEST(ReecePressure, IsBekkersLawWithItsOwnModuliUnderOneWidth) {
  const Soil reece = reece_soil();
  Soil bekker = sandy_loam();
  const double stiffness = reece.cohesion_pa * 40.0 + reece.unit_weight_n_m3() * kWheel.width_m * 200.0;
  bekker.pressure = {0.0, stiffness / std::pow(kWheel.width_m, bekker.pressure.n), bekker.pressure.n};
  for (const double theta : {0.1, 0.4, 0.9})
    expect_near(wheel_forces(kWheel, reece, theta, {0.8, 0.1}),
                wheel_forces(kWheel, bekker, theta, {0.8, 0.1}), 1e-12);
  EXPECT_NEAR(*balanced_entry_angle_rad(kWheel, reece, 110.0, {0.8, 0.0}),
              *balanced_entry_angle_rad(kWheel, bekker, 110.0, {0.8, 0.0}), 1e-10);
}

TEST(ReecePressure, DrySoilCarriesInProportionToGravityAndWeightlessSoilByDepthOverWidth) {
  Soil dry = reece_soil();
  dry.cohesion_pa = 0.0;
  const auto stiffness = [](const Soil& soil, double gravity, double width) {
    return soil_in_force(soil, gravity, 0.04, 0.0)
        .pressure_form({.width_m = width, .radius_m = 0.1})
        .stiffness;
  };
  EXPECT_NEAR(stiffness(dry, 9.81, 0.2) / stiffness(dry, 1.62, 0.2), 9.81 / 1.62, 1e-12);
  Soil clay = reece_soil();
  clay.pressure_law.parameters[1] = 0.0;
  EXPECT_EQ(stiffness(clay, 3.71, 0.1), stiffness(clay, 3.71, 0.4)) << "at z = b";
}

TEST(ReecePressure, SlipSinkageRaisesTheExponentOfDepthOverWidth) {
  Soil soil = reece_soil();
  soil.n1 = 0.3;
  Soil raised = reece_soil();
  raised.pressure.n += 0.3 * 0.5;
  expect_near(wheel_forces(kWheel, soil, 0.4, {0.5, 0.0}), wheel_forces(kWheel, raised, 0.4, {0.5, 0.0}),
              1e-12);
}

TEST(ReecePressure, ATrackIsStifferUnderItToo) {
  Soil soil = reece_soil();
  soil.multipass_stiffening = 0.9;
  const ContactSize contact{.width_m = 0.16, .radius_m = 0.125};
  EXPECT_NEAR(soil_in_force(soil, 3.71, 0.04, 1.0).pressure_form(contact).stiffness,
              1.9 * soil_in_force(soil, 3.71, 0.04, 0.0).pressure_form(contact).stiffness, 1e-6);
}

// The balance and the dynamics scale a wheel's numbers; wheels of several slices take the soil of the track.
TEST(SoilInATrack, ScalesTheNumbersOfAWheelAsItChangesTheSoil) {
  WheelGeometry wheel = kWheel;
  wheel.grousers = {.height_m = 0.01, .count = 24.0};
  for (Soil soil : {sandy_loam(), reece_soil(), wong_soil(0.6)}) {
    soil.multipass_stiffening = 1.8;
    soil.multipass_strengthening = 0.15;
    soil.bulldozing = 1.0;
    soil.track_bulldozing = 0.3;
    for (const double share : {0.0, 0.4, 1.0}) {
      const WheelNumbers fresh = numbers_of(wheel, soil_in_force(soil, 3.71, 0.04, 0.0), 0.5, {0.6, 0.1});
      WheelNumbers numbers = fresh;
      put_in_track(fresh, track_factors(soil, share), numbers);
      WheelForces forces;
      wheel_forces(std::span(&numbers, 1), std::span(&forces, 1));
      expect_near(forces, wheel_forces(wheel, soil_in_force(soil, 3.71, 0.04, share), 0.5, {0.6, 0.1}), 1e-9);
    }
  }
}

TEST(SoilInATrack, PullsMoreAtTheSameDepthWhereItIsStrongerInShear) {
  Soil soil = sandy_loam();
  soil.multipass_stiffening = 1.0;
  const auto pull = [&](double strengthening) {
    soil.multipass_strengthening = strengthening;
    return wheel_forces(kWheel, soil_in_force(soil, 3.71, 0.04, 1.0), 0.5, {0.8, 0.0}).drawbar_pull_n;
  };
  EXPECT_GT(pull(0.3), 1.02 * pull(0.0));
  soil.multipass_stiffening = 0.0;
  EXPECT_EQ(pull(0.3), pull(0.0)) << "without tracks nothing is";
}

TEST(WongShear, IsWholeAtItsModulusAndFallsToTheResidual) {
  for (const double residual : {0.3, 0.6, 0.9}) {
    const ShearForm form = wong_shear_form(residual);
    const auto mobilised = [&](double x) {
      return (form.end + form.hump * std::exp(-x)) * (1.0 - std::exp(-x));
    };
    EXPECT_NEAR(mobilised(1.0), 1.0, 1e-12);
    EXPECT_NEAR(mobilised(40.0), residual, 1e-12);
    const double e = std::numbers::e, x = 0.4;  // as the law is printed
    EXPECT_NEAR(mobilised(x),
                residual * (1.0 + (1.0 / (residual * (1.0 - 1.0 / e)) - 1.0) * std::exp(1.0 - x)) *
                    (1.0 - std::exp(-x)),
                1e-12);
    for (double at = 0.0; at < 6.0; at += 0.01) EXPECT_LT(mobilised(at), 1.031);
  }
}

TEST(WongShear, AtHighSlipAWheelPullsLessTheLowerTheResidual) {
  const auto pull = [](const Soil& soil) {
    return wheel_forces(kWheel, soil, 0.4, {0.1, 0.0}).drawbar_pull_n;
  };
  EXPECT_LT(pull(wong_soil(0.4)), pull(wong_soil(0.8)));
  EXPECT_LT(pull(wong_soil(0.4)), pull(sandy_loam()));
}

// Bekker's law and Janosi and Hanamoto's, written as laws that have not the kernel's form.
const PressureSinkageLaw kOwnBekker{.name = "own_bekker",
                                    .summary = "Bekker's law lane by lane",
                                    .reference = "[Bekker 1956]",
                                    .fields = {},
                                    .form =
                                        [](const Soil& soil, const ContactSize& contact) {
                                          return PressureForm{soil.pressure.stiffness(contact.width_m), 1.0};
                                        },
                                    .numbers =
                                        [](const Soil& soil, const ContactSize& contact) {
                                          return LawParameters{soil.pressure.stiffness(contact.width_m)};
                                        },
                                    .pressure_pa = [](const LawParameters& numbers, double n,
                                                      double z) { return numbers[0] * std::pow(z, n); }};
const ShearLaw kOwnJanosi{.name = "own_janosi",
                          .summary = "Janosi and Hanamoto's law lane by lane",
                          .reference = "[Janosi & Hanamoto 1961]",
                          .fields = {},
                          .form = nullptr,
                          .mobilised = [](const LawParameters&, double x) { return 1.0 - std::exp(-x); }};

Soil own_laws() {
  Soil soil = sandy_loam();
  soil.pressure_law.row = &kOwnBekker;
  soil.shear_law.row = &kOwnJanosi;
  return soil;
}

TEST(SoilLaws, ALawOfItsOwnFormActsInEveryInstructionSetAsTheSameLawInPacks) {
  const WheelKernel* kernels[3] = {};
  const int count = wheel_kernels(kernels, 3);
  const WheelGeometry wheel{0.125, 0.16, {0.01, 24.0}, 0.9};
  for (Soil soil : {own_laws(), reece_soil(), wong_soil(0.6)}) {
    soil.shear_coupling = 0.4;
    soil.n1 = 0.2;
    const WheelNumbers numbers = numbers_of(wheel, soil, 0.5, {0.7, 0.1});
    LawParts parts;
    parts.include(numbers);
    WheelForces first;
    kernels[0]->one(numbers, parts, first);
    for (int k = 0; k < count; ++k) {
      WheelForces other;
      kernels[k]->one(numbers, parts, other);
      expect_near(other, first, 1e-11);
      std::vector<WheelNumbers> wheels(7, numbers);
      std::vector<WheelForces> forces(7);
      kernels[k]->many(wheels.data(), parts, forces.data(), 7);
      for (const WheelForces& f : forces) expect_near(f, first, 1e-11);
    }
  }
  Soil plain = sandy_loam(), own = own_laws();
  for (const double theta : {0.05, 0.4, 1.2})
    expect_near(wheel_forces(wheel, own, theta, {0.7, 0.1}), wheel_forces(wheel, plain, theta, {0.7, 0.1}),
                1e-12);
}

TEST(SoilLaws, WheelsInOnePackMayStandOnSoilsWithDifferentLaws) {
  std::vector<Soil> soils;
  for (int k = 0; k < 13; ++k)
    soils.push_back(k % 4 == 0   ? sandy_loam()
                    : k % 4 == 1 ? reece_soil()
                    : k % 4 == 2 ? wong_soil(0.5)
                                 : own_laws());
  const std::vector<double> angles(soils.size(), 0.4);
  const std::vector<WheelMotion> motions(soils.size(), {0.7, 0.1});
  std::vector<WheelForces> together(soils.size());
  wheel_forces(kWheel, soils, angles, motions, together);
  for (std::size_t k = 0; k < soils.size(); ++k)
    expect_near(together[k], wheel_forces(kWheel, soils[k], angles[k], motions[k]), 1e-12);
}

TEST(SoilFields, EveryRowHasAKeyARangeThatHoldsItsInitialValueAndAMemberOfItsOwn) {
  Soil soil;
  double mark = 1.0;
  for (const SoilField& row : soil_fields()) {
    EXPECT_TRUE(row.holds(row.field.initial)) << row.field.name;
    row.number(soil) = mark++;
  }
  mark = 1.0;
  for (const SoilField& row : soil_fields()) EXPECT_EQ(row.number(soil), mark++) << row.field.name;
  EXPECT_EQ(find_soil_field("n"), &soil_fields()[2]);
  EXPECT_EQ(find_soil_field("m"), nullptr);
}

}  // namespace
}  // namespace slipway::sim
