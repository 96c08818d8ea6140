#include "planner/search/only_way.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <map>

#include "core/angle.h"
#include "planner/search/graph_search.h"
#include "planner/search/overlap.h"

namespace slipway::planner {
namespace {

constexpr double kFromEnds_cells = 4.0;
constexpr double kWidestGap_m = 15.0;  // to each side; wider is no gap

bool open_cell(const TraverseMap& map, long long index) {
  return index >= 0 && is_open(map.cell(static_cast<std::size_t>(index)).passage);
}

struct Gap {
  Eigen::Vector2d left, right;  // the first closed places on both sides
  double width_m() const { return (left - right).norm(); }
};

// Across the route at a place; nothing where a side is open for long.
std::optional<Gap> gap_at(const TraverseMap& map, const Eigen::Vector2d& place,
                          const Eigen::Vector2d& across) {
  const double step = 0.5 * map.cell_m();
  std::array<Eigen::Vector2d, 2> ends;
  for (int side = 0; side < 2; ++side) {
    const Eigen::Vector2d out = side == 0 ? across : Eigen::Vector2d(-across);
    double away = 0.0;
    Eigen::Vector2d p = place;
    while (open_cell(map, map.index_at(p.x(), p.y()))) {
      away += step;
      if (away > kWidestGap_m) return std::nullopt;
      p = place + away * out;
    }
    ends[side] = p;
  }
  return Gap{ends[0], ends[1]};
}

std::optional<Gap> narrowest_gap(const TraverseMap& map, const std::vector<Eigen::Vector2d>& line) {
  std::optional<Gap> narrowest;
  for (std::size_t i = 1; i + 1 < line.size(); ++i) {
    const Eigen::Vector2d along = line[i + 1] - line[i - 1];
    // A gap at the very start or goal says nothing about the way between them.
    const double from_end = std::min((line[i] - line.front()).norm(), (line[i] - line.back()).norm());
    if (along.norm() < 1e-9 || from_end < kFromEnds_cells * map.cell_m()) continue;
    const std::optional<Gap> gap =
        gap_at(map, line[i], Eigen::Vector2d(-along.y(), along.x()) / along.norm());
    if (gap && (!narrowest || gap->width_m() < narrowest->width_m())) narrowest = gap;
  }
  return narrowest;
}

// Cells that can be reached over edges from a cell, those in `closed` left out. Diagonal neighbours touch.
std::vector<std::uint8_t> reached_from(const TraverseMap& map, long long start,
                                       const std::vector<std::uint8_t>& closed) {
  if (start < 0) return std::vector<std::uint8_t>(map.cells(), 0);
  return reachable(map.cells(), static_cast<std::size_t>(start), [&](std::size_t cell, const auto& reach) {
    const dem::Cell at = map.place_of(cell);
    for (int row = at.row - 1; row <= at.row + 1; ++row) {
      for (int column = at.column - 1; column <= at.column + 1; ++column) {
        const long long next = map.index_of(row, column);
        if (!open_cell(map, next)) continue;
        const auto i = static_cast<std::size_t>(next);
        if (closed.empty() || closed[i] == 0) reach(i);
      }
    }
  });
}

std::vector<std::uint8_t> closed_across(const TraverseMap& map, const Gap& gap) {
  std::vector<std::uint8_t> closed(map.cells(), 0);
  const double step = 0.25 * map.cell_m();
  const int pieces = static_cast<int>(std::ceil(gap.width_m() / step));
  for (int k = 0; k <= pieces; ++k) {
    const Eigen::Vector2d p = gap.left + (gap.right - gap.left) * k / std::max(1, pieces);
    // As thick as a cell to each side, so that no diagonal slips through.
    for (const double dx : {-0.5, 0.0, 0.5}) {
      for (const double dy : {-0.5, 0.0, 0.5}) {
        const long long i = map.index_at(p.x() + dx * map.cell_m(), p.y() + dy * map.cell_m());
        if (i >= 0) closed[static_cast<std::size_t>(i)] = 1;
      }
    }
  }
  return closed;
}

std::string_view words(Passage passage) {
  switch (passage) {
    case Passage::kNoData:
      return "without elevation near by";
    case Passage::kSteep:
      return "steeper than the limit";
    case Passage::kRough:
      return "too rough for the belly";
    case Passage::kKeepOut:
      return "in a keep-out or outside a keep-in";
    case Passage::kFree:
    case Passage::kNearKeepOut:
      break;
  }
  return "passable";
}

}  // namespace

std::optional<std::string> only_way(const TraverseMap& map, const std::vector<Motion>& route) {
  const std::vector<Eigen::Vector2d> line = centreline(route, 0.5 * map.cell_m());
  const std::optional<Gap> narrowest = narrowest_gap(map, line);
  if (!narrowest) return std::nullopt;
  const long long start = map.index_at(line.front().x(), line.front().y());
  const long long goal = map.index_at(line.back().x(), line.back().y());
  std::vector<std::uint8_t> closed = closed_across(map, *narrowest);
  if (closed[static_cast<std::size_t>(start)] != 0 || closed[static_cast<std::size_t>(goal)] != 0)
    return std::nullopt;
  if (reached_from(map, start, closed)[static_cast<std::size_t>(goal)] != 0) return std::nullopt;
  return fmt::format(
      "every way from the start to the goal passes one gap: {:.1f} m of ground that the rover's centre may "
      "use, "
      "between ({:.1f}, {:.1f}) and ({:.1f}, {:.1f})",
      narrowest->width_m(), narrowest->left.x(), narrowest->left.y(), narrowest->right.x(),
      narrowest->right.y());
}

std::string hardest_place(const TraverseMap& map, const std::vector<std::size_t>& way) {
  std::vector<Eigen::Vector2d> line;
  std::size_t steepest = way.front();
  for (const std::size_t cell : way) {
    line.push_back(map.centre_m(cell));
    if (map.cell(cell).tilt_rad > map.cell(steepest).tilt_rad) steepest = cell;
  }
  const Eigen::Vector2d place = map.centre_m(steepest);
  std::string words = fmt::format("the grid's way is steepest at ({:.1f}, {:.1f}): {:.1f} deg", place.x(),
                                  place.y(), deg_from_rad(map.cell(steepest).tilt_rad));
  if (const std::optional<Gap> gap = narrowest_gap(map, line))
    words += fmt::format(
        ", and narrowest between ({:.1f}, {:.1f}) and ({:.1f}, {:.1f}): {:.1f} m that the rover's centre may "
        "use",
        gap->left.x(), gap->left.y(), gap->right.x(), gap->right.y(), gap->width_m());
  return words;
}

std::string no_way(const TraverseMap& map, double start_x_m, double start_y_m, double goal_x_m,
                   double goal_y_m) {
  const long long start = map.index_at(start_x_m, start_y_m);
  const long long goal = map.index_at(goal_x_m, goal_y_m);
  const std::vector<std::uint8_t> reached = reached_from(map, start, {});
  if (goal >= 0 && reached[static_cast<std::size_t>(goal)] != 0) {
    return fmt::format(
        "no drivable way from ({:.1f}, {:.1f}) to ({:.1f}, {:.1f}): no cell closes it, but the slopes "
        "between them "
        "immobilise the rover on the mean soils in the directions that lead to the goal",
        start_x_m, start_y_m, goal_x_m, goal_y_m);
  }
  const long long columns = map.geometry().columns;
  std::map<Passage, long long> border;
  long long cells = 0;
  for (std::size_t i = 0; i < reached.size(); ++i) {
    if (reached[i] == 0) continue;
    ++cells;
    const auto at = static_cast<long long>(i);
    for (const long long next : {at - columns, at + columns, at - 1, at + 1}) {
      if (next < 0 || next >= static_cast<long long>(reached.size()) || open_cell(map, next)) continue;
      ++border[map.cell(static_cast<std::size_t>(next)).passage];
    }
  }
  std::string what;
  for (const auto& [passage, count] : border)
    what += fmt::format("{}{} cells {}", what.empty() ? "" : ", ", count, words(passage));
  const double area = static_cast<double>(cells) * map.geometry().cell_x_m * map.geometry().cell_y_m;
  return fmt::format(
      "no way from ({:.1f}, {:.1f}) to ({:.1f}, {:.1f}): from the start {:.0f} m2 can be reached, closed in "
      "by {}",
      start_x_m, start_y_m, goal_x_m, goal_y_m, area, what.empty() ? "the edge of the map" : what);
}

}  // namespace slipway::planner
