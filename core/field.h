#pragma once

#include <optional>
#include <string_view>

namespace slipway {

// One number that a catalogue row can be given: its name and unit at the boundary, and its range. From the
// same row come the reader's checks, the documentation and the property tests.
struct Field {
  std::string_view name;     // with its unit: "weight_slip", "n1"
  std::string_view unit;     // "1", "m", "deg", ...
  std::string_view summary;  // one line
  double lowest = 0.0;
  double highest = 0.0;
  double initial = 0.0;                // the value when nothing is said
  std::optional<double> neutral = {};  // with all its fields that have one at it, the row does nothing
};

}  // namespace slipway
