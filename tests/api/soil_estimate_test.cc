#include "api/requests/soil_estimate.h"

#include <gtest/gtest.h>

#include <cmath>

#include "api/documents/soil/soil_estimate_document.h"
#include "api/files/soil_file.h"
#include "api/files/soil_tests_csv.h"
#include "api/report/soil_estimate_chart.h"
#include "api/requests/soil_test_rigs.h"
#include "small_world.h"

namespace slipway::api {
namespace {

using gap::SoilChannel;
using testing::small_world;

TEST(WheelTestsCsv, ColumnsMayStandInAnyOrderAndCellsBeEmpty) {
  const auto tests = read_wheel_tests_csv("a.csv",
                                          "torque_nm, load_n,slip_ratio,sinkage_m,torque_std_nm\n"
                                          "1.5,60,0.1,0.01,0.2\n\n,80,-0.2,0.012,\n");
  ASSERT_TRUE(tests) << tests.error().detail;
  ASSERT_EQ(tests->size(), 2U);
  EXPECT_EQ((*tests)[0].test.load_n, 60.0);
  EXPECT_EQ((*tests)[0][SoilChannel::kTorque].value, 1.5);
  EXPECT_EQ((*tests)[0][SoilChannel::kTorque].std, 0.2);
  EXPECT_FALSE((*tests)[1][SoilChannel::kTorque].value);
  EXPECT_EQ((*tests)[1].test.slip, -0.2);
}

TEST(WheelTestsCsv, EveryFaultIsNamedWithItsPlace) {
  const auto tests = read_wheel_tests_csv("a.csv",
                                          "load_n,slip_ratio,torqe_nm,sinkage_m\n"
                                          "60,0.1,1,0.01\n"
                                          "-5,1.5,1,deep\n"
                                          "60,0.1,1\n");
  ASSERT_FALSE(tests);
  EXPECT_EQ(tests.error().code, ErrorCode::kUnreadableData);
  std::vector<std::string> places;
  for (const Fault& fault : tests.error().faults) places.push_back(fault.pointer);
  const std::vector<std::string> expected{"a.csv, line 1, column 3", "a.csv, line 3, column 1 (load_n)",
                                          "a.csv, line 3, column 2 (slip_ratio)",
                                          "a.csv, line 3, column 4 (sinkage_m)", "a.csv, line 4"};
  EXPECT_EQ(places, expected);
  EXPECT_NE(tests.error().faults[0].message.find("torque_nm"), std::string::npos);
  EXPECT_EQ(tests.error().faults[1].message, "load_n = -5, must be in (0, 1e+06]");
  std::string wrong = "load_n,slip_ratio,sinkage_m\n";
  for (int row = 0; row < 5000; ++row) wrong += "x,y,z\n";
  const auto many = read_wheel_tests_csv("b.csv", wrong);
  ASSERT_FALSE(many);
  ASSERT_EQ(many.error().faults.size(), 101U) << "a hundred, and how many more";
  EXPECT_EQ(many.error().faults.back().message, "14900 faults more like these");
  EXPECT_FALSE(read_wheel_tests_csv("b.csv", ""));
  EXPECT_FALSE(read_wheel_tests_csv("b.csv", "load_n,slip_ratio\n60,0.1\n"));
}

TEST(WheelTestsCsv, RowsNameTheirWheelAndSoil) {
  const auto tests = read_wheel_tests_csv("a.csv",
                                          "wheel,load_n,slip_ratio,lateral_force_n,soil\n"
                                          "smooth,60,0.1,-3,dry\nlugged,60,0.1,-4,dry\n");
  ASSERT_TRUE(tests) << tests.error().detail;
  EXPECT_EQ((*tests)[1].wheel, "lugged");
  EXPECT_EQ((*tests)[1].soil, "dry");
  EXPECT_EQ((*tests)[1][SoilChannel::kLateralForce].value, -4.0);
  const auto unnamed =
      read_wheel_tests_csv("a.csv", "wheel,load_n,slip_ratio,torque_nm\n,60,0.1,1\nA b,60,0.1,1\n");
  ASSERT_FALSE(unnamed);
  ASSERT_EQ(unnamed.error().faults.size(), 2U);
  EXPECT_EQ(unnamed.error().faults[0].pointer, "a.csv, line 2, column 1 (wheel)");
}

TEST(PlateTestsCsv, ForcesAreTakenOverThePlatesArea) {
  const auto tests = read_plate_tests_csv("p.csv",
                                          "plate_radius_m,sinkage_m,force_n\n"
                                          "0.1,0.01,100\n0.1,0.02,200\n0.2,0.01,300\n");
  ASSERT_TRUE(tests) << tests.error().detail;
  ASSERT_EQ(tests->size(), 2U);
  EXPECT_EQ((*tests)[0].sinkage_m.size(), 2U);
  EXPECT_NEAR((*tests)[0].pressure_pa[0], 100.0 / (3.14159265358979 * 0.01), 1e-6);
  EXPECT_FALSE(read_plate_tests_csv("p.csv", "plate_radius_m,sinkage_m\n0.1,0.01\n"));
}

SoilEstimateRequest plates() {
  SoilEstimateRequest request;
  gap::PlateRecord plate{0.05, {}, {}};
  for (int i = 1; i < 10; ++i) {
    plate.sinkage_m.push_back(0.004 * i);
    plate.pressure_pa.push_back(8e5 * std::pow(0.004 * i, 0.9));
  }
  request.data.plates = {plate};
  return request;
}

TEST(SoilEstimate, TheSoilIsAFileOfItsOwnThatIsReadAgain) {
  NoProgress progress;
  const auto answer = estimate_soil(*small_world().catalogue(), plates(), progress);
  ASSERT_TRUE(answer) << answer.error().detail;
  const auto soils = json::read_soil_file(json::estimated_soils_document(*answer));
  ASSERT_TRUE(soils) << soils.error().detail;
  ASSERT_EQ(soils->size(), 1U);
  EXPECT_NEAR(soils->front().mean.pressure.n, 0.9, 0.01);
  EXPECT_TRUE(soils->front().name.starts_with("unknown_ground-")) << soils->front().name;
  EXPECT_NE(draw_soil_estimate(answer->estimates.front()).find("<svg"), std::string::npos);
}

// Whatever is written is read back: at the end of a bound, under any name.
TEST(SoilEstimate, ASoilFoundAtABoundIsReadAgain) {
  NoProgress progress;
  for (const double bound : {0.05, 3.0}) {
    SoilEstimateRequest request = plates();
    const double n = bound < 1.0 ? 0.04 : 3.2;
    for (std::size_t i = 0; i < request.data.plates[0].sinkage_m.size(); ++i)
      request.data.plates[0].pressure_pa[i] = 8e5 * std::pow(request.data.plates[0].sinkage_m[i], n);
    request.options.priors = gap::SoilPriors::kNone;
    request.options.bounds = {{gap::SoilParameter::kN, bound < 1.0 ? 0.05 : 0.5, bound < 1.0 ? 2.0 : 3.0}};
    const auto answer = estimate_soil(*small_world().catalogue(), request, progress);
    ASSERT_TRUE(answer) << answer.error().detail;
    const auto soils = json::read_soil_file(json::estimated_soils_document(*answer));
    ASSERT_TRUE(soils) << soils.error().faults.front().message;
    EXPECT_NEAR(soils->front().mean.pressure.n, bound, 1e-3);
  }
}

TEST(SoilEstimate, ABoundThatNoSoilFileHoldsIsRefused) {
  NoProgress progress;
  SoilEstimateRequest request = plates();
  request.options.bounds = {{gap::SoilParameter::kN, 0.001, 4.0}};
  const auto answer = estimate_soil(*small_world().catalogue(), request, progress);
  ASSERT_FALSE(answer);
  ASSERT_EQ(answer.error().faults.size(), 2U);
  EXPECT_EQ(answer.error().faults[0].message, "n = 0.001, must be in [0.01, 3], which a soil's file holds");
}

TEST(SoilEstimate, ANameThatNoSoilFileTakesIsWrittenAsOneThatItTakes) {
  NoProgress progress;
  const std::string umlaut = "\xC3\xBC";
  const std::string name = "Lockere D" + umlaut + "nen, sehr tief";
  Catalogue catalogue = *small_world().catalogue();
  SoilEstimateRequest request = plates();
  // Summary and source end in the middle of an umlaut for one length or another.
  for (int lengthened = 0; lengthened < 3; ++lengthened) {
    std::string longer = name + std::string(static_cast<std::size_t>(lengthened), 'x');
    for (int k = 0; k < 250; ++k) longer += umlaut;
    catalogue.soils[longer] = catalogue.soils.at("unknown_ground");
    request.soil = longer;
    const auto answer = estimate_soil(catalogue, request, progress);
    ASSERT_TRUE(answer) << answer.error().detail;
    const auto soils = json::read_soil_file(json::estimated_soils_document(*answer));
    ASSERT_TRUE(soils) << soils.error().detail;
    EXPECT_TRUE(soils->front().name.starts_with("lockere_d_nen__sehr_tief")) << soils->front().name;
  }
}

TEST(SoilEstimate, TheSameRequestGivesTheSameBytes) {
  NoProgress progress;
  const auto a = estimate_soil(*small_world().catalogue(), plates(), progress);
  const auto b = estimate_soil(*small_world().catalogue(), plates(), progress);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(json::soil_estimate_document(*a), json::soil_estimate_document(*b));
}

// Two wheels over one soil, with what each has of its own.
SoilEstimateRequest two_wheels() {
  SoilEstimateRequest request;
  request.soil = "jlu_mars_2_dense";
  request.wheel.radius_m = 0.15;
  request.wheel.width_m = 0.16;
  request.wheels = {{"lugged",
                     {.rover = "",
                      .wheel = "",
                      .radius_m = {},
                      .width_m = 0.12,
                      .grousers = sim::Grousers{0.01, 24.0},
                      .motor_temp_c = {}}}};
  request.effects = {{.name = "smooth_rim@smooth", .parameters = {{"friction_share", 0.7}}}};
  request.set = {{"c1", 0.3}, {"smooth_rim.friction_share@smooth", 0.8}};
  for (const char* wheel : {"smooth", "lugged"}) {
    gap::WheelObservation o;
    o.wheel = wheel;
    o.test.load_n = 60.0;
    o[SoilChannel::kTorque].value = 1.0;
    request.data.wheels.push_back(o);
  }
  return request;
}

TEST(SoilTestRigs, EachWheelHasItsOwnNumbersAndEffects) {
  std::vector<Fault> faults;
  const SoilTestRigs rigs = soil_test_rigs(*small_world().catalogue(), two_wheels(), faults);
  ASSERT_EQ(faults, std::vector<Fault>{});
  ASSERT_EQ(rigs.data.rigs.size(), 2U);
  const auto on = [&](std::size_t rig) { return sim::conditions_of(rigs.data.rigs[rig].rig).wheel; };
  EXPECT_EQ(on(0).width_m, 0.16);
  EXPECT_EQ(on(0).rim_friction, 0.8);
  EXPECT_EQ(on(0).grousers.height_m, 0.0);
  EXPECT_EQ(on(1).width_m, 0.12);
  EXPECT_EQ(on(1).rim_friction, 1.0);
  EXPECT_EQ(on(1).grousers.height_m, 0.01);
  EXPECT_EQ(rigs.nominals[0].mean.c1, 0.3);
  EXPECT_EQ(rigs.stated.size(), 2U);
  EXPECT_EQ(rigs.data.wheels[1].rig, 1U);
}

TEST(SoilTestRigs, WhatWouldBeDroppedIsRefused) {
  const auto refused = [](const SoilEstimateRequest& request) {
    std::string pointers;
    for (const Fault& fault : faults_of(*small_world().catalogue(), request)) pointers += fault.pointer + " ";
    return pointers;
  };
  SoilEstimateRequest request = two_wheels();
  request.effects.push_back({.name = "grousers", .parameters = {}});
  EXPECT_EQ(refused(request), "/effects/1/name ");  // the lugged wheel's own would be lost
  request.effects.back().name = "grousers@smooth";
  EXPECT_EQ(refused(request), "");
  request.effects.back().name = "digging@rough";
  request.set.push_back({"c3", 1.0});
  request.set.push_back({"c2@lugged", 0.1});
  request.set.push_back({"n", 9.0});
  request.wheels.push_back({"toothed", {}});
  EXPECT_EQ(refused(request), "/effects/1/name /wheels/1/name /set/c3 /set/n /set/c2@lugged ");
  request = two_wheels();
  request.wheel.radius_m.reset();
  EXPECT_EQ(refused(request), "/radius_m /radius_m ");
  request = two_wheels();
  request.data.wheels[0].test.slip_angle_rad = 1.55;
  EXPECT_EQ(refused(request), "/wheel_tests/0/slip_angle_deg ");
  request.data.wheels[0].test.slip_definition = sim::SlipDefinition::kTravel;
  EXPECT_EQ(refused(request), "");
  request = two_wheels();
  request.data.wheels[0].wheel.clear();
  EXPECT_EQ(refused(request), "/wheel_tests /effects/0/name /set/smooth_rim.friction_share@smooth ");
}

TEST(SoilEstimate, WhatIsNotKnownIsRefusedTogether) {
  SoilEstimateRequest request = plates();
  request.soil = "chalk";
  request.wheel.rover = "tank";
  request.wheel.radius_m = 5.0;
  EXPECT_EQ(faults_of(*small_world().catalogue(), request).size(), 3U);
  EXPECT_EQ(choose_channels({"torque", "smell"}, request).size(), 1U);
}

}  // namespace
}  // namespace slipway::api
