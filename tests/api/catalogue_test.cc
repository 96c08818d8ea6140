#include "api/files/catalogue.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "api/files/model_fields.h"
#include "api/files/rover_file.h"
#include "api/files/soil_file.h"
#include "api/files/stops.h"
#include "api/files/terrain_file.h"
#include "api/json/parse.h"
#include "api/json/writer.h"
#include "core/angle.h"
#include "core/random.h"
#include "sim/rover/rover_field.h"
#include "small_world.h"

namespace slipway::api {
namespace {

using testing::copy_small_world;
using testing::file_bytes;
using testing::ScratchFolder;
using testing::small_world;
using testing::write_file;

TEST(ShippedSoils, HaveEveryRowOfThePapers) {
  const auto& soils = small_world().catalogue().soils;
  for (const char* name :
       {"jlu_mars_1_loose", "jlu_mars_1_medium", "jlu_mars_1_dense",  "jlu_mars_2_loose", "jlu_mars_2_medium",
        "jlu_mars_2_dense", "jlu_mars_3_loose",  "jlu_mars_3_medium", "jlu_mars_3_dense", "vl1_drift",
        "vl1_blocky",       "vl2_crusty_cloddy", "mpf_drift",         "mpf_cloddy",       "mer_a_loose",
        "mer_a_dense",      "mer_b_slope_soil",  "mer_b_sandy_loam",  "msl_bedrock",      "dry_sand",
        "sandy_loam",       "clayey_soil",       "artemis_dry_sand",  "ding_2011",        "cross_check",
        "unknown_ground"}) {
    EXPECT_TRUE(soils.contains(name)) << name;
  }
  const sim::SoilDistribution& drift = soils.at("mpf_drift");
  EXPECT_EQ(drift.mean.cohesion_pa, 380.0);
  EXPECT_EQ(drift.std.cohesion_pa, 200.0);
  EXPECT_NEAR(deg_from_rad(drift.std.friction_angle_rad), 8.0, 1e-12);
  EXPECT_EQ(soils.at("jlu_mars_2_dense").mean.pressure.k_phi, 7432759.0);
  EXPECT_EQ(soils.at("artemis_dry_sand").mean.pressure.k_c, 6940.0);
}

TEST(ShippedSoils, CarryLoadAtEveryDepthAndDraw) {
  for (const auto& [name, soil] : small_world().catalogue().soils) {
    SCOPED_TRACE(name);
    for (std::uint64_t draw = 0; draw < 50; ++draw) {
      sim::SoilNormals normals;
      for (int i = 0; i < sim::kSoilDims; ++i) {
        normals[i] = random_normal(draw, static_cast<std::uint64_t>(i));
      }
      const sim::Soil drawn = sim::draw_soil(soil, normals);
      double last = 0.0;
      for (const double z : {0.001, 0.01, 0.05, 0.1}) {
        const double pressure = drawn.pressure.stiffness(0.16) * std::pow(z, drawn.pressure.n);
        EXPECT_GT(pressure, last) << "at " << z << " m";
        last = pressure;
      }
      EXPECT_GE(drawn.cohesion_pa, 0.0);
      EXPECT_GT(drawn.friction_angle_rad, 0.0);
      EXPECT_LT(drawn.friction_angle_rad, 1.3);
      EXPECT_GT(drawn.shear_modulus_x_m, 0.0);
    }
  }
}

TEST(ShippedSoils, SayWhereTheyComeFromAndWhatIsAssumed) {
  for (const auto& [name, soil] : small_world().catalogue().soils) {
    EXPECT_FALSE(soil.source.empty()) << name;
    EXPECT_FALSE(soil.assumed.empty()) << name;
  }
}

TEST(ShippedRovers, SatisfyTheSimulator) {
  const auto& rovers = small_world().catalogue().rovers;
  EXPECT_EQ(names_of(rovers),
            (std::vector<std::string>{"cuadriga", "fido-class", "mer-class", "msl-class", "zhurong-class"}));
  for (const auto& [name, rover] : rovers) {
    EXPECT_EQ(sim::faults_of(*rover), std::vector<Fault>{}) << name;
    const double fastest = rover->drive.max_wheel_rate_rad_s * rover->smallest_wheel_radius_m();
    EXPECT_LE(rover->cruise_speed_m_s, fastest) << name;
    EXPECT_LE(
        rover->turn_rate_rad_s * 0.5 * std::hypot(rover->track_m(), 2.0 * rover->wheels[0].position_m.x()),
        fastest)
        << name << " can turn in place at its rate";
  }
}

TEST(ShippedRovers, AreServedAsTheFilesThatTheyCameFrom) {
  for (const auto& [name, rover] : small_world().catalogue().rovers) {
    json::Writer w;
    json::write_rover(w, *rover);
    const std::string served = w.take();
    const auto again = json::read_rover_file(served);
    ASSERT_TRUE(again) << again.error().detail;
    json::Writer w2;
    json::write_rover(w2, *again);
    EXPECT_EQ(w2.take(), served);
  }
}

// The files' own form for what a rover may have besides.
TEST(RoverFile, ReadsOtherVehiclesAndGivesThemBackAsTheyWere) {
  json::Writer w;
  json::write_rover(w, *small_world().catalogue().rovers.at("cuadriga"));
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
  json::write_rover(w, *small_world().catalogue().rovers.at("cuadriga"));
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
  json::write_rover(w, *small_world().catalogue().rovers.at(name));
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
       {R"(},"belly_clearance_m")",
        R"(,"rotor_inertia_kg_m2":1e-06},"steering":{"torque_constant_nm_per_a":0.01,"gear_ratio":4000,"gear_efficiency":0.5,"no_load_current_a":0.02,"max_wheel_rate_deg_s":20,"bus_voltage_v":28},"belly_clearance_m")"}});
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
  json::write_rover(w, *small_world().catalogue().rovers.at("cuadriga"));
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

TEST(ShippedSoils, AreServedAsTheFilesThatTheyCameFrom) {
  for (const auto& [name, soil] : small_world().catalogue().soils) {
    json::Writer w;
    json::write_soil(w, soil);
    const std::string served = w.take();
    const auto again = json::read_soil_file(R"({"format":"soils/1","soils":[)" + served + "]}");
    ASSERT_TRUE(again) << name << ": " << again.error().detail;
    json::Writer w2;
    json::write_soil(w2, again->front());
    EXPECT_EQ(w2.take(), served);
  }
}

std::set<std::string> pointers_of(const std::vector<LeftOutFile>& files) {
  std::set<std::string> pointers;
  for (const LeftOutFile& file : files)
    for (const Fault& fault : file.faults) pointers.insert(fault.pointer);
  return pointers;
}

void name_a_soil_wrongly(const std::filesystem::path& terrain) {
  std::string text = file_bytes(terrain);
  text.replace(text.find("mpf_drift"), 9, "mpf_drfit");
  write_file(terrain, text);
}

TEST(Catalogue, LeavesOutFilesWithFaultsAndUsesTheOthers) {
  const ScratchFolder folder;
  copy_small_world(folder.path());
  const auto all = load_catalogue(folder.path());
  ASSERT_TRUE(all);
  EXPECT_TRUE(all->left_out.empty());
  write_file(folder.path() / "rovers" / "broken.json", R"({"format":"rover/1","mass_kg":-3})");
  write_file(folder.path() / "soils" / "broken.json", "{");
  std::filesystem::create_directories(folder.path() / "rules");
  write_file(folder.path() / "rules" / "broken.json", "[]");
  const auto moon = folder.path() / "terrains" / "moon";
  std::filesystem::create_directories(moon);
  write_file(
      moon / "terrain.json",
      R"({"format":"terrain/1","name":"moon","title":"t","elevation":"../yard/elevation.tif","gravity_m_s2":1.6})");
  const auto catalogue = load_catalogue(folder.path());
  ASSERT_TRUE(catalogue) << catalogue.error().detail;
  EXPECT_EQ(names_of(catalogue->rovers), names_of(all->rovers));
  EXPECT_EQ(names_of(catalogue->soils), names_of(all->soils));
  EXPECT_EQ(names_of(catalogue->rules), names_of(all->rules));
  EXPECT_EQ(names_of(catalogue->terrains), names_of(all->terrains));
  EXPECT_EQ(catalogue->left_out.size(), 4u);
  const std::set<std::string> pointers = pointers_of(catalogue->left_out);
  for (const char* expected :
       {"rovers/broken.json#/mass_kg", "rovers/broken.json#/wheels", "soils/broken.json#",
        "rules/broken.json#", "terrains/moon/terrain.json#/elevation"}) {
    EXPECT_TRUE(pointers.contains(expected)) << expected;
  }
  EXPECT_TRUE(
      unknown_rover(*catalogue, "broken").ends_with("rovers/broken.json is left out, since it has faults"))
      << unknown_rover(*catalogue, "broken");
}

TEST(Catalogue, ALegendNamesSoilsThatExist) {
  const ScratchFolder folder;
  copy_small_world(folder.path());
  name_a_soil_wrongly(folder.path() / "terrains" / "yard" / "terrain.json");
  const auto catalogue = load_catalogue(folder.path());
  ASSERT_TRUE(catalogue);
  EXPECT_FALSE(catalogue->terrains.contains("yard"));
  ASSERT_EQ(catalogue->left_out.size(), 1u);
  const Fault& fault = catalogue->left_out.front().faults.front();
  EXPECT_EQ(fault.pointer, "terrains/yard/terrain.json#/soil/legend/1/soil");
  EXPECT_TRUE(fault.message.starts_with("unknown soil \"mpf_drfit\"; did you mean \"mpf_drift\"?"));
}

TEST(Catalogue, WithoutARoverOrTheSoilOfUnknownGroundThereIsNone) {
  const ScratchFolder folder;
  copy_small_world(folder.path());
  std::filesystem::remove_all(folder.path() / "rovers");
  std::filesystem::create_directories(folder.path() / "rovers");
  write_file(folder.path() / "rovers" / "broken.json", "{");
  write_file(folder.path() / "soils" / "unknown_ground.json", "{");
  const auto catalogue = load_catalogue(folder.path());
  ASSERT_FALSE(catalogue);
  EXPECT_EQ(catalogue.error().code, ErrorCode::kUnreadableData);
  std::set<std::string> pointers;
  for (const Fault& fault : catalogue.error().faults) pointers.insert(fault.pointer);
  for (const char* expected : {"rovers#", "soils#", "rovers/broken.json#", "soils/unknown_ground.json#"})
    EXPECT_TRUE(pointers.contains(expected)) << expected;
}

TEST(Catalogue, ATerrainsFilesAreBesideItAndNoLinks) {
  for (const char* name :
       {"/etc/passwd", "../yard/elevation.tif", "/vsicurl/x.tif", ".hidden", "a/b.tif", "-x"}) {
    const auto terrain = json::read_terrain_file(
        std::string(R"({"format":"terrain/1","name":"n","title":"t","gravity_m_s2":1,"elevation":")") + name +
        "\"}");
    ASSERT_FALSE(terrain) << name;
    EXPECT_EQ(terrain.error().faults.front().pointer, "/elevation");
  }
  const ScratchFolder folder;
  copy_small_world(folder.path());
  const auto yard = folder.path() / "terrains" / "yard";
  std::filesystem::rename(yard / "elevation.tif", folder.path() / "elsewhere.tif");
  std::filesystem::create_symlink(folder.path() / "elsewhere.tif", yard / "elevation.tif");
  EXPECT_FALSE(TerrainSite::open(yard)) << "a link leads out of the folder";
}

TEST(SoilFile, ChecksWhatHoldsBetweenTheNumbers) {
  const auto with = [](const std::string& k_phi, const std::string& cohesion, const std::string& more) {
    return json::read_soil_file(
        R"({"format":"soils/1","soils":[{"name":"s","summary":"s","source":"s","assumed":[],"k_c":-110000,"k_phi":)" +
        k_phi + R"(,"n":1.2,"cohesion_pa":)" + cohesion +
        R"(,"friction_angle_deg":24,"shear_modulus_x_m":0.01,"density_kg_m3":1500,"c1":0.4,"c2":0.2,)"
        R"("std":{"stiffness_ratio":0.1,"n":0,"cohesion_pa":10,"friction_angle_deg":1,"shear_modulus_ratio":0},)" +
        more + R"("correlation_length_m":5}]})");
  };
  EXPECT_TRUE(with("2300000", "2495", "")) << "a fit may make k_c negative";
  EXPECT_EQ(with("200000", "2495", "").error().faults.front().pointer, "/soils/0/k_phi");
  EXPECT_EQ(with("2300000", "0", "").error().faults.front().pointer, "/soils/0/std");
  const std::string triangle =
      R"("correlation":[{"first":"n","second":"cohesion","value":0.9},{"first":"n","second":"friction_angle","value":0.9},)"
      R"({"first":"cohesion","second":"friction_angle","value":-0.9}],)";
  EXPECT_EQ(with("2300000", "2495", triangle).error().faults.front().pointer, "/soils/0/correlation");
}

TEST(SoilFile, TheClosuresHaveACorrelationOfTheirOwnThatIsWrittenAgain) {
  const auto with = [](const std::string& pair) {
    return json::read_soil_file(
        R"({"format":"soils/1","soils":[{"name":"s","summary":"s","source":"s","assumed":[],"k_c":0,"k_phi":1e6,)"
        R"("n":1,"cohesion_pa":500,"friction_angle_deg":24,"shear_modulus_x_m":0.01,"density_kg_m3":1500,)"
        R"("c1":0.4,"c2":0.2,"std":{"stiffness_ratio":0,"n":0,"cohesion_pa":0,"friction_angle_deg":0,)"
        R"("shear_modulus_ratio":0,"c1":0.1,"c2":0.1},"correlation":[{)" +
        pair + R"(}],"correlation_length_m":5}]})");
  };
  const auto soils = with(R"("first":"c1","second":"c2","value":-0.4)");
  ASSERT_TRUE(soils);
  EXPECT_EQ(soils->front().closure_correlation, -0.4);
  EXPECT_TRUE(soils->front().correlation.isIdentity());
  json::Writer w;
  w.begin_object().text("format", "soils/1").key("soils").begin_array();
  json::write_soil(w, soils->front());
  w.end_array().end_object();
  const auto again = json::read_soil_file(w.take());
  ASSERT_TRUE(again);
  EXPECT_EQ(again->front().closure_correlation, -0.4);
  EXPECT_EQ(with(R"("first":"c1","second":"c2","value":1)").error().faults.front().pointer,
            "/soils/0/correlation/0/value");
  EXPECT_EQ(with(R"("first":"n","second":"c2","value":0.1)").error().faults.front().pointer,
            "/soils/0/correlation/0/second");
}

TEST(Stops, NameRowAndColumnOfEachFault) {
  const auto stops = read_stops("sol,x_m,y_m\n1,2.5,3\n2,x,nan\n3,1\n");
  ASSERT_FALSE(stops);
  ASSERT_EQ(stops.error().faults.size(), 3U);
  EXPECT_EQ(stops.error().faults[0], (Fault{"/3/x_m", "row 3: x_m = \"x\", must be a number in m"}));
  EXPECT_EQ(stops.error().faults[1].pointer, "/3/y_m");
  EXPECT_EQ(stops.error().faults[2], (Fault{"/4", "row 4 has 2 cells, the header has 3"}));
  EXPECT_FALSE(read_stops("sol,x_m\n1,2\n"));
  const auto good = read_stops("sol,x_m,y_m\r\n1,2.5,3\r\n");
  ASSERT_TRUE(good);
  EXPECT_EQ(good->front().x_m, 2.5);
  EXPECT_EQ(good->front().columns.front(), (std::pair<std::string, std::string>{"sol", "1"}));
}

}  // namespace
}  // namespace slipway::api
