#include "api/files/catalogue.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>

#include "api/files/rover_file.h"
#include "api/files/soil_file.h"
#include "api/files/stops.h"
#include "api/files/terrain_file.h"
#include "api/files/whole_file.h"
#include "api/json/writer.h"
#include "core/angle.h"
#include "core/random.h"
#include "small_world.h"

namespace slipway::api {
namespace {

using testing::copy_small_world;
using testing::file_bytes;
using testing::ScratchFolder;
using testing::small_world;
using testing::write_file;

TEST(ShippedSoils, HaveEveryRowOfThePapers) {
  const auto& soils = small_world().catalogue()->soils;
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
  for (const auto& [name, soil] : small_world().catalogue()->soils) {
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
  for (const auto& [name, soil] : small_world().catalogue()->soils) {
    EXPECT_FALSE(soil.source.empty()) << name;
    EXPECT_FALSE(soil.assumed.empty()) << name;
  }
}

TEST(ShippedRovers, SatisfyTheSimulator) {
  const auto& rovers = small_world().catalogue()->rovers;
  EXPECT_EQ(names_of(rovers), (std::vector<std::string>{"cuadriga", "fido-class", "m2020-class", "mer-class",
                                                        "msl-class", "zhurong-class"}));
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
  for (const auto& [name, rover] : small_world().catalogue()->rovers) {
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

TEST(ShippedSoils, AreServedAsTheFilesThatTheyCameFrom) {
  for (const auto& [name, soil] : small_world().catalogue()->soils) {
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
  write_file(folder.path() / "soils" / "gale_steps.json", "{");
  const auto catalogue = load_catalogue(folder.path());
  ASSERT_FALSE(catalogue);
  EXPECT_EQ(catalogue.error().code, ErrorCode::kUnreadableData);
  std::set<std::string> pointers;
  for (const Fault& fault : catalogue.error().faults) pointers.insert(fault.pointer);
  for (const char* expected : {"rovers#", "soils#", "rovers/broken.json#", "soils/gale_steps.json#"})
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

TEST(SoilFile, WhatABevameterDoesNotMeasureIsAssumedAndSaid) {
  const auto with = [](const std::string& more) {
    const auto soils = json::read_soil_file(
        R"({"format":"soils/1","soils":[{"name":"s","summary":"s","source":"s","k_c":1000,"k_phi":1.5e6,)"
        R"("n":1.1,"cohesion_pa":1000,"friction_angle_deg":30)" +
        more + "}]}");
    EXPECT_TRUE(soils) << (soils ? "" : soils.error().detail);
    return soils ? soils->front() : sim::SoilDistribution{};
  };
  const sim::SoilDistribution five = with("");
  EXPECT_EQ(five.mean.shear_modulus_x_m, 0.0152);
  EXPECT_EQ(five.mean.shear_modulus_y_m, 0.0152);
  EXPECT_EQ(five.mean.c1, 0.18);
  EXPECT_EQ(five.std.cohesion_pa, 300.0);
  EXPECT_EQ(five.std.shear_modulus_ratio, 0.5) << "K may be half or twice as large";
  EXPECT_EQ(five.slip_error, 0.5);
  EXPECT_EQ(five.assumed.size(), 7U);
  const sim::SoilDistribution six = with(R"(,"shear_modulus_x_m":0.02,"assumed":["n"])");
  EXPECT_EQ(six.std.shear_modulus_ratio, 0.25);
  EXPECT_EQ(six.slip_error, 0.0);
  EXPECT_EQ(six.assumed.size(), 6U);
  EXPECT_EQ(six.assumed.front(), "n");
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

// Another map in the place of the first is another version, also where both are large and have one size.
TEST(Catalogue, ATerrainsVersionIsOfWhatItsFilesHold) {
  const ScratchFolder folder;
  copy_small_world(folder.path());
  const auto yard = folder.path() / "terrains" / "yard", map = yard / "elevation.tif";
  std::filesystem::resize_file(map, 9'000'000);  // what follows the picture nobody reads
  const auto version_with = [&](std::streamoff from, std::size_t count) {
    std::fstream file(map, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(from);
    file << std::string(count, 'x');
    file.close();
    const auto site = TerrainSite::open(yard);
    return site ? (*site)->version() : site.error().detail;
  };
  std::set<std::string> versions{version_with(8'000'000, 0)};
  EXPECT_TRUE(versions.contains(version_with(8'000'000, 0)));
  EXPECT_TRUE(versions.insert(version_with(8'999'999, 1)).second);
  EXPECT_TRUE(versions.insert(version_with(5'000'000, 100'000)).second);
}

TEST(Catalogue, AnImportedMapThatIsAnotherNowIsNotRead) {
  const ScratchFolder folder;
  copy_small_world(folder.path());
  const auto yard = folder.path() / "terrains" / "yard", map = yard / "elevation.tif";
  const std::string bytes = testing::file_bytes(map);
  testing::write_file(
      yard / kDigestsFile,
      digests_document({TerrainFile{.name = "elevation.tif", .sha256 = sha256_of_file(map).value()}}));
  const auto site = TerrainSite::open(yard).value();
  const dem::Extent all = site->info().geometry.extent();
  EXPECT_TRUE(site->read(all));
  testing::write_file(map, bytes + " ");
  for (const auto& opened : {site, TerrainSite::open(yard).value()}) {
    const auto read = opened->read(all);
    ASSERT_FALSE(read);
    EXPECT_EQ(read.error().code, ErrorCode::kDamagedStore);
    EXPECT_EQ(read.error().detail,
              "elevation.tif of the terrain yard is not what was imported: import the terrain again");
    EXPECT_FALSE(opened->read_elevation(all));
    EXPECT_FALSE(opened->read_samples(all, 1));
    EXPECT_FALSE(opened->read_soils(all, opened->description().legends.front()));
  }
  testing::write_file(map, bytes);
  EXPECT_TRUE(site->read(all)) << "the same bytes, whoever wrote them";
  std::filesystem::remove(yard / kDigestsFile);
  testing::write_file(map, bytes + " ");
  EXPECT_TRUE(TerrainSite::open(yard).value()->read(all)) << "a terrain that was made by hand";
  testing::write_file(yard / kDigestsFile, "{}");
  EXPECT_FALSE(TerrainSite::open(yard));
}

}  // namespace
}  // namespace slipway::api
