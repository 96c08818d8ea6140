#include "planner/search/ground_judge.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

namespace slipway::planner {
namespace {

// Cells from this size on [m] say nothing of what rises under a rover: between their heights the ground is a
// plane.
constexpr double kNoRiseFrom_m = 10.0;

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

std::vector<int> GroundJudge::judged_cells(int along, int reach) {
  const int pieces = (along - 2 + reach) / reach;
  std::vector<int> cells;
  for (int k = 0; k <= pieces; ++k) cells.push_back(pieces == 0 ? 0 : (along - 1) * k / pieces);
  return cells;
}

std::vector<Eigen::Vector2d> GroundJudge::judged_places(const Eigen::Vector2d& centre) const {
  if (judges_centres_) return {centre};
  const dem::GridGeometry& terrain = problem_.terrain->geometry();
  std::vector<Eigen::Vector2d> places;
  for (const int up : judged_up_) {
    for (const int right : judged_right_) {
      const double dx = (right - 0.5 * (step_x_ - 1)) * terrain.cell_x_m;
      const double dy = (up - 0.5 * (step_y_ - 1)) * terrain.cell_y_m;
      // The last row and column of search cells may reach beyond the terrain.
      if (terrain.cell_at(centre.x() + dx, centre.y() + dy))
        places.emplace_back(centre.x() + dx, centre.y() + dy);
    }
  }
  return places;
}

dem::CellWindow GroundJudge::rows_of_terrain(long long row, long long rows) const {
  const dem::GridGeometry& terrain = problem_.terrain->geometry();
  const long long first = std::max(0LL, row * step_y_ - margin_);
  const long long last = std::min<long long>(terrain.rows, (row + rows) * step_y_ + margin_);
  return {static_cast<int>(first), 0, static_cast<int>(last - first), terrain.columns};
}

bool GroundJudge::holds_a_place(const Eigen::Vector2d& centre) const {
  const long long cell = grid_index(geometry_, centre.x(), centre.y());
  return std::find(cells_of_places_.begin(), cells_of_places_.end(), cell) != cells_of_places_.end();
}

GroundJudge::GroundJudge(const PlanProblem& problem, const KeepOut& keep_out,
                         const dem::GridGeometry& geometry)
    : problem_(problem),
      keep_out_(keep_out),
      geometry_(geometry),
      circumscribed_m_(problem.rover->circumscribed_m()),
      max_tilt_rad_(problem.max_tilt_rad()),
      steepest_squared_(std::pow(std::tan(max_tilt_rad_), 2)),
      most_rise_m_(std::max(problem.terrain->geometry().cell_x_m, problem.terrain->geometry().cell_y_m) <
                           kNoRiseFrom_m
                       ? problem.rover->belly_clearance_m - problem.limits.min_clearance_m
                       : std::numeric_limits<double>::infinity()),
      reach_x_(footprint_reach(*problem.rover, problem.terrain->geometry().cell_x_m)),
      reach_y_(footprint_reach(*problem.rover, problem.terrain->geometry().cell_y_m)) {
  const dem::GridGeometry& terrain = problem.terrain->geometry();
  const double cell = std::min(terrain.cell_x_m, terrain.cell_y_m);
  margin_ = std::max({reach_x_, reach_y_, static_cast<int>(std::ceil(circumscribed_m_ / cell)) + 2});
  step_x_ = static_cast<int>(std::lround(geometry.cell_x_m / terrain.cell_x_m));
  step_y_ = static_cast<int>(std::lround(geometry.cell_y_m / terrain.cell_y_m));
  for (const Waypoint& place : problem.places())
    cells_of_places_.push_back(grid_index(geometry_, place.x_m, place.y_m));
  judges_centres_ = std::max(geometry.cell_x_m, geometry.cell_y_m) <= kFinestCell_m + 1e-9;
  judged_right_ = judged_cells(step_x_, reach_x_);
  judged_up_ = judged_cells(step_y_, reach_y_);
}

// The same as judge_figures() up to rounding, for very many cells.
void GroundJudge::judge_quickly(double gradient_x, double gradient_y, double rise_m, GroundCell& cell) const {
  const double squared = gradient_x * gradient_x + gradient_y * gradient_y;
  if (squared > steepest_squared_) cell.passage = Passage::kSteep;
  cell.tilt_rad = std::atan(static_cast<float>(std::sqrt(squared)));
  cell.rise_m = std::isinf(most_rise_m_) ? 0.0F : static_cast<float>(rise_m);
  if (rise_m > most_rise_m_) cell.passage = Passage::kRough;
}

void GroundJudge::judge_figures(double gradient_x, double gradient_y, double rise_m, GroundCell& cell) const {
  const double tilt = std::atan(std::hypot(gradient_x, gradient_y));
  if (tilt > max_tilt_rad_) cell.passage = Passage::kSteep;
  cell.tilt_rad = std::max(cell.tilt_rad, static_cast<float>(tilt));
  if (std::isinf(most_rise_m_)) return;
  cell.rise_m = std::max(cell.rise_m, static_cast<float>(rise_m));
  if (rise_m + problem_.limits.min_clearance_m > problem_.rover->belly_clearance_m)
    cell.passage = Passage::kRough;
}

void GroundJudge::judge_ground(const dem::Terrain& terrain, const std::vector<Eigen::Vector2d>& places,
                               GroundCell& cell) const {
  for (std::size_t k = 0; k < places.size(); ++k) {
    const std::optional<dem::Cell> under = terrain.geometry().cell_at(places[k].x(), places[k].y());
    Footprint plane;
    if (under && surrounded_by_data(terrain, places[k], circumscribed_m_))
      plane = footprint_of(terrain, *under, reach_x_, reach_y_);
    if (!plane.complete) {
      cell.passage = Passage::kNoData;
      return;
    }
    if (k == places.size() / 2) {
      cell.gradient_x = static_cast<float>(plane.gradient_x);
      cell.gradient_y = static_cast<float>(plane.gradient_y);
    }
    judge_figures(plane.gradient_x, plane.gradient_y, plane.rise_m, cell);
  }
}

GroundCell GroundJudge::cell(const dem::Terrain& terrain, const Eigen::Vector2d& centre) const {
  GroundCell cell{.soil = kUnknownSoil};
  if (problem_.soil_map) {
    const auto soil = problem_.soil_map->soil_at(centre.x(), centre.y());
    if (soil) cell.soil = static_cast<std::uint8_t>(*soil);
  }
  cell.passage = passage_near(keep_out_, centre, 0.5 * std::hypot(geometry_.cell_x_m, geometry_.cell_y_m));
  if (cell.passage == Passage::kKeepOut) return cell;
  std::vector<Eigen::Vector2d> places = judged_places(centre);
  if (places.size() != 1) {
    const auto stands_here = [&](const Waypoint& place) {
      if (grid_index(geometry_, place.x_m, place.y_m) == grid_index(geometry_, centre.x(), centre.y()))
        places = {{place.x_m, place.y_m}};
    };
    stands_here(problem_.start);
    stands_here(problem_.goal);
    for (const Waypoint& place : problem_.waypoints) stands_here(place);
  }
  if (places.empty()) cell.passage = Passage::kNoData;
  judge_ground(terrain, places, cell);
  return cell;
}

void GroundJudge::judge_plane(const float* height, std::ptrdiff_t stride, GroundCell& cell) const {
  // With every cell there the normal equations are diagonal about the centre.
  const dem::GridGeometry& g = problem_.terrain->geometry();
  const double centre = *height;
  double sum = 0.0, along_x = 0.0, along_y = 0.0;
  for (int dr = -reach_y_; dr <= reach_y_; ++dr) {
    const float* const row = height + dr * stride;
    double in_row = 0.0;
    for (int dc = -reach_x_; dc <= reach_x_; ++dc) {
      const double z = row[dc] - centre;
      in_row += z;
      along_x += dc * z;
    }
    sum += in_row;
    along_y -= dr * in_row;
  }
  const int across = 2 * reach_x_ + 1, down = 2 * reach_y_ + 1;
  const double mean = sum / (across * down);
  // The squares of -n to n add up to n (n + 1) (2 n + 1) / 3.
  const double step_x = along_x / (down * (reach_x_ * (reach_x_ + 1) * across / 3));
  const double step_y = along_y / (across * (reach_y_ * (reach_y_ + 1) * down / 3));
  double rise = 0.0;
  for (int dr = -reach_y_; dr <= reach_y_; ++dr) {
    const float* const row = height + dr * stride;
    const double middle = centre + mean - step_y * dr;
    for (int dc = -reach_x_; dc <= reach_x_; ++dc) rise = std::max(rise, row[dc] - (middle + step_x * dc));
  }
  cell.gradient_x = static_cast<float>(step_x / g.cell_x_m);
  cell.gradient_y = static_cast<float>(step_y / g.cell_y_m);
  judge_quickly(step_x / g.cell_x_m, step_y / g.cell_y_m, rise, cell);
}

void GroundJudge::judge_planes(const float* height, std::ptrdiff_t stride, GroundCell& cell) const {
  const std::size_t middle = judged_up_.size() * judged_right_.size() / 2;
  std::size_t place = 0;
  for (const int up : judged_up_) {
    const float* const row = height + (step_y_ - 1 - up) * stride;
    for (const int right : judged_right_) {
      GroundCell at;
      judge_plane(row + right, stride, at);
      if (place++ == middle) {
        cell.gradient_x = at.gradient_x;
        cell.gradient_y = at.gradient_y;
      }
      cell.tilt_rad = std::max(cell.tilt_rad, at.tilt_rad);
      cell.rise_m = std::max(cell.rise_m, at.rise_m);
      if (at.passage != Passage::kFree) cell.passage = at.passage;
    }
  }
}

void GroundJudge::cells(const dem::Terrain& terrain, const dem::Cell& first, const dem::CellWindow& window,
                        GroundCell* out, std::size_t stride) const {
  // In the terrain's cells.
  const int north = window.row * step_y_ - first.row, west = window.column * step_x_ - first.column;
  // Centres that lie between the terrain's cells are left to cell(): rounding decides which of these they are
  // in.
  const bool of_many = judged_right_.size() * judged_up_.size() > 1;
  const float* const heights =
      of_many && judges_centres_
          ? nullptr
          : terrain.heights_in({north - margin_, west - margin_, window.rows * step_y_ + 2 * margin_,
                                window.columns * step_x_ + 2 * margin_});
  const std::ptrdiff_t columns = terrain.geometry().columns;
  const Eigen::Vector2d middle =
      0.5 * (geometry_.centre_m({window.row, window.column}) +
             geometry_.centre_m({window.row + window.rows - 1, window.column + window.columns - 1}));
  const double reach =
      0.5 * std::hypot(window.rows * geometry_.cell_y_m, window.columns * geometry_.cell_x_m);
  const bool clear = keep_out_.empty() || keep_out_.clear_at_any_heading(middle.x(), middle.y(), reach);
  // Of a soil map of one cell.
  const bool one_soil = !problem_.soil_map || (problem_.soil_map->geometry().rows == 1 &&
                                               problem_.soil_map->geometry().columns == 1);
  std::uint8_t soil = kUnknownSoil;
  if (problem_.soil_map)
    if (const auto there = problem_.soil_map->soil_at(middle.x(), middle.y()))
      soil = static_cast<std::uint8_t>(*there);
  for (int row = 0; row < window.rows; ++row) {
    for (int column = 0; column < window.columns; ++column) {
      GroundCell& to = out[static_cast<std::size_t>(row) * stride + static_cast<std::size_t>(column)];
      const Eigen::Vector2d centre = geometry_.centre_m({window.row + row, window.column + column});
      if (!heights || !clear || (of_many && holds_a_place(centre))) {
        to = cell(terrain, centre);
        continue;
      }
      to = GroundCell{.soil = one_soil ? soil : kUnknownSoil};
      if (!one_soil)
        if (const auto there = problem_.soil_map->soil_at(centre.x(), centre.y()))
          to.soil = static_cast<std::uint8_t>(*there);
      const float* const height = heights + (margin_ + row * step_y_) * columns + margin_ + column * step_x_;
      if (of_many)
        judge_planes(height, columns, to);
      else
        judge_plane(height, columns, to);
    }
  }
}

}  // namespace slipway::planner
