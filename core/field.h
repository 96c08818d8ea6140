#pragma once

#include <optional>
#include <string_view>

namespace slipway {

// One parameter of a catalogue row: its name and unit in requests, and its range. The request reader's
// checks, the documentation and the property tests all come from this row.
struct Field {
  std::string_view name;     // with its unit: "weight_slip", "n1"
  std::string_view unit;     // "1", "m", "deg", ...
  std::string_view summary;  // one line
  double lowest = 0.0;
  double highest = 0.0;
  double initial = 0.0;  // the value where a request gives none
  // The row has no effect where all of its fields that have a neutral value are at it.
  std::optional<double> neutral = {};
};

}  // namespace slipway
