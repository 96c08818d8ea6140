#include "planner/search/traverse_map.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/parallel_for.h"

namespace slipway::planner {
namespace {

// Finer than any rover of interest steers.
constexpr double kFinestCell_m = 0.25;

dem::GridGeometry search_geometry(const dem::GridGeometry& terrain, const dem::Extent& extent) {
  const dem::CellWindow window =
      terrain.window(extent).value_or(dem::CellWindow{0, 0, terrain.rows, terrain.columns});
  dem::GridGeometry geometry = terrain.sub(window);
  const auto first = [](double cell_m) {
    return std::max(1, static_cast<int>(std::floor(kFinestCell_m / cell_m + 1e-9)));
  };
  int step_x = first(geometry.cell_x_m), step_y = first(geometry.cell_y_m);
  const auto rows = [&] { return (window.rows + step_y - 1) / step_y; };
  const auto columns = [&] { return (window.columns + step_x - 1) / step_x; };
  while (static_cast<long long>(rows()) * columns() > kMaxSearchCells) {
    // The shorter side grows, both where they are equal.
    const double x_m = step_x * geometry.cell_x_m, y_m = step_y * geometry.cell_y_m;
    if (x_m <= y_m) ++step_x;
    if (y_m <= x_m) ++step_y;
  }
  geometry.rows = rows();
  geometry.columns = columns();
  geometry.cell_x_m *= step_x;
  geometry.cell_y_m *= step_y;
  return geometry;
}

// The plane under a square of terrain cells, and how far the ground rises above it.
struct Footprint {
  bool complete = false;
  double gradient_x = 0.0, gradient_y = 0.0;
  double rise_m = 0.0;
};

// Of a footprint to each side of its cell, in cells.
int footprint_reach(const sim::RoverModel& rover, double cell_m) {
  const double half_width = 0.5 * std::min(rover.body_length_m, rover.body_width_m);
  return std::max(1, static_cast<int>(std::lround(half_width / cell_m)));
}

// Least squares over the cells that have elevation; incomplete where they don't span a plane.
Footprint footprint_of(const dem::Terrain& terrain, const dem::Cell& centre, int reach_x, int reach_y) {
  const dem::GridGeometry& g = terrain.geometry();
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right_side = Eigen::Vector3d::Zero();
  const double reference = terrain.height_m(centre).value_or(0.0);
  const auto each_cell = [&](const auto& use) {
    for (int dr = -reach_y; dr <= reach_y; ++dr) {
      for (int dc = -reach_x; dc <= reach_x; ++dc) {
        const std::optional<double> z = terrain.height_m(dem::Cell{centre.row + dr, centre.column + dc});
        if (z) use(Eigen::Vector3d(1.0, dc * g.cell_x_m, -dr * g.cell_y_m), *z - reference);
      }
    }
  };
  each_cell([&](const Eigen::Vector3d& place, double z) {
    normal += place * place.transpose();
    right_side += z * place;
  });
  // Three cells of a line leave the determinant at 0, three of a triangle at least at the cell's area
  // squared.
  const double cell_area = g.cell_x_m * g.cell_y_m;
  if (normal.determinant() < 0.5 * cell_area * cell_area) return {};
  const Eigen::Vector3d plane = normal.inverse() * right_side;
  Footprint footprint{.complete = true, .gradient_x = plane[1], .gradient_y = plane[2]};
  each_cell([&](const Eigen::Vector3d& place, double z) {
    footprint.rise_m = std::max(footprint.rise_m, z - plane.dot(place));
  });
  return footprint;
}

// The circle lies on the map, and every point of it has a height: heights are bilinear, so each terrain cell
// that comes within a cell of the circle must have one.
bool surrounded_by_data(const dem::Terrain& terrain, const Eigen::Vector2d& centre, double radius_m) {
  const dem::GridGeometry& g = terrain.geometry();
  const dem::Extent extent = g.extent();
  if (centre.x() - radius_m < extent.west_m || centre.x() + radius_m > extent.east_m ||
      centre.y() - radius_m < extent.south_m || centre.y() + radius_m > extent.north_m) {
    return false;
  }
  const Eigen::Vector2d middle = g.fractional_index(centre.x(), centre.y());
  const int down = static_cast<int>(std::ceil(radius_m / g.cell_y_m)) + 1;
  const int right = static_cast<int>(std::ceil(radius_m / g.cell_x_m)) + 1;
  for (int dr = -down; dr <= down; ++dr) {
    for (int dc = -right; dc <= right; ++dc) {
      const int row = static_cast<int>(std::lround(middle[0])) + dr;
      const int column = static_cast<int>(std::lround(middle[1])) + dc;
      if (row < 0 || column < 0 || row >= g.rows || column >= g.columns) continue;
      const double away = std::hypot(std::max(0.0, std::abs(row - middle[0]) - 1.0) * g.cell_y_m,
                                     std::max(0.0, std::abs(column - middle[1]) - 1.0) * g.cell_x_m);
      if (away < radius_m && !terrain.has_data({row, column})) return false;
    }
  }
  return true;
}

// Free is a cell in which the body is clear wherever it stands, not at the centre alone.
Passage passage_near(const KeepOut& keep_out, const Eigen::Vector2d& centre, double half_diagonal_m) {
  if (keep_out.empty() || keep_out.clear_at_any_heading(centre.x(), centre.y(), half_diagonal_m))
    return Passage::kFree;
  return keep_out.hits_at_any_heading(centre.x(), centre.y()) ? Passage::kKeepOut : Passage::kNearKeepOut;
}

}  // namespace

dem::Extent search_extent(const PlanProblem& problem, double rooms) {
  dem::Extent extent{problem.start.x_m, problem.start.y_m, problem.start.x_m, problem.start.y_m};
  double longest = 0.0;
  Waypoint last = problem.start;
  const auto include = [&](const Waypoint& place) {
    longest = std::max(longest, std::hypot(place.x_m - last.x_m, place.y_m - last.y_m));
    extent.west_m = std::min(extent.west_m, place.x_m);
    extent.south_m = std::min(extent.south_m, place.y_m);
    extent.east_m = std::max(extent.east_m, place.x_m);
    extent.north_m = std::max(extent.north_m, place.y_m);
    last = place;
  };
  for (const Waypoint& place : problem.waypoints) include(place);
  include(problem.goal);
  const double room = rooms * std::max(60.0, 0.5 * longest);
  return {extent.west_m - room, extent.south_m - room, extent.east_m + room, extent.north_m + room};
}

TraverseMap::TraverseMap(const PlanProblem& problem, const KeepOut& keep_out, const dem::Extent& extent)
    : geometry_(search_geometry(problem.terrain->geometry(), extent)), keep_out_(keep_out) {
  cells_.resize(static_cast<std::size_t>(geometry_.rows) * static_cast<std::size_t>(geometry_.columns));
  parallel_for(static_cast<std::size_t>(geometry_.rows), problem.threads, [&](std::size_t row) {
    for (int column = 0; column < geometry_.columns; ++column) {
      const std::size_t i = row * static_cast<std::size_t>(geometry_.columns) + column;
      cells_[i] = cell_of(problem, centre_m(i));
    }
  });
}

std::vector<Eigen::Vector2d> TraverseMap::judged_places(const PlanProblem& problem,
                                                        const Eigen::Vector2d& centre) const {
  if (std::max(geometry_.cell_x_m, geometry_.cell_y_m) <= kFinestCell_m + 1e-9) return {centre};
  const dem::GridGeometry& terrain = problem.terrain->geometry();
  // Cells so far apart that their footprints still cover all between them, the outermost ones included.
  const auto offsets_m = [&](double side_m, double cell_m) {
    const auto cells = static_cast<int>(std::lround(side_m / cell_m));
    const int pieces =
        (cells - 2 + footprint_reach(*problem.rover, cell_m)) / footprint_reach(*problem.rover, cell_m);
    std::vector<double> offsets;
    for (int k = 0; k <= pieces; ++k)
      offsets.push_back(((pieces == 0 ? 0 : (cells - 1) * k / pieces) - 0.5 * (cells - 1)) * cell_m);
    return offsets;
  };
  std::vector<Eigen::Vector2d> places;
  for (const double dy : offsets_m(geometry_.cell_y_m, terrain.cell_y_m)) {
    for (const double dx : offsets_m(geometry_.cell_x_m, terrain.cell_x_m)) {
      // The last row and column of search cells may reach beyond the terrain.
      if (terrain.cell_at(centre.x() + dx, centre.y() + dy))
        places.emplace_back(centre.x() + dx, centre.y() + dy);
    }
  }
  return places;
}

void TraverseMap::judge_ground(const PlanProblem& problem, const std::vector<Eigen::Vector2d>& places,
                               GroundCell& cell) const {
  const dem::Terrain& terrain = *problem.terrain;
  const sim::RoverModel& rover = *problem.rover;
  const double circumscribed = 0.5 * std::hypot(rover.body_length_m, rover.body_width_m);
  const int reach_x = footprint_reach(rover, terrain.geometry().cell_x_m);
  const int reach_y = footprint_reach(rover, terrain.geometry().cell_y_m);
  for (std::size_t k = 0; k < places.size(); ++k) {
    const std::optional<dem::Cell> under = terrain.geometry().cell_at(places[k].x(), places[k].y());
    Footprint plane;
    if (under && surrounded_by_data(terrain, places[k], circumscribed))
      plane = footprint_of(terrain, *under, reach_x, reach_y);
    if (!plane.complete) {
      cell.passage = Passage::kNoData;
      return;
    }
    if (k == places.size() / 2) {
      cell.gradient_x = static_cast<float>(plane.gradient_x);
      cell.gradient_y = static_cast<float>(plane.gradient_y);
    }
    const double tilt = std::atan(std::hypot(plane.gradient_x, plane.gradient_y));
    if (tilt > problem.max_tilt_rad()) cell.passage = Passage::kSteep;
    cell.tilt_rad = std::max(cell.tilt_rad, static_cast<float>(tilt));
    cell.rise_m = std::max(cell.rise_m, static_cast<float>(plane.rise_m));
    if (plane.rise_m + problem.limits.min_clearance_m > rover.belly_clearance_m)
      cell.passage = Passage::kRough;
  }
}

GroundCell TraverseMap::cell_of(const PlanProblem& problem, const Eigen::Vector2d& centre) const {
  GroundCell cell{.soil = kUnknownSoil};
  if (problem.soil_map) {
    const auto soil = problem.soil_map->soil_at(centre.x(), centre.y());
    if (soil) cell.soil = static_cast<std::uint8_t>(*soil);
  }
  cell.passage = passage_near(keep_out_, centre, 0.5 * std::hypot(geometry_.cell_x_m, geometry_.cell_y_m));
  if (cell.passage == Passage::kKeepOut) return cell;
  std::vector<Eigen::Vector2d> places = judged_places(problem, centre);
  if (places.size() != 1) {
    const auto stands_here = [&](const Waypoint& place) {
      if (index_at(place.x_m, place.y_m) == index_at(centre.x(), centre.y()))
        places = {{place.x_m, place.y_m}};
    };
    stands_here(problem.start);
    stands_here(problem.goal);
    for (const Waypoint& place : problem.waypoints) stands_here(place);
  }
  if (places.empty()) cell.passage = Passage::kNoData;
  judge_ground(problem, places, cell);
  return cell;
}

long long TraverseMap::index_at(double x_m, double y_m) const {
  // On the search's hot path: no optional, and the south and east edges are simply outside.
  const double column = (x_m - geometry_.west_m) / geometry_.cell_x_m;
  const double row = (geometry_.north_m - y_m) / geometry_.cell_y_m;
  if (!(column >= 0.0 && row >= 0.0 && column < geometry_.columns && row < geometry_.rows)) return -1;
  return static_cast<long long>(row) * geometry_.columns + static_cast<long long>(column);
}

Eigen::Vector2d TraverseMap::centre_m(std::size_t index) const {
  const auto columns = static_cast<std::size_t>(geometry_.columns);
  return geometry_.centre_m({static_cast<int>(index / columns), static_cast<int>(index % columns)});
}

bool TraverseMap::may_stand(const Pose2& pose) const {
  const long long i = index_at(pose.x_m, pose.y_m);
  if (i < 0) return false;
  const Passage passage = cells_[static_cast<std::size_t>(i)].passage;
  return passage == Passage::kFree || (passage == Passage::kNearKeepOut && !keep_out_.hits(pose));
}

}  // namespace slipway::planner
