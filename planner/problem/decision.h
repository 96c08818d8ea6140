#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace slipway::planner {

// What an operator does with a drive.
enum class Decision { kGo, kNoGo, kUnknown };

// "go", "no_go", "unknown".
std::string_view describe(Decision decision);

struct DriveDecision {
  Decision decision = Decision::kUnknown;
  std::vector<std::string> reasons;  // in words and numbers, the deciding ones first
};

}  // namespace slipway::planner
