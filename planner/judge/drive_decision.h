#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "planner/problem/problem.h"
#include "sim/prediction/drive_prediction.h"

namespace slipway::planner {

// What an operator does with a drive.
enum class Decision { kGo, kNoGo, kUnknown };

// "go", "no_go", "unknown".
std::string_view describe(Decision decision);

struct DriveDecision {
  Decision decision = Decision::kUnknown;
  std::vector<std::string> reasons;  // in words and numbers, the deciding ones first
};

// Decides a predicted drive by the problem's bars (sim::OutcomeBars).
//   NO-GO    the rover has no stance somewhere, the ground's shape breaks a limit of clearance, or the lower
//   end of
//            the interval of embedding or of expected stops is over its bar;
//   GO       the upper ends of both are under their bars;
//   UNKNOWN  otherwise, and where a NO-GO hangs on ground that no map names: without what goes wrong there,
//   both
//            are under their bars.
DriveDecision decide(const PlanProblem& problem, const sim::DrivePrediction& drive);

}  // namespace slipway::planner
