#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "planner/search/leg_search.h"

namespace slipway::planner {

// A planner that can be asked for by name.
struct PlannerRow {
  std::string_view name;       // "rrt_star"
  std::string_view summary;    // one line
  std::string_view reference;  // the paper
  bool in_default_set;         // used where a request names no planners
  std::unique_ptr<LegPlanner> (*make)();
};

std::span<const PlannerRow> planner_catalogue();

// nullptr where no row has the name.
const PlannerRow* planner_named(std::string_view name,
                                std::span<const PlannerRow> rows = planner_catalogue());

}  // namespace slipway::planner
