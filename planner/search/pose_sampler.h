#pragma once

#include <vector>

#include "planner/search/grid_search.h"

namespace slipway::planner {

// Where a search looks: mostly cells that good ways on the grid pass, in the direction in which they pass,
// and some from the whole map at any heading, so that a planner stays complete. Draw number `counter` of a
// seed is always the same pose; immutable.
class PoseSampler {
 public:
  PoseSampler(const GridSearch& grid, const TraverseMap& map, const CostField& to_come,
              const CostField& to_go, double start_x_m, double start_y_m);

  // Along the way alone, of which only the cost to go is known.
  PoseSampler(const GridSearch& grid, const TraverseMap& map, const CostField& to_go, double start_x_m,
              double start_y_m);

  Pose2 draw(std::uint64_t seed, std::uint64_t counter) const;
  double optimum() const { return optimum_; }  // of the way on the grid; infinite where there is none
  // The cells of that way, start and goal included; empty where there is none.
  const std::vector<std::size_t>& way() const { return way_; }
  // The heading in which the cheapest way passes the cell.
  double flow_rad(std::size_t cell) const;

 private:
  const TraverseMap& map_;
  double optimum_;
  std::vector<std::size_t> way_;
  std::vector<std::size_t> cells_;       // worth sampling
  std::vector<double> cumulative_;       // of their weights
  std::vector<std::int16_t> flow_step_;  // per map cell
};

}  // namespace slipway::planner
