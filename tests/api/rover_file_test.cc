#include "api/files/rover_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "api/files/model_fields.h"
#include "api/json/parse.h"
#include "api/json/writer.h"
#include "sim/rover/rover_field.h"
#include "small_world.h"

namespace slipway::api {
namespace {

using testing::small_world;

// The files' own form for what a rover may have besides.
TEST(RoverFile, ReadsOtherVehiclesAndGivesThemBackAsTheyWere) {
  json::Writer w;
  json::write_rover(w, *small_world().catalogue()->rovers.at("cuadriga"));
  const std::string rigid = w.take();
  const auto changed = [&](std::string_view what, std::string_view by) {
    std::string text = rigid;
    const std::size_t at = text.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    return text.replace(at, what.size(), by);
  };
  const std::string averaging =
      changed(R"("type":"rigid")", R"("type":"averaging","rocker_pivot_m":[0,0.2,0.3])");
  const std::string dead =
      changed(R"("steerable":false)",
              R"("grousers":{"height_m":0.01,"count":18},"steerable":false,"drive":"locked")");
  const std::string damped = changed(R"("max_wheel_rate)", R"("damping_nms_rad":0.0002,"max_wheel_rate)");
  const std::string sliced = changed(R"("suspension":)", R"("wheel_slices":5,"suspension":)");
  for (const std::string& text : {rigid, averaging, dead, damped, sliced}) {
    const auto rover = json::read_rover_file(text);
    ASSERT_TRUE(rover) << rover.error().detail;
    json::Writer again;
    json::write_rover(again, *rover);
    EXPECT_EQ(again.take(), text);
  }
  EXPECT_EQ(json::read_rover_file(sliced)->wheel_slices, 5);
  EXPECT_FALSE(json::read_rover_file(changed(R"("suspension":)", R"("wheel_slices":10,"suspension":)")));
  const auto rover = json::read_rover_file(dead);
  EXPECT_EQ(rover->wheels[0].drive, sim::WheelDrive::kLocked);
  EXPECT_EQ(rover->wheels[0].grousers->count, 18.0);
  EXPECT_EQ(rover->wheels[1].drive, sim::WheelDrive::kDriven);
}

TEST(RoverFile, GrousersOfTheRoverAreOnEveryWheelWithoutItsOwn) {
  json::Writer w;
  json::write_rover(w, *small_world().catalogue()->rovers.at("cuadriga"));
  std::string text = w.take();
  text.replace(text.find(R"("wheels":)"), 9, R"("grousers":{"height_m":0.02,"count":24},"wheels":)");
  const auto rover = json::read_rover_file(text);
  ASSERT_TRUE(rover) << rover.error().detail;
  for (const sim::WheelModel& wheel : rover->wheels) EXPECT_EQ(wheel.grousers->height_m, 0.02);
}

// A rover as served, with parts of its text replaced in turn.
std::string rover_with(const char* name,
                       const std::vector<std::pair<std::string_view, std::string_view>>& changes) {
  json::Writer w;
  json::write_rover(w, *small_world().catalogue()->rovers.at(name));
  std::string text = w.take();
  for (const auto& [what, by] : changes) {
    const std::size_t at = text.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    text.replace(at, what.size(), by);
  }
  return text;
}

TEST(RoverFile, WhatTheDynamicRungReadsComesBackAsItWas) {
  const std::string text = rover_with(
      "mer-class",
      {{R"("wheels":)",
        R"("masses":{"wheel_kg":5.5,"rocker_kg":6.25,"bogie_kg":3,"body_inertia_kg_m2":[20,30,35.5]},"wheels":)"},
       {R"("bogie_wheels":["m","r"])",
        R"("bogie_wheels":["m","r"],"differential_stiffness_nm_per_deg":1200.5,"differential_damping_nms_per_deg":11,"rocker_stop_deg":30,"bogie_stop_deg":45.5)"},
       {R"(},"power")",
        R"(,"rotor_inertia_kg_m2":1e-06},"steering":{"torque_constant_nm_per_a":0.01,"gear_ratio":4000,"gear_efficiency":0.5,"no_load_current_a":0.02,"max_wheel_rate_deg_s":20,"bus_voltage_v":28},"power")"}});
  const auto rover = json::read_rover_file(text);
  ASSERT_TRUE(rover) << rover.error().detail;
  EXPECT_EQ(rover->masses.wheel_kg, 5.5);
  EXPECT_EQ(rover->masses.rocker_kg, 6.25);
  EXPECT_EQ(rover->masses.bogie_kg, 3.0);
  EXPECT_EQ(*rover->masses.body_inertia_kg_m2, Eigen::Vector3d(20.0, 30.0, 35.5));
  EXPECT_NEAR(*rover->suspension.differential_stiffness_nm_rad, 1200.5 * deg_from_rad(1.0), 1e-9);
  EXPECT_NEAR(*rover->suspension.differential_damping_nms_rad, 11.0 * deg_from_rad(1.0), 1e-9);
  EXPECT_DOUBLE_EQ(*rover->suspension.rocker_stop_rad, rad_from_deg(30.0));
  EXPECT_DOUBLE_EQ(*rover->suspension.bogie_stop_rad, rad_from_deg(45.5));
  EXPECT_EQ(rover->drive.rotor_inertia_kg_m2, 1e-6);
  ASSERT_TRUE(rover->steering);
  EXPECT_EQ(rover->steering->gear_ratio, 4000.0);
  json::Writer again;
  json::write_rover(again, *rover);
  EXPECT_EQ(again.take(), text);
}

TEST(RoverFile, WhatTheDynamicRungReadsIsReadStrictly) {
  const auto pointers = [](const std::string& text) {
    std::set<std::string> all;
    const auto rover = json::read_rover_file(text);
    EXPECT_FALSE(rover);
    if (!rover)
      for (const Fault& fault : rover.error().faults) all.insert(fault.pointer);
    return all;
  };
  EXPECT_EQ(
      pointers(rover_with(
          "mer-class",
          {{R"("wheels":)",
            R"("masses":{"wheel_kg":0,"rocker":6,"body_inertia_kg_m2":[1,2]},"steering":{"gear_ratio":0.5},"wheels":)"},
           {R"("bogie_wheels":["m","r"])", R"("bogie_wheels":["m","r"],"rocker_stop_deg":120)"}})),
      (std::set<std::string>{
          "/masses/wheel_kg", "/masses/rocker", "/masses/body_inertia_kg_m2", "/suspension/rocker_stop_deg",
          "/steering/torque_constant_nm_per_a", "/steering/gear_ratio", "/steering/gear_efficiency",
          "/steering/no_load_current_a", "/steering/max_wheel_rate_deg_s", "/steering/bus_voltage_v"}));
  EXPECT_EQ(
      pointers(rover_with("cuadriga", {{R"("type":"rigid")", R"("type":"rigid","rocker_stop_deg":20)"}})),
      std::set<std::string>{"/suspension/rocker_stop_deg"})
      << "a rigid suspension has no rocker to stop";
  EXPECT_EQ(pointers(rover_with("mer-class", {{R"("wheels":)", R"("masses":{"wheel_kg":27},"wheels":)"}})),
            std::set<std::string>{"/masses"})
      << "nothing would be left of the body";
}

TEST(RoverFile, FaultsOfTheNewKeysAreAllNamed) {
  json::Writer w;
  json::write_rover(w, *small_world().catalogue()->rovers.at("cuadriga"));
  std::string text = w.take();
  const auto change = [&](std::string_view what, std::string_view by) {
    text.replace(text.find(what), what.size(), by);
  };
  change(R"("type":"rigid")", R"("type":"rigid","rocker_pivot_m":[0,0.2,0.3])");
  change(R"("steerable":false)", R"("steerable":false,"drive":"broken")");
  change(R"("name":"lf")", R"("name":"the_left_front_one")");
  const auto rover = json::read_rover_file(text);
  ASSERT_FALSE(rover);
  std::set<std::string> pointers;
  for (const Fault& fault : rover.error().faults) pointers.insert(fault.pointer);
  EXPECT_EQ(pointers,
            (std::set<std::string>{"/wheels/0/name", "/wheels/0/drive", "/suspension/rocker_pivot_m"}));
}

// Every row of the rover's tables, at both ends of its range.
template <class Owner>
void expect_read_back(std::span<const ModelField<Owner>> fields) {
  for (const bool highest : {false, true}) {
    Owner out{};
    for (const ModelField<Owner>& row : fields) {
      const double value = row.from_boundary(highest ? row.field.highest : row.field.lowest);
      if (row.maybe != nullptr)
        row.maybe(out) = value;
      else
        row.number(out) = value;
    }
    std::vector<Fault> faults;
    sim::check_fields<Owner>(fields, out, "", faults);
    EXPECT_TRUE(faults.empty()) << faults.front().message;
    json::Writer w;
    json::write_fields<Owner>(w.begin_object(), fields, out);
    const auto document = json::parse(w.end_object().take());
    ASSERT_TRUE(document);
    json::ObjectReader reader(*document, "", faults);
    Owner in{};
    json::read_fields<Owner>(reader, fields, json::kRequired, in);
    reader.refuse_unknown();
    EXPECT_TRUE(faults.empty()) << faults.front().message;
    for (const ModelField<Owner>& row : fields) {
      const double was = row.maybe ? *row.maybe(out) : row.number(out),
                   is = row.maybe ? *row.maybe(in) : row.number(in);
      EXPECT_NEAR(is, was, 1e-11 * std::abs(was)) << row.field.name;
    }
  }
}

TEST(RoverFields, AreReadAndWrittenOverTheirWholeRange) {
  expect_read_back(sim::mass_fields());
  expect_read_back(sim::part_mass_fields());
  expect_read_back(sim::wheel_fields());
  expect_read_back(sim::grouser_fields());
  expect_read_back(sim::differential_fields());
  expect_read_back(sim::bogie_fields());
  expect_read_back(sim::motor_fields());
  expect_read_back(sim::closure_fields());
  expect_read_back(sim::body_fields());
}

}  // namespace
}  // namespace slipway::api
