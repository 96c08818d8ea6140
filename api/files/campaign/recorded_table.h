#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"

namespace slipway::api {

// Faults of one recorded file that are reported one by one.
inline constexpr std::size_t kMaxFaultsOfFile = 20;

// A recorded file: its columns' names and numbers.
struct RecordedTable {
  std::vector<std::string> names;
  std::vector<std::vector<double>> rows;  // NaN where a cell is empty
  std::vector<std::size_t> lines;         // of each row, in the file
};

// Only cells of the columns that are asked for must be numbers. Faults of `file` are added with its name,
// line and column; the table then is of no use.
RecordedTable read_recorded_table(std::string_view bytes, const std::string& file, char separator,
                                  const std::set<std::string>& asked, std::vector<Fault>& faults);

}  // namespace slipway::api
