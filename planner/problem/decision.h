#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace slipway::planner {

// What an operator does with a drive.
enum class Decision { kGo, kNoGo, kUnknown };

// "go", "no_go", "unknown".
std::string_view describe(Decision decision);

// Where a drive over a kilometre and more is planned and no other length is asked for [m]: about what a rover
// drives on a sol.
constexpr double kSegment_m = 250.0;
constexpr double kLongDrive_m = 1000.0;

struct DriveDecision {
  Decision decision = Decision::kUnknown;
  std::vector<std::string> reasons;  // in words and numbers, the deciding ones first
};

}  // namespace slipway::planner
