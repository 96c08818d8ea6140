#pragma once

#include "dem/elevation_source.h"
#include "tests/planner/plan_fixture.h"

namespace slipway::planner {

// Firm ground on the real relief of Marias Pass.
inline PlanProblem gale() {
  const auto source = dem::open_elevation(SLIPWAY_DATA_FOLDER "/terrains/gale/elevation.tif");
  PlanProblem problem = problem_of("S . .\n. . .\n. . G\n");
  problem.terrain = source.value()->read(source.value()->info().geometry.extent()).value();
  const dem::GridGeometry g = problem.terrain->geometry();
  const auto cells = static_cast<std::size_t>(g.rows) * static_cast<std::size_t>(g.columns);
  problem.soil_map = std::make_shared<dem::SoilMap>(g, std::vector<std::int16_t>(cells, 0),
                                                    std::vector<std::uint8_t>(cells, 1),
                                                    std::vector<dem::SoilClass>{{0, "a", "firm"}});
  problem.beliefs.known = {firm_soil("firm")};
  return problem;
}

}  // namespace slipway::planner
