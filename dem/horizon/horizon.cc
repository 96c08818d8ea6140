#include "dem/horizon/horizon.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>
#include <utility>

#include "dem/horizon/ray_direction.h"

namespace slipway::dem {
namespace {

constexpr double kNothing = -std::numeric_limits<double>::infinity();

// A ray over the ground: where it begins, and what the tangent of an elevation is at a distance.
struct Ray {
  double x_m, y_m, azimuth_rad;
  double eye_height_m;  // in the terrain's heights
  double body_radius_m;

  double tangent(double height_m, double distance_m) const {
    return (height_m - eye_height_m) / distance_m - 0.5 * distance_m / body_radius_m;
  }
  // The greatest tangent that ground up to a height may have between two distances.
  double bound(double height_m, double from_m, double to_m) const {
    const double below = eye_height_m - height_m;
    if (below <= 0.0) return tangent(height_m, from_m);
    return tangent(height_m, std::clamp(std::sqrt(2.0 * body_radius_m * below), from_m, to_m));
  }
};

}  // namespace

// The greatest heights of ever larger blocks of the surface's patches; a patch lies between four centres. A
// ray looks into a block only where its greatest height would raise the horizon.
class Horizon::Field {
 public:
  explicit Field(std::shared_ptr<const Terrain> terrain) : terrain_(std::move(terrain)) {
    const GridGeometry& geometry = terrain_->geometry();
    rows_ = geometry.rows;
    columns_ = geometry.columns;
    add_first_level();
    while (levels_.back().rows * levels_.back().columns > 1) add_coarser_level();
  }

  const Terrain& terrain() const { return *terrain_; }

  // Raises the tangent of the horizon by what lies on the ray from a distance on. Returns where it leaves the
  // terrain.
  double raise(const Ray& ray, double from_m, double& best) const {
    if (rows_ < 2 || columns_ < 2) return from_m;
    const GridGeometry& geometry = terrain_->geometry();
    const Eigen::Vector2d start = geometry.fractional_index(ray.x_m, ray.y_m);
    const Eigen::Vector2d per_m = index_per_m(geometry, ray.azimuth_rad);
    const Line line{start.x(), start.y(), per_m.x(), per_m.y()};
    const auto [enters, leaves] = line.inside(rows_ - 1, columns_ - 1);
    const double nudge = 1e-7 * std::min(geometry.cell_x_m, geometry.cell_y_m);
    double d = std::max(from_m, enters) + nudge;
    look_along(ray, line, d, leaves, best);
    std::size_t level = levels_.size() - 1;
    while (d < leaves) {
      const int shift = kFirstShift + static_cast<int>(level), size = 1 << shift;
      const int row = line.row_at(d, rows_ - 2) >> shift, column = line.column_at(d, columns_ - 2) >> shift;
      const double end = std::min(leaves, line.leaves_block(row * size, column * size, size));
      const double to = std::max(end, d + nudge);
      if (ray.bound(levels_[level].at(row, column), d, to) <= best) {
        d = to + nudge;
        level = std::min(level + 1, levels_.size() - 1);
      } else if (level > 0) {
        --level;
      } else {
        raise_in_patches(ray, line, d, to, nudge, best);
        d = to + nudge;
      }
    }
    return leaves;
  }

 private:
  // Patches along a side of a block of the finest level.
  static constexpr int kFirstShift = 2, kFirstBlock = 1 << kFirstShift;

  // In rows and columns, whole numbers at cell centres.
  struct Line {
    double row, column, rows_m, columns_m;  // where it begins, and of a metre

