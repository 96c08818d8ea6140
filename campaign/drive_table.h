#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/pose.h"
#include "core/result.h"
#include "dem/soil_map.h"
#include "dem/terrain.h"
#include "sim/dynamic/drive_leg.h"
#include "sim/dynamic/drive_sensors.h"
#include "sim/dynamic/dynamic_drive.h"
#include "sim/rover/effect_setting.h"
#include "sim/rover/rover_model.h"
#include "sim/rover/wheel_failure.h"
#include "sim/soil/soil.h"

namespace slipway::campaign {

// Ground that drives are made on.
struct TableTerrain {
  std::string name;
  std::shared_ptr<const dem::Terrain> ground;
  std::string crs_wkt;  // empty: a place of its own, on no planet's map
  std::string soil;     // a name in DriveTable::soils; with a soil map, where that says nothing
  std::shared_ptr<const dem::SoilMap> soil_map;  // may be null; its soils are DriveTable's, too
};

// One line of a table: the same drive on several terrains, in several headings, several times.
struct DriveEntry {
  std::string id;
  std::vector<std::size_t> terrains;  // indices into DriveTable::terrains
  double x_m = 0.0, y_m = 0.0;        // of the start
  std::vector<double> headings_rad{0.0};
  std::vector<sim::DriveLeg> legs;
  int repeats = 1;
  sim::FailedWheels failed_wheels;
  std::optional<double> motor_temp_c = {};  // in place of DriveTable::options'
  bool final_only = false;                  // recorded before and after, as by a survey: two rows
  bool plot = false;                        // its time history
  bool deformed_terrain = false;            // the ground with its ruts
};

// What a campaign is made from. What the operators know (the rover, the soils' means) and what is really at
// work (effects, draws of the soils, failed wheels) stay apart: only the former is written in a campaign's
// own document.
struct DriveTable {
  std::string name, summary;
  std::vector<std::string> sources, assumed;
  std::shared_ptr<const sim::RoverModel> rover;
  std::vector<sim::EffectSetting> effects;  // added to the rover's own
  double gravity_m_s2 = 3.71;
  std::map<std::string, sim::SoilDistribution, std::less<>> soils;
  bool draw_soils = true;  // false: every drive on the mean soil
  std::vector<TableTerrain> terrains;
  sim::DriveSensors sensors;
  sim::DynamicOptions options;
  std::uint64_t seed = 1;
  std::vector<DriveEntry> entries;
};

// One drive of an expanded table.
struct TableDrive {
  std::string id;
  std::size_t entry = 0, terrain = 0;
  Pose2 start;
  std::string repeat_of;  // id of the first of its repeats; empty for that one
};

constexpr std::size_t kMaxDrives = 20'000;

// Terrains vary slowest, then headings, then repeats. An id is the entry's with "-" and the terrain's name
// where the entry lists several, "-h090" for the heading where there are several, and "-r1" where there are
// repeats.
std::vector<TableDrive> expand(const DriveTable& table);

// What must hold between the parts of a table whose numbers were read: ids that are given once, starts on
// their terrains, wheels that the rover has, effects that it can have. Pointers are those of the table's
// file.
std::vector<Fault> faults_of(const DriveTable& table);

// The soils of a terrain by name: the map's in its order, then the one elsewhere.
std::vector<std::string> soils_of(const TableTerrain& terrain);

// A class that the terrain's soil map does not have: of its cells where the map names no soil.
std::int16_t class_elsewhere(const TableTerrain& terrain);

// Of the drive motors: the entry's, else the table's.
std::optional<double> motor_temp_c(const DriveTable& table, const DriveEntry& entry);

// The rover as it really drives an entry: effects at work, wheels failed, and the currents that the format
// of campaigns defines.
sim::RoverModel driven_rover(const DriveTable& table, const DriveEntry& entry);

}  // namespace slipway::campaign
