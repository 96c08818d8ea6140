#pragma once

#include <string>
#include <vector>

#include "campaign/drive_table.h"
#include "core/result.h"

// What the files of a campaign are called, from the campaign's folder. Writers and the check for names that
// collide take them from here.
namespace slipway::campaign {

inline constexpr const char* kSlipPlotFile = "plots/slip_by_terrain.svg";
inline constexpr const char* kPosesPlotFile = "plots/final_poses.svg";

// "ID.csv"; of a drive with several legs "ID-leg1.csv" for the first (leg = 0).
std::string measurement_file(const DriveTable& table, const TableDrive& drive, int leg);
std::string deformed_terrain_file(const TableDrive& drive);
std::string time_history_file(const TableDrive& drive);
std::string record_file(const TableDrive& drive);
std::string elevation_file(const TableTerrain& terrain);
std::string soil_map_file(const TableTerrain& terrain);

// Every file that two drives or terrains of the table would both write, as faults at their names.
std::vector<Fault> colliding_files(const DriveTable& table, const std::vector<TableDrive>& drives);

}  // namespace slipway::campaign
