#pragma once

#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "gap/diagnosis/model/drive_campaign.h"

namespace slipway::api {

struct DriveSeries {
  std::vector<gap::DriveSample> samples;
  std::set<std::string> passed_over;  // columns that the format does not have
  std::vector<Fault> faults;          // at "D001.csv#/12/x_m"; the message has line and column in words
};

// Reads a drive's CSV of a "drive-campaign/1". `file` is what faults call it, `wheels` the names of the
// rover's: columns of other wheels are passed over. At most most_rows are read: more are a fault.
DriveSeries read_drive_series(std::string_view bytes, const std::string& file,
                              const std::vector<std::string>& wheels, std::size_t most_rows);

// The column of the format that one which was passed over was probably meant to be.
std::optional<std::string> column_meant(std::string_view name, const std::vector<std::string>& wheels);

}  // namespace slipway::api
