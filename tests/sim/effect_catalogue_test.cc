#include "sim/effect_catalogue.h"

#include <gtest/gtest.h>

#include "core/angle.h"
#include "sim/quasi_static.h"
#include "tests/sim/reference_models.h"

namespace slipway::sim {
namespace {

StationState climb(std::span<const EffectSetting> settings) {
  RoverModel rover = six_wheeler();
  Soil soil = sandy_loam();
  apply_effects(settings, rover);
  apply_effects(settings, soil);
  QuasiStaticSolver solver(rover, 3.71);
  return solver.solve(stance_on_plane(rover, {.roll_rad = 0.05, .pitch_rad = -0.2, .yaw_rad = 0.0}), soil,
                      {.speed_m_s = 0.04});
}

class EffectRow : public testing::TestWithParam<Effect> {
 protected:
  EffectSetting at(double Field::*value) const {
    EffectSetting setting{std::string(GetParam().name), {}};
    for (const Field& field : GetParam().fields) setting.parameters[std::string(field.name)] = field.*value;
    return setting;
  }
};

TEST_P(EffectRow, OffChangesNothing) {
  RoverModel rover = six_wheeler();
  Soil soil = sandy_loam();
  apply_effects({}, rover);
  apply_effects({}, soil);
  EXPECT_EQ(rover.com_m, six_wheeler().com_m);
  EXPECT_EQ(rover.wheels[0].radius_m, six_wheeler().wheels[0].radius_m);
  EXPECT_EQ(soil.n1, sandy_loam().n1);
  EXPECT_EQ(climb({}).slip_ratio, climb({}).slip_ratio);
}

TEST_P(EffectRow, OnAtTheEndOfItsRangeChangesThePrediction) {
  const EffectSetting setting = at(&Field::highest);
  const StationState with = climb({&setting, 1}), without = climb({});
  EXPECT_NE(with.wheels[0].current_a, without.wheels[0].current_a);
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

TEST(SlipSinkage, ASlippingWheelSinksDeeper) {
  const EffectSetting setting{"slip_sinkage", {{"n1", 0.3}}};
  EXPECT_GT(climb({&setting, 1}).wheels[2].sinkage_m, climb({}).wheels[2].sinkage_m);
}

}  // namespace
}  // namespace slipway::sim
