#include "campaign/drive_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "api/files/drive_table/campaign_source.h"
#include "core/angle.h"
#include "tables.h"

namespace slipway::campaign {
namespace {

using Texts = std::vector<std::string>;

Texts pointers_of(const Error& error) {
  Texts pointers;
  for (const Fault& fault : error.faults) pointers.push_back(fault.pointer);
  return pointers;
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), by);
}

TEST(DriveTable, ExpandsTerrainsHeadingsAndRepeats) {
  const auto table = read_table(kSmallTable);
  ASSERT_TRUE(table) << table.error().detail;
  std::vector<std::string> ids;
  for (const TableDrive& drive : expand(*table)) ids.push_back(drive.id);
  EXPECT_EQ(ids, (Texts{"ahead-level-h000-r1", "ahead-level-h000-r2", "ahead-level-h090-r1",
                        "ahead-level-h090-r2", "ahead-slope-h000-r1", "ahead-slope-h000-r2",
                        "ahead-slope-h090-r1", "ahead-slope-h090-r2", "turn", "both"}));
  const std::vector<TableDrive> drives = expand(*table);
  EXPECT_EQ(drives[0].repeat_of, "");
  EXPECT_EQ(drives[3].repeat_of, "ahead-level-h090-r1");
  EXPECT_NEAR(drives[3].start.yaw_rad, rad_from_deg(90.0), 1e-12);
  EXPECT_EQ(drives[4].terrain, 1U);
}

TEST(DriveTable, NamesWhoseFilesCollideAreRefused) {
  struct Collision {
    std::string what, by, pointer, file;
  };
  for (const Collision& c : {
           Collision{R"("id": "turn")", R"("id": "both-leg1")", "/drives/2/id", "both-leg1.csv"},
           Collision{R"("id": "both")", R"("id": "slope-x")", "", ""},
           Collision{R"("name": "level")", R"("name": "both-deformed")", "/drives/2/id", "both-deformed.tif"},
           Collision{R"("id": "turn", "terrains": ["level"],)",
                     R"("id": "final_poses", "plot": true, "terrains": ["level"],)", "/drives/1/id",
                     "plots/final_poses.svg"},
       }) {
    std::string text = replaced(kSmallTable, c.what, c.by);
    if (c.by.find("both-deformed") != std::string::npos)
      while (text.find("\"level\"") != std::string::npos)
        text = replaced(text, "\"level\"", "\"both-deformed\"");
    const auto table = read_table(text);
    if (c.file.empty()) {
      EXPECT_TRUE(table) << table.error().detail;
      continue;
    }
    ASSERT_FALSE(table) << c.file;
    EXPECT_EQ(table.error().code, ErrorCode::kInvalidRequest);
    EXPECT_EQ(pointers_of(table.error()), Texts{c.pointer});
    EXPECT_NE(table.error().faults[0].message.find("would both be written to " + c.file), std::string::npos)
        << table.error().faults[0].message;
  }
}

TEST(DriveTable, AnIdIsMadeOfLettersDigitsAndHyphensWhateverTheHeading) {
  const auto table = read_table(replaced(kSmallTable, "[0, 90]", "[10.00001, 10.5]"));
  ASSERT_TRUE(table) << table.error().detail;
  EXPECT_EQ(expand(*table)[0].id, "ahead-level-h010p00001-r1");
  EXPECT_EQ(expand(*table)[2].id, "ahead-level-h010p5-r1");
}

TEST(DriveTable, LegsTakeTheRoversSpeedsAndTheCommandsSigns) {
  const auto table = read_table(kSmallTable);
  ASSERT_TRUE(table);
  const sim::DriveLeg& back = table->entries[2].legs[0];
  EXPECT_DOUBLE_EQ(back.command.speed_m_s, -table->rover->cruise_speed_m_s);
  EXPECT_DOUBLE_EQ(back.command.curvature_1_m, 0.5);
  const sim::DriveLeg& right = table->entries[1].legs[0];
  EXPECT_TRUE(right.command.turn_in_place);
  EXPECT_DOUBLE_EQ(right.command.turn_rate_rad_s, -table->rover->turn_rate_rad_s);
  EXPECT_NEAR(right.turn_rad, rad_from_deg(10.0), 1e-12);
}

