#include "planner/maps/cell_ground.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace slipway::planner {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

// Of the square to each side of its cell, in cells, as TraverseMap has it.
int footprint_reach(const sim::RoverModel& rover, double cell_m) {
  const double half_width = 0.5 * std::min(rover.body_length_m, rover.body_width_m);
  return std::max(1, static_cast<int>(std::lround(half_width / cell_m)));
}

// Heights of a window with a margin around it, as floats above the first one; NaN where there is none.
class Heights {
 public:
  Heights(const dem::Terrain& terrain, const dem::CellWindow& window, int margin)
      : columns_(window.columns + 2 * margin), margin_(margin) {
    const int rows = window.rows + 2 * margin;
    z_.resize(static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns_));
    std::size_t i = 0;
    for (int r = 0; r < rows; ++r) {
      for (int c = 0; c < columns_; ++c, ++i) {
        const auto z = terrain.height_m(dem::Cell{window.row - margin + r, window.column - margin + c});
        if (z && whole_first_) {
          first_ = *z;
          whole_first_ = false;
        }
        z_[i] = z ? static_cast<float>(*z - first_) : kNone;
        missing_ |= !z;
      }
    }
  }

  bool any_missing() const { return missing_; }
  // Rows and columns count from the window's own.
  const float* row(int r) const {
    return z_.data() + static_cast<std::size_t>(r + margin_) * static_cast<std::size_t>(columns_) + margin_;
  }

 private:
  int columns_, margin_;
  std::vector<float> z_;
  double first_ = 0.0;
  bool whole_first_ = true, missing_ = false;
};

// Planes of complete squares: sums over columns, then over rows.
void fit_planes(const Heights& heights, const dem::CellWindow& window, const dem::GridGeometry& g,
                int reach_x, int reach_y, CellGround& ground) {
  const int wide = 2 * reach_x + 1, high = 2 * reach_y + 1;
  double squares_x = 0.0, squares_y = 0.0;
  for (int d = 1; d <= reach_x; ++d) squares_x += 2.0 * d * d;
  for (int d = 1; d <= reach_y; ++d) squares_y += 2.0 * d * d;
  const auto columns = static_cast<std::size_t>(window.columns);
  const auto rows = static_cast<std::size_t>(window.rows + 2 * reach_y);
  std::vector<double> sum(rows * columns), moment(rows * columns);
  for (std::size_t r = 0; r < rows; ++r) {
    const float* z = heights.row(static_cast<int>(r) - reach_y);
    for (int c = 0; c < window.columns; ++c) {
      double total = z[c], turning = 0.0;
      for (int d = 1; d <= reach_x; ++d) {
        total += static_cast<double>(z[c - d]) + z[c + d];
        turning += d * (static_cast<double>(z[c + d]) - z[c - d]);
      }
      sum[r * columns + static_cast<std::size_t>(c)] = total;
      moment[r * columns + static_cast<std::size_t>(c)] = turning;
    }
  }
  const double scale_x = 1.0 / (squares_x * high * g.cell_x_m),
               scale_y = 1.0 / (squares_y * wide * g.cell_y_m);
  for (std::size_t r = 0; r < static_cast<std::size_t>(window.rows); ++r) {
    for (std::size_t c = 0; c < columns; ++c) {
      double along_x = 0.0, along_y = 0.0;
      for (int d = 0; d < high; ++d) {
        const std::size_t at = (r + static_cast<std::size_t>(d)) * columns + c;
        along_x += moment[at];
        along_y -= (d - reach_y) * sum[at];  // rows count towards the south
      }
      ground.gradient_x[r * columns + c] = static_cast<float>(along_x * scale_x);
      ground.gradient_y[r * columns + c] = static_cast<float>(along_y * scale_y);
    }
  }
}

void find_rises(const Heights& heights, const dem::CellWindow& window, const dem::GridGeometry& g,
                int reach_x, int reach_y, CellGround& ground) {
  const double cells = (2.0 * reach_x + 1.0) * (2.0 * reach_y + 1.0);
  for (int r = 0; r < window.rows; ++r) {
    for (int c = 0; c < window.columns; ++c) {
      const std::size_t i = static_cast<std::size_t>(r) * static_cast<std::size_t>(window.columns) +
                            static_cast<std::size_t>(c);
      const double across = ground.gradient_x[i] * g.cell_x_m, down = -ground.gradient_y[i] * g.cell_y_m;
      double mean = 0.0, highest = -std::numeric_limits<double>::infinity();
      for (int dr = -reach_y; dr <= reach_y; ++dr) {
        const float* z = heights.row(r + dr);
        for (int dc = -reach_x; dc <= reach_x; ++dc) {
          mean += z[c + dc];
          highest = std::max(highest, z[c + dc] - across * dc - down * dr);
        }
      }
      ground.rise_m[i] = static_cast<float>(highest - mean / cells);
    }
  }
}

