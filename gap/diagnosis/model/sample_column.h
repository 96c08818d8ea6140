#pragma once

#include <cstddef>
#include <string_view>

namespace slipway::gap {

struct DriveSample;

// What a column of a drive's file holds: its range in the unit of its name, and where it goes. Without a name
// it is no column.
struct SampleColumn {
  std::string_view name;  // of a wheel's column without the wheel: "current_a"
  double lowest = 0.0, highest = 0.0;
  void (*set)(DriveSample& sample, std::size_t wheel, double value) = nullptr;
};

}  // namespace slipway::gap