TEST(DriveTable, HeadingsThatAreNotWholeAreToldApart) {
  const auto table = read_table(replaced(kSmallTable, "[0, 90]", "[22.5, -90]"));
  ASSERT_TRUE(table) << table.error().detail;
  EXPECT_EQ(expand(*table)[0].id, "ahead-level-h022p5-r1");
  EXPECT_EQ(expand(*table)[2].id, "ahead-level-h270-r1");
}

TEST(DriveTable, NamesEveryFaultOfItsPartsTogether) {
  const auto table = read_table(R"({
    "format": "campaign-table/1", "name": "Not a name", "summary": "s", "sources": [], "rover": "fido",
    "gravity_m_s2": 0, "sensors": {"position_m": {"noise": -1}, "sonar_m": {}}, "simulation": {"feedback": "eyes"},
    "terrains": [{"name": "a", "soil": "dry_sandd"}, {"name": "a", "soil": "dry_sand", "tilt_deg": 80},
                 {"name": "b", "soil": "dry_sand", "file": "../b.tif"}, {"name": "c", "soil": "dry_sand", "file": "none.tif"}],
    "drives": [{"id": "x", "terrains": ["z"], "headings_deg": [], "repeats": 0, "legs": [{"length_m": 0}, {"turn_deg": 0}],
                "failed_wheels": {"rf": "broken"}}, {"id": "y", "legs": [], "lege": 1}]})");
  ASSERT_FALSE(table);
  EXPECT_EQ(table.error().code, ErrorCode::kInvalidRequest);
  Texts pointers = pointers_of(table.error());
  std::sort(pointers.begin(), pointers.end());
  Texts wanted{"/name",
               "/rover",
               "/gravity_m_s2",
               "/sensors/position_m/noise",
               "/sensors/sonar_m",
               "/simulation/feedback",
               "/terrains/0/soil",
               "/terrains/1/name",
               "/terrains/1/tilt_deg",
               "/terrains/2/file",
               "/terrains/3/file",
               "/drives/0/terrains/0",
               "/drives/0/headings_deg",
               "/drives/0/repeats",
               "/drives/0/legs/0/length_m",
               "/drives/0/legs/1/turn_deg",
               "/drives/0/failed_wheels/rf",
               "/drives/1/legs",
               "/drives/1/lege"};
  std::sort(wanted.begin(), wanted.end());
  EXPECT_EQ(pointers, wanted);
}

TEST(DriveTable, NamesEveryFaultBetweenItsPartsTogether) {
  std::string bytes =
      replaced(kSmallTable, R"("id": "both")", R"("id": "turn", "failed_wheels": {"xx": "free"})");
  bytes = replaced(bytes, R"("id": "ahead",)", R"("id": "ahead", "start": {"x_m": 40, "y_m": 0},)");
  bytes = replaced(bytes, R"("seed": 7,)",
                   R"("seed": 7, "effects": [{"name": "soft_patch", "parameters": {"x_m": 0, "y_m": 0}}],)");
  const auto table = read_table(bytes);
  ASSERT_FALSE(table);
  // The start is off both terrains.
  EXPECT_EQ(pointers_of(table.error()), (Texts{"/effects/0/name", "/drives/0/start", "/drives/0/start",
                                               "/drives/2/failed_wheels/xx", "/drives/2/id"}));
  EXPECT_NE(table.error().faults[3].message.find("lf, lm, lr"), std::string::npos);
}