    int row_at(double d, int most) const {
      return std::clamp(static_cast<int>(std::floor(row + rows_m * d)), 0, most);
    }
    int column_at(double d, int most) const {
      return std::clamp(static_cast<int>(std::floor(column + columns_m * d)), 0, most);
    }
    static double crossing(double from, double rate, double low, double high) {
      if (rate == 0.0) return std::numeric_limits<double>::infinity();
      return ((rate > 0.0 ? high : low) - from) / rate;
    }
    double leaves_block(int first_row, int first_column, int size) const {
      return std::min(crossing(row, rows_m, first_row, first_row + size),
                      crossing(column, columns_m, first_column, first_column + size));
    }
    // Distances between which it runs over [0, rows] x [0, columns]; the first beyond the second where it
    // does not.
    std::pair<double, double> inside(double rows, double columns) const {
      double from = 0.0, to = std::numeric_limits<double>::infinity();
      for (const auto& [at, rate, most] :
           {std::tuple{row, rows_m, rows}, std::tuple{column, columns_m, columns}}) {
        if (rate == 0.0) {
          if (at < 0.0 || at > most) to = -1.0;
          continue;
        }
        const double low = -at / rate, high = (most - at) / rate;
        from = std::max(from, std::min(low, high));
        to = std::min(to, std::max(low, high));
      }
      return {from, to};
    }
  };

  struct Level {
    int rows = 0, columns = 0;
    std::vector<float> greatest_m;
    float at(int row, int column) const {
      return greatest_m[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                        static_cast<std::size_t>(column)];
    }
  };

  void add_first_level() {
    Level level{(std::max(1, rows_ - 1) + kFirstBlock - 1) / kFirstBlock,
                (std::max(1, columns_ - 1) + kFirstBlock - 1) / kFirstBlock,
                {}};
    for (int row = 0; row < level.rows; ++row)
      for (int column = 0; column < level.columns; ++column) {
        float greatest = -std::numeric_limits<float>::infinity();
        for (int r = row * kFirstBlock; r <= std::min(rows_ - 1, (row + 1) * kFirstBlock); ++r)
          for (int c = column * kFirstBlock; c <= std::min(columns_ - 1, (column + 1) * kFirstBlock); ++c)
            if (const auto height = terrain_->height_m({r, c}))
              greatest = std::max(greatest, static_cast<float>(*height));
        level.greatest_m.push_back(greatest);
      }
    levels_.push_back(std::move(level));
  }

  void add_coarser_level() {
    const Level& fine = levels_.back();
    Level level{(fine.rows + 1) / 2, (fine.columns + 1) / 2, {}};
    for (int row = 0; row < level.rows; ++row)
      for (int column = 0; column < level.columns; ++column) {
        float greatest = -std::numeric_limits<float>::infinity();
        for (int r = 2 * row; r < std::min(fine.rows, 2 * row + 2); ++r)
          for (int c = 2 * column; c < std::min(fine.columns, 2 * column + 2); ++c)
            greatest = std::max(greatest, fine.at(r, c));
        level.greatest_m.push_back(greatest);
      }
    levels_.push_back(std::move(level));
  }

  // The height of the patch at a distance, of the line's place in it.
  double height_in_patch(const float* north, const Line& line, int row, int column, double d) const {
    const double v = std::clamp(line.row + line.rows_m * d - row, 0.0, 1.0),
                 u = std::clamp(line.column + line.columns_m * d - column, 0.0, 1.0);
    const float* const south = north + columns_;
    return (1.0 - v) * ((1.0 - u) * north[0] + u * north[1]) + v * ((1.0 - u) * south[0] + u * south[1]);
  }

  // Ground at ever greater distances: the sooner a high horizon is known, the fewer blocks are looked into.
  void look_along(const Ray& ray, const Line& line, double from_m, double to_m, double& best) const {
    constexpr double kFurther = 1.15;
    for (double d = from_m; d < to_m; d *= kFurther) {
      const int row = line.row_at(d, rows_ - 2), column = line.column_at(d, columns_ - 2);
      if (const float* const heights = terrain_->heights_in({row, column, 2, 2}))
        best = std::max(best, ray.tangent(height_in_patch(heights, line, row, column, d), d));
    }
  }

