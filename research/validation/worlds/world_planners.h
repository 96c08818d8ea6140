#pragma once

#include <span>
#include <string_view>

#include "planner/problem/problem.h"

namespace slipway::validation {

// A way to plan, compared with the others on the same worlds and draws. A new one is a row.
struct WorldPlanner {
  std::string_view name;     // in tables and scores
  std::string_view summary;  // one line
  // Changes what it is given into what it plans with.
  void (*set)(planner::PlanProblem& problem);
};

// The first is the one that others are compared with.
std::span<const WorldPlanner> world_planners();

}  // namespace slipway::validation
