#pragma once

#include <cstdint>
#include <vector>

#include "dem/grid_geometry.h"

namespace slipway::dem {

// Rocks on the ground as halves of ellipsoids, round from above. The share of the ground under rocks of a
// diameter of at least D, with k the share under rocks of all sizes [Golombek & Rapp 1997]:
//
//   F_k(D) = k exp(-q(k) D)     q(k) = 1.79 + 0.152 / k, in 1/m
//
// Only rocks between the two sizes are there, so that they cover covered_share of the ground: less than k.
struct RockField {
  double cover_share = 0.05;  // k, in (0, 1)
  double smallest_m = 0.1, largest_m = 0.5;
  double height_share = 0.5;  // of the diameter: 0.5 is half a ball
  std::uint64_t seed = 1;
};

struct Rock {
  double x_m = 0.0, y_m = 0.0;
  double diameter_m = 0.0;
};

// F_k(smallest) - F_k(largest).
double covered_share(const RockField& field);

// The rocks whose centre or rim may be in the extent. Their places are independent of each other, so that
// some overlap; their number is such that together, with overlaps counted once, they cover the share above. A
// place has the same rocks for any extent.
std::vector<Rock> rocks_in(const RockField& field, const Extent& extent);

// Adds the rocks to heights at the cells' centres, row by row from the north. Where rocks overlap, the higher
// one counts.
void add_rocks(const RockField& field, const GridGeometry& geometry, std::vector<float>& heights);

}  // namespace slipway::dem
