#pragma once

#include <span>
#include <string_view>

namespace slipway::planner {

// A planner of OMPL that can be asked for by name. The row's factory lives behind the fence (planner/ompl_*).
struct PlannerRow {
  std::string_view name;       // "rrt_star"
  std::string_view summary;    // one line
  std::string_view reference;  // the paper
  bool in_default_set;
};

std::span<const PlannerRow> planner_catalogue();

}  // namespace slipway::planner
