#pragma once

#include <functional>
#include <span>
#include <vector>

#include "campaign/drive_table.h"
#include "core/progress.h"
#include "core/result.h"
#include "sim/dynamic/drive_sensors.h"
#include "sim/dynamic/dynamic_drive.h"

namespace slipway::campaign {

// A drive as made. An error of the simulator is an outcome of this drive, not of the campaign.
struct MadeDrive {
  sim::DriveSoils soils;  // that were drawn, effects at work, in the order of soils_of
  Result<sim::DynamicDrive> drive;
  std::vector<sim::SensorReading> readings;  // as far as the drive came
};

// What drives are simulated by: sim::simulate_drive, or what a test puts in its place.
using Simulator = decltype(&sim::simulate_drive);

struct RunOptions {
  std::size_t threads = 0;  // 0: as many as the machine has
  Simulator simulator = &sim::simulate_drive;
};

// Makes one drive. Its soil and its sensors' errors depend on the table's seed and the drive's id alone, so
// that a drive is the same in any company, order and number of threads.
MadeDrive make_drive(const DriveTable& table, const TableDrive& drive, Simulator simulator,
                     Progress& progress);

// Takes a drive that has been made; called from several threads at once. An error ends the campaign.
using DriveTaker = std::function<Result<void>(const TableDrive&, const MadeDrive&)>;

// Makes these drives in parallel and gives each away as soon as it is made: a campaign's memory is that of
// the drives that are being made. Errors: cancelled; those of the taker.
Result<void> run_campaign(const DriveTable& table, std::span<const TableDrive> drives,
                          const RunOptions& options, const DriveTaker& taker, Progress& progress);

}  // namespace slipway::campaign
