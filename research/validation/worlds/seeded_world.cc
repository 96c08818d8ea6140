#include "research/validation/worlds/seeded_world.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "core/random.h"
#include "research/validation/worlds/world_soils.h"

namespace slipway::validation {
namespace {

enum Stream : std::uint64_t { kWaves, kCraters, kPatches, kClasses, kHidden };

std::vector<GroundWave> make_waves(const WorldOptions& options) {
  constexpr int kCount = 256;
  constexpr double kLongest_m = kWorldSide_m, kShortest_m = 3.0;
  const std::uint64_t key = random_key(options.seed, kWaves);
  std::vector<GroundWave> waves;
  double variance = 0.0;
  for (int i = 0; i < kCount; ++i) {
    const std::uint64_t wave = random_key(key, static_cast<std::uint64_t>(i));
    // One wave in each of equal steps of the logarithm of the wavelength.
    const double octaves = (i + random_uniform(wave, 0)) / kCount;
    const double length_m = kLongest_m * std::pow(kShortest_m / kLongest_m, octaves);
    const double towards = 2.0 * std::numbers::pi * random_uniform(wave, 1);
    const double k = 2.0 * std::numbers::pi / length_m;
    const double amplitude = std::pow(length_m, options.hurst);
    waves.push_back({k * std::cos(towards), k * std::sin(towards),
                     2.0 * std::numbers::pi * random_uniform(wave, 2), amplitude});
    variance += 0.5 * amplitude * amplitude;
  }
  for (GroundWave& wave : waves) wave.amplitude_m *= options.rms_height_m / std::sqrt(variance);
  return waves;
}

// Whether a crater lies whole on the map, clear of start, goal and the craters before it.
bool has_room(const Crater& crater, const std::vector<Crater>& others) {
  constexpr double kClear = 1.3, kRover_m = 3.0;
  const double reach = kClear * crater.radius_m;
  for (const double at : {crater.x_m, crater.y_m})
    if (at < crater.radius_m || at > kWorldSide_m - crater.radius_m) return false;
  for (const double end : {kWorldStart_m, kWorldGoal_m})
    if (std::hypot(crater.x_m - end, crater.y_m - end) < reach + kRover_m) return false;
  return std::none_of(others.begin(), others.end(), [&](const Crater& other) {
    return std::hypot(crater.x_m - other.x_m, crater.y_m - other.y_m) < reach + kClear * other.radius_m;
  });
}

std::vector<Crater> make_craters(const WorldOptions& options) {
  constexpr double kMinRadius_m = 4.0, kMaxRadius_m = 9.0;
  constexpr std::uint64_t kTries = 400;
  const std::uint64_t key = random_key(options.seed, kCraters);
  std::vector<Crater> craters;
  for (std::uint64_t tried = 0;
       tried < kTries && craters.size() < static_cast<std::size_t>(options.max_craters); ++tried) {
    const std::uint64_t draw = random_key(key, tried);
    const Crater crater{
        kWorldSide_m * random_uniform(draw, 0), kWorldSide_m * random_uniform(draw, 1),
        kMinRadius_m * std::pow(kMaxRadius_m / kMinRadius_m, random_uniform(draw, 2)),
        options.min_wall_rad + (options.max_wall_rad - options.min_wall_rad) * random_uniform(draw, 3)};
    if (has_room(crater, craters)) craters.push_back(crater);
  }
  return craters;
}

// The numbers from 0 to count - 1 in random order.
std::vector<std::size_t> shuffled(std::size_t count, std::uint64_t key) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [key](std::size_t a, std::size_t b) { return random_bits(key, a) < random_bits(key, b); });
  return order;
}

std::vector<SoilPatch> make_patches(const WorldOptions& options) {
  const std::uint64_t key = random_key(options.seed, kPatches);
  const int across = std::max(1, static_cast<int>(std::lround(kWorldSide_m / options.patch_m)));
  const double width_m = kWorldSide_m / across;
  std::vector<SoilPatch> patches;
  for (int k = 0; k < across * across; ++k) {
    const std::uint64_t draw = random_key(key, static_cast<std::uint64_t>(k));
    patches.push_back(
        {(k % across + random_uniform(draw, 0)) * width_m, (k / across + random_uniform(draw, 1)) * width_m});
  }
  const std::vector<std::size_t> order = shuffled(patches.size(), random_key(options.seed, kClasses));
  for (std::size_t k = 0; k < order.size(); ++k)
    patches[order[k]].soil_class = static_cast<int>(k % kWorldSoils);
  return patches;
}

