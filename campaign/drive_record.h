#pragma once

#include <string>
#include <utility>
#include <vector>

#include "campaign/run_campaign.h"

namespace slipway::campaign {

// What is kept of a drive besides its files: enough for a campaign's summary, and to know that it is done.
struct DriveRecord {
  std::string id;
  std::string digest;  // of all that the drive depends on
  // A name of sim::DriveEnd; where the simulator could not answer, the error's: "no_data".
  std::string end;
  std::string reason;              // empty where finished
  bool answered = false;           // false: an error; of what is below only the soils are then known
  std::vector<std::string> files;  // in the campaign's folder: one a leg, in order, and a deformed terrain
  double duration_s = 0.0, progress_m = 0.0, commanded_m = 0.0, energy_j = 0.0;
  double final_slip_ratio = 0.0;
  Pose2 start, final, commanded;
  sim::Peak max_slip_ratio, max_tilt_rad, max_current_a, max_sinkage_m;
  std::vector<sim::DriveEvent> events;
  sim::IntegrationWork work;
  std::vector<std::pair<std::string, sim::Soil>> soils;  // that it could meet, by name
};

DriveRecord record_of(const DriveTable& table, const TableDrive& drive, const MadeDrive& made,
                      const std::string& digest, std::vector<std::string> files);

// Final less commanded: how far the drive is from where it should have ended, and how much its heading is
// off, wrapped.
double position_error_m(const DriveRecord& record);
double heading_error_rad(const DriveRecord& record);

}  // namespace slipway::campaign
