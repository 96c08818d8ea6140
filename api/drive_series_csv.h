#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "gap/drive_campaign.h"
#include "sim/rover_model.h"

namespace slipway::api {

struct DriveSeries {
  std::vector<gap::DriveSample> samples;
  std::set<std::string> passed_over;  // columns that the format does not have
  std::vector<Fault> faults;          // at "D001.csv#/12/x_m"; the message has line and column in words
};

// Reads a drive's CSV of a "drive-campaign/1". `file` is what faults call it. At most most_rows are read:
// more are a fault.
DriveSeries read_drive_series(std::string_view bytes, const std::string& file, const sim::RoverModel& rover,
                              std::size_t most_rows);

}  // namespace slipway::api
