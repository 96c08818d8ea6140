#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "dem/rock_field.h"
#include "dem/terrain.h"

namespace slipway::dem {

// Ground in closed form for tests and examples, which a reader can check by hand. All are square grids
// centred on the map's origin.
struct SyntheticGrid {
  double size_m = 20.0;  // length of a side
  double cell_m = 0.25;
};

std::shared_ptr<const Terrain> make_plane(const SyntheticGrid& grid, double height_m);
// A plane that rises with `slope_rad` towards the direction `uphill_rad` (counter-clockwise from east).
std::shared_ptr<const Terrain> make_ramp(const SyntheticGrid& grid, double slope_rad, double uphill_rad);
// A sinusoidal wind ripple along y: one crest at x = 0, height_m from foot to crest, width_m from foot to
// foot; level elsewhere.
std::shared_ptr<const Terrain> make_ripple(const SyntheticGrid& grid, double height_m, double width_m);
// A bowl around the origin, a paraboloid of the given radius and depth whose rim lies on a plane of height 0.
std::shared_ptr<const Terrain> make_crater(const SyntheticGrid& grid, double radius_m, double depth_m);

// A plane that rises towards +x, with ripple, roughness and rocks added to its height.
struct Relief {
  double slope_rad = 0.0;
  struct Ripple {
    double height_m = 0.0, width_m = 1.0;  // as in make_ripple
    double crest_x_m = 0.0;
  };
  std::optional<Ripple> ripple = {};
  // Bumps without a preferred direction: normal heights on a lattice, joined smoothly.
  struct Roughness {
    double rms_m = 0.0;      // of the heights at the lattice's points
    double lattice_m = 1.0;  // about the width of a bump
    std::uint64_t seed = 1;
  };
  std::optional<Roughness> roughness = {};
  std::optional<RockField> rocks = {};
};
std::shared_ptr<const Terrain> make_relief(const SyntheticGrid& grid, const Relief& relief);

}  // namespace slipway::dem