// No plane where a cell within a cell of the body's circle has no elevation: heights are bilinear.
void mask_near_missing(const Heights& heights, const dem::CellWindow& window, const dem::GridGeometry& g,
                       const dem::Extent& map, int margin, double radius_m, CellGround& ground) {
  const int reach_r = static_cast<int>(std::ceil(radius_m / g.cell_y_m)) + 1;
  const int reach_c = static_cast<int>(std::ceil(radius_m / g.cell_x_m)) + 1;
  for (int r = -margin; r < window.rows + margin; ++r) {
    const float* z = heights.row(r);
    for (int c = -margin; c < window.columns + margin; ++c) {
      if (!std::isnan(z[c])) continue;
      const Eigen::Vector2d centre = g.centre_m({window.row + r, window.column + c});
      if (!map.contains(centre.x(), centre.y())) continue;  // see mask_near_edges()
      for (int at_r = std::max(0, r - reach_r); at_r <= std::min(window.rows - 1, r + reach_r); ++at_r) {
        for (int at_c = std::max(0, c - reach_c); at_c <= std::min(window.columns - 1, c + reach_c); ++at_c) {
          const double away = std::hypot(std::max(0, std::abs(at_r - r) - 1) * g.cell_y_m,
                                         std::max(0, std::abs(at_c - c) - 1) * g.cell_x_m);
          if (away < radius_m)
            ground.gradient_x[static_cast<std::size_t>(at_r) * static_cast<std::size_t>(window.columns) +
                              static_cast<std::size_t>(at_c)] = kNone;
        }
      }
    }
  }
}

void mask_near_edges(const dem::GridGeometry& terrain, const dem::CellWindow& window, const dem::Extent& map,
                     double radius_m, CellGround& ground) {
  for (int r = 0; r < window.rows; ++r) {
    for (int c = 0; c < window.columns; ++c) {
      const Eigen::Vector2d centre = terrain.centre_m({window.row + r, window.column + c});
      if (centre.x() - radius_m < map.west_m || centre.x() + radius_m > map.east_m ||
          centre.y() - radius_m < map.south_m || centre.y() + radius_m > map.north_m)
        ground.gradient_x[static_cast<std::size_t>(r) * static_cast<std::size_t>(window.columns) +
                          static_cast<std::size_t>(c)] = kNone;
    }
  }
}

}  // namespace

int reach_in_cells(const sim::RoverModel& rover, const dem::GridGeometry& geometry) {
  const double cell_m = std::min(geometry.cell_x_m, geometry.cell_y_m);
  return std::max({footprint_reach(rover, geometry.cell_x_m), footprint_reach(rover, geometry.cell_y_m),
                   static_cast<int>(std::ceil(rover.circumscribed_m() / cell_m)) + 1});
}

CellGround cell_ground(const dem::Terrain& terrain, const dem::CellWindow& window, const dem::Extent& map,
                       const sim::RoverModel& rover, bool with_rise) {
  const dem::GridGeometry& g = terrain.geometry();
  const int reach_x = footprint_reach(rover, g.cell_x_m), reach_y = footprint_reach(rover, g.cell_y_m);
  const int margin = reach_in_cells(rover, g);
  const Heights heights(terrain, window, margin);
  const std::size_t cells = static_cast<std::size_t>(window.rows) * static_cast<std::size_t>(window.columns);
  CellGround ground;
  ground.gradient_x.resize(cells);
  ground.gradient_y.resize(cells);
  ground.has_elevation.resize(cells);
  for (int r = 0; r < window.rows; ++r)
    for (int c = 0; c < window.columns; ++c)
      ground.has_elevation[static_cast<std::size_t>(r) * static_cast<std::size_t>(window.columns) +
                           static_cast<std::size_t>(c)] = std::isnan(heights.row(r)[c]) ? 0 : 1;
  fit_planes(heights, window, g, reach_x, reach_y, ground);
  if (with_rise) {
    ground.rise_m.resize(cells);
    find_rises(heights, window, g, reach_x, reach_y, ground);
  }
  if (heights.any_missing())
    mask_near_missing(heights, window, g, map, margin, rover.circumscribed_m(), ground);
  mask_near_edges(g, window, map, rover.circumscribed_m(), ground);
  return ground;
}

}  // namespace slipway::planner