// Hides patches in random order until as much of the area is hidden as comes nearest to the share.
void hide(const WorldOptions& options, const std::vector<std::size_t>& patch_of_cell,
          std::vector<SoilPatch>& patches) {
  std::vector<double> area(patches.size(), 0.0);
  for (const std::size_t patch : patch_of_cell)
    area[patch] += 1.0 / static_cast<double>(patch_of_cell.size());
  double hidden = 0.0;
  for (const std::size_t k : shuffled(patches.size(), random_key(options.seed, kHidden))) {
    if (std::abs(hidden + area[k] - options.hidden_share) >= std::abs(hidden - options.hidden_share)) break;
    patches[k].hidden = true;
    hidden += area[k];
  }
}

dem::GridGeometry grid_of(const WorldOptions& options) {
  const int cells = static_cast<int>(std::lround(kWorldSide_m / options.cell_m));
  return {cells, cells, 0.0, kWorldSide_m, kWorldSide_m / cells, kWorldSide_m / cells};
}

template <class Of>
void for_each_centre(const dem::GridGeometry& grid, Of of) {
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) of(grid.centre_m({row, column}));
}

void divide_cells(SeededWorld& world) {
  world.patch_of_cell.clear();
  for_each_centre(grid_of(world.options), [&](const Eigen::Vector2d& p) {
    const auto nearer = [&](const SoilPatch& a, const SoilPatch& b) {
      return std::hypot(a.x_m - p.x(), a.y_m - p.y()) < std::hypot(b.x_m - p.x(), b.y_m - p.y());
    };
    world.patch_of_cell.push_back(static_cast<std::size_t>(
        std::min_element(world.patches.begin(), world.patches.end(), nearer) - world.patches.begin()));
  });
}

void draw_maps(SeededWorld& world) {
  const dem::GridGeometry grid = grid_of(world.options);
  std::vector<float> heights;
  for_each_centre(grid, [&](const Eigen::Vector2d& p) {
    heights.push_back(static_cast<float>(world.height_m(p.x(), p.y())));
  });
  const std::size_t cells = heights.size();
  world.terrain =
      std::make_shared<dem::Terrain>(grid, std::move(heights), std::vector<std::uint8_t>(cells, 1));
  std::vector<std::int16_t> classes;
  std::vector<std::uint8_t> known;
  for (const std::size_t patch : world.patch_of_cell) {
    classes.push_back(static_cast<std::int16_t>(world.patches[patch].soil_class));
    known.push_back(world.patches[patch].hidden ? 0 : 1);
  }
  std::vector<dem::SoilClass> legend;
  for (int k = 0; k < kWorldSoils; ++k) legend.push_back({k, world_soil_name(k), world_soil_name(k)});
  world.soil_map =
      std::make_shared<dem::SoilMap>(grid, std::move(classes), std::move(known), std::move(legend));
}

}  // namespace

double Crater::height_m(double distance_m) const {
  if (distance_m >= radius_m) return rim_m() * std::pow(radius_m / distance_m, 3.0);
  return rim_m() - std::tan(wall_rad) * (radius_m - std::max(distance_m, floor_radius_m()));
}

double SeededWorld::height_m(double x_m, double y_m) const {
  double height = 0.0;
  for (const GroundWave& wave : waves)
    height += wave.amplitude_m * std::cos(wave.kx_1_m * x_m + wave.ky_1_m * y_m + wave.phase_rad);
  for (const Crater& crater : craters)
    height += crater.height_m(std::hypot(x_m - crater.x_m, y_m - crater.y_m));
  return height;
}

std::size_t SeededWorld::patch_at(double x_m, double y_m) const {
  const dem::GridGeometry& grid = terrain->geometry();
  const dem::Cell cell = grid.cell_at(x_m, y_m).value();
  return patch_of_cell[static_cast<std::size_t>(cell.row) * static_cast<std::size_t>(grid.columns) +
                       static_cast<std::size_t>(cell.column)];
}

SeededWorld make_world(const WorldOptions& options) {
  SeededWorld world{options, make_waves(options), make_craters(options), make_patches(options), {}, {}, {}};
  divide_cells(world);
  hide(options, world.patch_of_cell, world.patches);
  draw_maps(world);
  return world;
}

SeededWorld mirrored(const SeededWorld& world) {
  SeededWorld other = world;
  for (GroundWave& wave : other.waves) std::swap(wave.kx_1_m, wave.ky_1_m);
  for (Crater& crater : other.craters) std::swap(crater.x_m, crater.y_m);
  for (SoilPatch& patch : other.patches) std::swap(patch.x_m, patch.y_m);
  divide_cells(other);
  draw_maps(other);
  return other;
}

}  // namespace slipway::validation
