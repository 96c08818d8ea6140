#pragma once

#include <map>
#include <span>
#include <string>

#include "campaign/campaign_summary.h"
#include "campaign/drive_record.h"
#include "campaign/drive_table.h"
#include "sim/dynamic/drive_sensors.h"

namespace slipway::api {

// Slip of every drive over its terrain, with the bands, and the errors of heading: as SVG.
std::string draw_slip_by_terrain(const campaign::DriveTable& table,
                                 std::span<const campaign::TableDrive> drives,
                                 const std::map<std::string, campaign::DriveRecord>& records,
                                 std::span<const campaign::TerrainSummary> summaries);

// Where drives should have ended and where they did, terrain by terrain: the first kMaxPosePanels of them.
std::string draw_final_poses(const campaign::DriveTable& table, std::span<const campaign::TableDrive> drives,
                             const std::map<std::string, campaign::DriveRecord>& records);
constexpr std::size_t kMaxPosePanels = 12;

// One drive over time: slip, attitude, and for each wheel sinkage, current, torque and load; those of wheels
// on the right are dashed.
std::string draw_time_history(const std::string& title, const sim::RoverModel& rover,
                              std::span<const sim::SensorReading> readings);

}  // namespace slipway::api
