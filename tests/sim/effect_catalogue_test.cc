#include "sim/effects/effect_catalogue.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/angle.h"
#include "core/random.h"
#include "sim/quasi_static/quasi_static.h"
#include "tests/sim/reference_models.h"

namespace slipway::sim {
namespace {

StationState drive(std::span<const EffectSetting> settings, const Attitude& attitude, DriveCommand command,
                   Soil soil) {
  RoverModel rover = six_wheeler();
  apply_effects(settings, rover);
  apply_effects(settings, soil);
  for (std::size_t k = 0; k < effect_regions(settings).size(); ++k) apply_in_region(settings, k, soil);
  QuasiStaticSolver solver(rover, 3.71);
  return solver.solve(stance_on_plane(rover, attitude), soil, command);
}

StationState climb(std::span<const EffectSetting> settings) {
  return drive(settings, {.roll_rad = 0.05, .pitch_rad = -0.2, .yaw_rad = 0.0},
               {.speed_m_s = 0.03, .curvature_1_m = 0.2, .motor_temp_c = -30.0}, sandy_loam());
}

class EffectRow : public testing::TestWithParam<Effect> {
 protected:
  EffectSetting at(double Field::*value) const {
    EffectSetting setting{std::string(GetParam().name), {}};
    for (const Field& field : GetParam().fields) setting.parameters[std::string(field.name)] = field.*value;
    return setting;
  }
};

void expect_same_to_the_bit(const StationState& a, const StationState& b) {
  EXPECT_EQ(a.outcome, b.outcome);
  EXPECT_EQ(a.slip_ratio, b.slip_ratio);
  EXPECT_EQ(a.side_slip_rad, b.side_slip_rad);
  EXPECT_EQ(a.yaw_rate_rad_s, b.yaw_rate_rad_s);
  EXPECT_EQ(a.electric_power_w, b.electric_power_w);
  for (std::size_t k = 0; k < a.wheels.size(); ++k) {
    EXPECT_EQ(a.wheels[k].load_n, b.wheels[k].load_n) << k;
    EXPECT_EQ(a.wheels[k].sinkage_m, b.wheels[k].sinkage_m) << k;
    EXPECT_EQ(a.wheels[k].torque_nm, b.wheels[k].torque_nm) << k;
    EXPECT_EQ(a.wheels[k].current_a, b.wheels[k].current_a) << k;
  }
}

TEST_P(EffectRow, SwitchedOffChangesNothing) {
  EffectSetting setting = at(&Field::highest);
  setting.on = false;
  expect_same_to_the_bit(climb({&setting, 1}), climb({}));
}

// Random stations: slopes, speeds, curvatures and soils.
TEST_P(EffectRow, WithItsNeutralValuesItChangesNothingAnywhere) {
  EffectSetting setting = at(&Field::highest);
  for (const Field& field : GetParam().fields)
    if (field.neutral) setting.parameters[std::string(field.name)] = *field.neutral;
  for (std::uint64_t trial = 0; trial < 20; ++trial) {
    const auto uniform = [&](std::uint64_t k) { return random_uniform(random_key(7, trial), k); };
    const Attitude attitude{0.3 * (uniform(0) - 0.5), 0.4 * (uniform(1) - 0.5), 0.0};
    const DriveCommand command{.speed_m_s = 0.02 + 0.03 * uniform(2),
                               .curvature_1_m = 0.4 * (uniform(3) - 0.5),
                               .motor_temp_c = -60.0 + 100.0 * uniform(4)};
    Soil soil = trial % 2 ? sandy_loam() : loose_sand();
    // A soil's file may give slip sinkage of its own.
    if (trial % 3 == 0) soil.n1 = uniform(5), soil.n1_skid = uniform(6), soil.n1_lateral = uniform(7);
    expect_same_to_the_bit(drive({&setting, 1}, attitude, command, soil), drive({}, attitude, command, soil));
  }
}

TEST_P(EffectRow, OnWithItsInitialOrMaximumValuesChangesThePrediction) {
  bool changed = false;
  for (double Field::*value : {&Field::initial, &Field::highest}) {
    const EffectSetting setting = at(value);
    const StationState with = climb({&setting, 1}), without = climb({});
    for (std::size_t k = 0; k < without.wheels.size(); ++k)
      changed |= with.wheels[k].current_a != without.wheels[k].current_a;
  }
  EXPECT_TRUE(changed);
}

TEST_P(EffectRow, ItsRangeIsAcceptedAndBeyondItIsRefusedWithTheRange) {
  for (double Field::*value : {&Field::lowest, &Field::initial, &Field::highest}) {
    const EffectSetting setting = at(value);
    EXPECT_TRUE(faults_of({&setting, 1}).empty());
  }
  EffectSetting beyond = at(&Field::highest);
  for (auto& [name, value] : beyond.parameters) value += 1.0;
  const std::vector<Fault> faults = faults_of({&beyond, 1});
  ASSERT_EQ(faults.size(), GetParam().fields.size());
  for (const Fault& fault : faults)
    EXPECT_NE(fault.message.find("must be in ["), std::string::npos) << fault.message;
}

INSTANTIATE_TEST_SUITE_P(Catalogue, EffectRow,
                         testing::ValuesIn(effect_catalogue().begin(), effect_catalogue().end()),
                         [](const auto& row) { return std::string(row.param.name); });

TEST(EffectCatalogue, UnknownNamesAreRefusedWithTheKnownOnes) {
  const std::vector<EffectSetting> settings{
      {"slip_sinkage", {{"n2", 0.1}}}, {"tether", {}}, {"slip_sinkage", {}}};
  const std::vector<Fault> faults = faults_of(settings);
  ASSERT_EQ(faults.size(), 3u);
  EXPECT_EQ(faults[0].pointer, "/0/parameters/n2");
  EXPECT_NE(faults[0].message.find("known are: n1"), std::string::npos);
  EXPECT_EQ(faults[1].pointer, "/1/name");
  EXPECT_NE(faults[1].message.find("slip_sinkage"), std::string::npos);
  EXPECT_EQ(faults[2].message, "effect \"slip_sinkage\" is switched on twice");
}

TEST(EffectCatalogue, HasTheNamesThatTheGapDiagnosisUses) {
  for (const char* name :
       {"slip_sinkage", "multipass", "grousers", "bulldozing", "side_bulldozing", "com_offset",
        "motor_temperature", "gearbox_friction", "wheel_radius", "dragging_wheel", "rate_shear", "duricrust",
        "hardpan", "soft_patch", "steering_offset", "attitude_bias"})
    EXPECT_NE(find_effect(name), nullptr) << name;
}

TEST(EffectCatalogue, ARequestReplacesOrSwitchesOffWhatTheRoverFileHas) {
  const std::vector<EffectSetting> rovers{{"grousers", {{"height_m", 0.01}}}, {"multipass", {}}};
  const std::vector<EffectSetting> asked{{"grousers", {{"height_m", 0.02}}}, {"multipass", {}, false}};
  const std::vector<EffectSetting> all = in_force(rovers, asked);
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].parameters.at("height_m"), 0.02);
  EXPECT_EQ(in_force(rovers, {}).size(), 2u);
}