  // Along the ray a patch's height is a parabola, whose tangent is greatest at an end or where it turns.
  void raise_in_patches(const Ray& ray, const Line& line, double from_m, double to_m, double nudge,
                        double& best) const {
    double d = from_m;
    while (d < to_m) {
      const int row = line.row_at(d, rows_ - 2), column = line.column_at(d, columns_ - 2);
      const double end = std::max(std::min(to_m, line.leaves_block(row, column, 1)), d + nudge);
      const float* const heights = terrain_->heights_in({row, column, 2, 2});
      const auto highest = [&] {
        return std::max(std::max(heights[0], heights[1]), std::max(heights[columns_], heights[columns_ + 1]));
      };
      if (heights != nullptr && ray.bound(highest(), d, end) > best) {
        const auto height_at = [&](double at) { return height_in_patch(heights, line, row, column, at); };
        const double first = height_at(d), last = height_at(end), middle = height_at(0.5 * (d + end));
        best = std::max({best, ray.tangent(first, d), ray.tangent(last, end)});
        const double length = end - d;
        const double bend = 2.0 * (first - 2.0 * middle + last) / (length * length);
        const double slope = (last - first) / length - bend * (d + end);
        const double over_eye = first - slope * d - bend * d * d - ray.eye_height_m;
        const double turn = std::sqrt(over_eye / (bend - 0.5 / ray.body_radius_m));
        if (over_eye < 0.0 && turn > d && turn < end)
          best = std::max(best, ray.tangent(height_at(turn), turn));
      }
      d = end + nudge;
    }
  }

  std::shared_ptr<const Terrain> terrain_;
  int rows_ = 0, columns_ = 0;
  std::vector<Level> levels_;
};

Horizon::Horizon(std::shared_ptr<const Terrain> terrain, double body_radius_m,
                 std::shared_ptr<const Terrain> around)
    : near_(std::make_unique<Field>(std::move(terrain))), body_radius_m_(body_radius_m) {
  if (around) around_ = std::make_unique<Field>(std::move(around));
}

Horizon::~Horizon() = default;
Horizon::Horizon(Horizon&&) noexcept = default;

std::optional<double> Horizon::elevation_rad(double x_m, double y_m, double eye_m, double azimuth_rad) const {
  const std::optional<double> ground = near_->terrain().height_m(x_m, y_m);
  if (!ground) return std::nullopt;
  const Ray ray{x_m, y_m, azimuth_rad, *ground + eye_m, body_radius_m_};
  double best = kNothing;
  // Within half a cell there is but the slope that the rover itself stands on.
  const GridGeometry& geometry = near_->terrain().geometry();
  const double leaves = near_->raise(ray, 0.5 * std::min(geometry.cell_x_m, geometry.cell_y_m), best);
  if (around_) around_->raise(ray, std::max(0.0, leaves), best);
  return std::atan(best);
}

std::optional<std::vector<double>> Horizon::all_around_rad(double x_m, double y_m, double eye_m, int count,
                                                           double first_rad) const {
  std::vector<double> all;
  for (int k = 0; k < count; ++k) {
    const auto one = elevation_rad(x_m, y_m, eye_m, first_rad + 2.0 * std::numbers::pi * k / count);
    if (!one) return std::nullopt;
    all.push_back(*one);
  }
  return all;
}

double horizon_between_rad(const std::vector<double>& all_around_rad, double azimuth_rad) {
  const auto count = static_cast<double>(all_around_rad.size());
  const double place = std::fmod(azimuth_rad / (2.0 * std::numbers::pi) + 1.0, 1.0) * count;
  const auto before = static_cast<std::size_t>(place) % all_around_rad.size();
  const double share = place - std::floor(place);
  return (1.0 - share) * all_around_rad[before] +
         share * all_around_rad[(before + 1) % all_around_rad.size()];
}

}  // namespace slipway::dem
