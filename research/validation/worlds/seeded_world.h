#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/angle.h"
#include "dem/soil_map.h"
#include "dem/terrain.h"

namespace slipway::validation {

// What a world is made of, besides its seed.
struct WorldOptions {
  std::uint64_t seed = 1;
  double cell_m = 1.0;  // of the elevation; the ground itself is the same for every cell size
  // Exponent of the fractal ground: from wavelengths of 3 to 96 m the variance of waves grows with their
  // length to the power 2 hurst.
  double hurst = 0.8;
  double rms_height_m = 0.2;  // of the fractal ground
  int max_craters = 5;        // fewer where there is no room without overlap
  double min_wall_rad = rad_from_deg(10.0), max_wall_rad = rad_from_deg(20.0);
  double patch_m = 16.0;            // mean width of a patch of one soil
  double hidden_share = 1.0 / 3.0;  // of the area, on which the map names no soil
};

// The side of a world, whose south-west corner is the origin, and the way across it.
inline constexpr double kWorldSide_m = 96.0;
inline constexpr double kWorldStart_m = 8.0, kWorldGoal_m = 88.0;  // x and y alike

// One wave of the fractal ground: amplitude cos(kx x + ky y + phase).
struct GroundWave {
  double kx_1_m = 0.0, ky_1_m = 0.0, phase_rad = 0.0, amplitude_m = 0.0;
};

// A degraded crater: a flat floor, a wall of constant slope up to the rim, and outside a rim that falls with
// the cube of the distance.
struct Crater {
  double x_m = 0.0, y_m = 0.0;
  double radius_m = 0.0;  // of the rim
  double wall_rad = 0.0;

  double floor_radius_m() const { return 0.45 * radius_m; }
  double rim_m() const { return 0.03 * radius_m; }
  // Above the plain, at a distance from the centre.
  double height_m(double distance_m) const;
};

// Ground of one soil: all places that are nearer to this centre than to any other.
struct SoilPatch {
  double x_m = 0.0, y_m = 0.0;
  int soil_class = 0;   // of world_soils()
  bool hidden = false;  // the map says "unknown" here
};

// A world with known truth, and the two maps of it that a planner is given.
struct SeededWorld {
  WorldOptions options;
  std::vector<GroundWave> waves;
  std::vector<Crater> craters;
  std::vector<SoilPatch> patches;
  std::shared_ptr<const dem::Terrain> terrain;
  std::shared_ptr<const dem::SoilMap> soil_map;  // without the hidden patches
  std::vector<std::size_t> patch_of_cell;        // row by row from the north

  double height_m(double x_m, double y_m) const;
  // The patch of the elevation's cell that holds the place, which must be in the world.
  std::size_t patch_at(double x_m, double y_m) const;
};

// The same options give the same world. The fractal ground is a sum of waves whose variance per octave
// follows the exponent (spectral synthesis [Saupe 1988]); craters do not overlap and keep clear of start and
// goal; every class has the same number of patches, to one.
SeededWorld make_world(const WorldOptions& options);

// The world with x and y exchanged, so that start and goal stay where they are.
SeededWorld mirrored(const SeededWorld& world);

}  // namespace slipway::validation