TEST(DriveTable, ARoverThatDoesNotSteerDoesNotCrab) {
  const std::string crabs = replaced(kSmallTable, R"("legs": [{"length_m": 0.3}])",
                                     R"("legs": [{"length_m": 0.3}, {"length_m": 0.3, "crab_deg": 40}])");
  EXPECT_TRUE(read_table(crabs));
  EXPECT_TRUE(read_table(replaced(crabs, "fido-class", "mer-class"))) << "drags its middle wheels";
  const auto table = read_table(replaced(crabs, "fido-class", "cuadriga"));
  ASSERT_FALSE(table);
  ASSERT_EQ(pointers_of(table.error()), Texts{"/drives/0/legs/1/crab_deg"});
  const std::string& message = table.error().faults[0].message;
  for (const sim::WheelModel& wheel : shipped_catalogue().rovers.find("cuadriga")->second->wheels)
    EXPECT_NE(message.find(wheel.name), std::string::npos) << message;
}

TEST(DriveTable, FailedWheelsAndEffectsAreTheDrivesNotTheOperators) {
  const std::string bytes = replaced(
      replaced(kSmallTable, R"("id": "turn",)", R"("id": "turn", "failed_wheels": {"rf": "locked"},)"),
      R"("seed": 7,)", R"("seed": 7, "effects": [{"name": "grousers", "parameters": {"height_m": 0.01}}],)");
  const auto table = read_table(bytes);
  ASSERT_TRUE(table) << table.error().detail;
  const sim::RoverModel rover = driven_rover(*table, table->entries[1]);
  EXPECT_EQ(rover.wheels[3].drive, sim::WheelDrive::kLocked);
  EXPECT_TRUE(rover.wheels[0].grousers.has_value());
  EXPECT_EQ(table->rover->wheels[3].drive, sim::WheelDrive::kDriven);
  EXPECT_FALSE(table->rover->wheels[0].grousers.has_value());
}

TEST(DriveTable, WheelsFailAsInRequests) {
  const auto table =
      read_table(replaced(kSmallTable, R"("id": "turn",)",
                          R"("id": "turn", "failed_wheels": {"rf": "off", "lm": "free", "lr": "locked"},)"));
  ASSERT_TRUE(table) << table.error().detail;
  const sim::RoverModel rover = driven_rover(*table, table->entries[1]);
  for (const sim::WheelModel& wheel : rover.wheels) {
    const bool off = wheel.name == "rf";
    EXPECT_EQ(wheel.drive, off || wheel.name == "lm" ? sim::WheelDrive::kFree
                           : wheel.name == "lr"      ? sim::WheelDrive::kLocked
                                                     : sim::WheelDrive::kDriven);
    EXPECT_EQ(wheel.drag_nm, off ? sim::unpowered_drag_nm(rover.drive) : 0.0) << wheel.name;
  }
}

TEST(DriveTable, AnElevationFileMayHaveASoilMap) {
  const std::string bytes = R"({
    "format": "campaign-table/1", "name": "gale", "summary": "s", "sources": [], "rover": "msl-class",
    "gravity_m_s2": 3.71, "terrains": [{"name": "gale", "soil": "dry_sand", "file": "elevation.tif",
      "soil_map": {"file": "terrain_class.tif", "classes": [{"value": 1, "soil": "mpf_cloddy"}, {"value": 3, "soil": "mpf_drift"}]}}],
    "drives": [{"id": "a", "start": {"x_m": 8142579.7, "y_m": -276648.7}, "legs": [{"length_m": 0.2}]}]})";
  const std::filesystem::path folder = std::filesystem::path(SLIPWAY_DATA_FOLDER) / "terrains/gale";
  const auto table = api::json::read_campaign_table(bytes, folder, shipped_catalogue());
  ASSERT_TRUE(table) << table.error().detail;
  const TableTerrain& terrain = table->terrains[0];
  EXPECT_EQ(soils_of(terrain), (Texts{"mpf_cloddy", "mpf_drift", "dry_sand"}));
  EXPECT_EQ(class_elsewhere(terrain), 0);
  const auto twice = api::json::read_campaign_table(replaced(bytes, R"("value": 3)", R"("value": 1)"), folder,
                                                    shipped_catalogue());
  ASSERT_FALSE(twice);
  EXPECT_TRUE(twice.error().faults.back().pointer.starts_with("/terrains/0/soil_map/classes/"));
  // A shape has no system that a raster could be in.
  EXPECT_FALSE(read_table(replaced(kSmallTable, R"("tilt_deg": 5,)", R"("tilt_deg": 5, "soil_map": {},)")));
}

