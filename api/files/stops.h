#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/result.h"

namespace slipway::api {

// Where a rover has been: a place on the map and what its table says of it, column by column.
struct Stop {
  double x_m = 0.0;
  double y_m = 0.0;
  std::vector<std::pair<std::string, std::string>> columns;  // the others, in the table's order
};

// Stops from CSV: a header row with x_m and y_m among its columns, one stop a row. Faults name row and
// column.
Result<std::vector<Stop>> read_stops(std::string_view csv);

}  // namespace slipway::api