TEST(SlipSinkage, ASlippingWheelSinksDeeper) {
  const EffectSetting setting{"slip_sinkage", {{"n1", 0.3}}};
  EXPECT_GT(climb({&setting, 1}).wheels[2].sinkage_m, climb({}).wheels[2].sinkage_m);
}

TEST(SlipSinkage, IsAddedToWhatTheSoilHasAlready) {
  Soil soil = sandy_loam();
  soil.n1 = 0.2;
  const EffectSetting setting{"slip_sinkage", {{"n1", 0.3}, {"n1_skid", 0.1}}};
  apply_effects({&setting, 1}, soil);
  EXPECT_EQ(soil.n1, 0.5);
  EXPECT_EQ(soil.n1_skid, 0.1);
  EXPECT_EQ(soil.n1_lateral, 0.0);
}

TEST_P(EffectRow, WhatABenchmarkHidesOfItGrowsWithItsSizeAndIsWithinItsRange) {
  if (GetParam().hidden == nullptr) GTEST_SKIP() << "it is not hidden";
  const RoverModel rover = six_wheeler();
  for (std::uint64_t key = 0; key < 10; ++key) {
    const EffectSetting usual{std::string(GetParam().name), GetParam().hidden({1.0, key, rover})};
    const EffectSetting large{usual.name, GetParam().hidden({2.0, key, rover})};
    EXPECT_TRUE(faults_of({&usual, 1}).empty());
    EXPECT_TRUE(faults_of({&large, 1}).empty());
    EXPECT_TRUE(faults_of({&large, 1}, rover).empty());
    EXPECT_NE(usual.parameters, large.parameters);
  }
}

TEST(Grousers, RaiseThePullAndLowerTheSlipOfAClimb) {
  const EffectSetting setting{"grousers", {{"height_m", 0.01}, {"count", 24.0}}};
  EXPECT_LT(climb({&setting, 1}).slip_ratio, climb({}).slip_ratio);
}

TEST(Bulldozing, CostsSlipAndSideWallsHoldTheRoverAgainstSlidingSideways) {
  const EffectSetting front{"bulldozing", {}}, sides{"side_bulldozing", {}};
  EXPECT_GT(climb({&front, 1}).slip_ratio, climb({}).slip_ratio);
  const Attitude across{.roll_rad = 0.2, .pitch_rad = 0.0, .yaw_rad = 0.0};
  const DriveCommand ahead{.speed_m_s = 0.04};
  EXPECT_LT(std::abs(drive({&sides, 1}, across, ahead, loose_sand()).side_slip_rad),
            std::abs(drive({}, across, ahead, loose_sand()).side_slip_rad));
}

TEST(WheelRadius, AWheelThatIsLargerThanAssumedDrivesFartherThanCommanded) {
  const EffectSetting setting{"wheel_radius", {{"scale", 0.05}}};
  const DriveCommand ahead{.speed_m_s = 0.04};
  const double with = drive({&setting, 1}, {}, ahead, sandy_loam()).slip_ratio;
  EXPECT_NEAR(with, drive({}, {}, ahead, sandy_loam()).slip_ratio - 0.05, 0.005);
}

TEST(SoftPatch, WeakensTheSoilInItsDiscOnly) {
  const EffectSetting setting{"soft_patch",
                              {{"x_m", 10.0}, {"y_m", 5.0}, {"radius_m", 2.0}, {"weakening", 0.5}}};
  const std::vector<Disc> regions = effect_regions({&setting, 1});
  ASSERT_EQ(regions.size(), 1u);
  EXPECT_TRUE(regions[0].holds(11.0, 5.5));
  EXPECT_FALSE(regions[0].holds(12.1, 5.0));
  Soil outside = sandy_loam(), inside = sandy_loam();
  apply_effects({&setting, 1}, outside);
  apply_in_region({&setting, 1}, 0, inside);
  EXPECT_EQ(outside.cohesion_pa, sandy_loam().cohesion_pa);
  EXPECT_EQ(inside.cohesion_pa, 0.5 * sandy_loam().cohesion_pa);
  EXPECT_NEAR(std::tan(inside.friction_angle_rad), 0.5 * std::tan(sandy_loam().friction_angle_rad), 1e-12);
}

}  // namespace
}  // namespace slipway::sim
