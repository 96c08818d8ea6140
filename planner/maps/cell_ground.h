#pragma once

#include <vector>

#include "dem/terrain.h"
#include "sim/rover/rover_model.h"

namespace slipway::planner {

// The ground under the rover at the centre of each cell of a window: the least-squares plane over the square
// that TraverseMap takes too. Row by row; NaN where a cell within reach of the body has no elevation, or the
// map ends there.
struct CellGround {
  std::vector<float> gradient_x, gradient_y;  // rise per metre towards east and north
  std::vector<float> rise_m;  // the ground's greatest height above the plane; empty unless it was asked for
  std::vector<char> has_elevation;  // of the cell alone
};

// How many cells around a window the ground in it depends on.
int reach_in_cells(const sim::RoverModel& rover, const dem::GridGeometry& geometry);

// `window` counts in the terrain's cells and may reach beyond it; `map` is where the whole map ends.
CellGround cell_ground(const dem::Terrain& terrain, const dem::CellWindow& window, const dem::Extent& map,
                       const sim::RoverModel& rover, bool with_rise);

}  // namespace slipway::planner
