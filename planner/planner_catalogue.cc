#include "planner/planner_catalogue.h"

#include <array>

namespace slipway::planner {

std::span<const PlannerRow> planner_catalogue() {
  static constexpr std::array<PlannerRow, 3> kRows{{
      {"rrt_sharp", "RRT#: keeps a tree whose promising part is always optimal over the samples so far",
       "Arslan and Tsiotras 2013", true},
      {"rrt_star", "RRT*: a tree rewired around every new sample", "Karaman and Frazzoli 2011", true},
      {"rrtx_static", "RRTX on unchanging ground: rewires only where it gains more than a threshold",
       "Otte and Frazzoli 2016", false},
  }};
  return kRows;
}

}  // namespace slipway::planner
