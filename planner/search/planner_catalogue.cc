#include "planner/search/planner_catalogue.h"

#include <array>

namespace slipway::planner {

std::span<const PlannerRow> planner_catalogue() {
  static constexpr std::array<PlannerRow, 2> kRows{{
      {"rrt_star", "RRT*: a tree rewired around every new sample", "Karaman and Frazzoli 2011", true},
      {"bit_star", "BIT*: batches of samples, their edges searched in the order of cost",
       "Gammell, Srinivasa and Barfoot 2015", true},
  }};
  return kRows;
}

}  // namespace slipway::planner