TEST(DriveTable, RocksStandOnAShape) {
  const auto with_rocks = [](const char* rocks) {
    return read_table(replaced(kSmallTable, R"("tilt_deg": 5,)",
                               std::string(R"("tilt_deg": 5, "cell_m": 0.05, "rocks": )") + rocks + ","));
  };
  const auto ground = [&](const char* rocks) {
    const auto table = with_rocks(rocks);
    EXPECT_TRUE(table) << table.error().detail;
    return table->terrains.at(1).ground->fingerprint();
  };
  const auto two = ground(R"({"cover_share": 0.1, "smallest_m": 0.1, "largest_m": 0.3, "seed": 2})");
  EXPECT_EQ(two, ground(R"({"cover_share": 0.1, "smallest_m": 0.1, "largest_m": 0.3, "seed": 2})"));
  EXPECT_NE(two, ground(R"({"cover_share": 0.1, "smallest_m": 0.1, "largest_m": 0.3})"));

  const auto faulty = with_rocks(
      R"({"cover_share": 0, "smallest_m": 0.04, "largest_m": 0.03, "height_share": 2, "shape": "cube"})");
  ASSERT_FALSE(faulty);
  Texts pointers = pointers_of(faulty.error());
  for (std::string& pointer : pointers) pointer = pointer.substr(pointer.rfind('/') + 1);
  std::sort(pointers.begin(), pointers.end());
  EXPECT_EQ(pointers, (Texts{"cover_share", "height_share", "largest_m", "shape", "smallest_m"}));
}

TEST(DriveTable, ShippedTablesAreWithoutFault) {
  std::map<std::string, std::size_t> drives;
  for (const std::string& name : api::campaign_names(SLIPWAY_DATA_FOLDER)) {
    const auto loaded = api::load_campaign_table(name, SLIPWAY_DATA_FOLDER, shipped_catalogue());
    ASSERT_TRUE(loaded) << name << ": " << loaded.error().detail;
    EXPECT_EQ(loaded->table.name, name);
    drives[name] = expand(loaded->table).size();
  }
  // 10 and 6 tests five times on the level, 22 and 18 three times on each of three slopes.
  EXPECT_EQ(drives["fido_table_1"], 5U * (10U + 6U) + 3U * 3U * (22U + 18U));
  EXPECT_EQ(drives["opportunity_sol_2143"], 1U);
  EXPECT_EQ(drives["rock_field"], 1U);
  EXPECT_EQ(drives["spirit_dead_wheel"], 4U);
}

TEST(DriveTable, UnknownNamesListThoseThereAre) {
  std::string twice = replaced(kSmallTable, R"("name": "slope")", R"("name": "level")");
  twice = replaced(twice, R"("id": "turn", "terrains": ["level"])", R"("id": "turn", "terrains": ["hill"])");
  const auto table = read_table(twice);
  ASSERT_FALSE(table);
  EXPECT_EQ(table.error().faults.back().message, "unknown terrain \"hill\"; known: level");
  const auto loaded = api::load_campaign_table("fido_table", SLIPWAY_DATA_FOLDER, shipped_catalogue());
  ASSERT_FALSE(loaded);
  EXPECT_EQ(loaded.error().code, ErrorCode::kNotFound);
  EXPECT_NE(loaded.error().detail.find("fido_table_1"), std::string::npos);
}

}  // namespace
}  // namespace slipway::campaign
