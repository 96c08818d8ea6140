#include "dem/rock_field.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.h"

namespace slipway::dem {
namespace {

// Golombek and Rapp's q(k).
double decay_1_m(const RockField& field) {
  return 1.79 + 0.152 / field.cover_share;
}

// F_k(D).
double share_of_at_least(const RockField& field, double diameter_m) {
  return field.cover_share * std::exp(-decay_1_m(field) * diameter_m);
}

// Rocks are drawn as a Poisson process, square by square. Their number per area and diameter is that of F_k,
//
//   n(D) = -F_k'(D) / (pi D^2 / 4),
//
// drawn from its envelope ~ 1 / D^2 and accepted with exp(-q (D - smallest)).
class Scatterer {
 public:
  explicit Scatterer(const RockField& field) : field_(field), decay_1_m_(decay_1_m(field)) {
    const double covered = covered_share(field);
    // Discs that overlap as if thrown cover 1 - exp(-sum of their areas).
    const double overlap = covered > 0.0 ? -std::log1p(-covered) / covered : 1.0;
    const double envelope = 4.0 / std::numbers::pi * decay_1_m_ * share_of_at_least(field, field.smallest_m) *
                            (1.0 / field.smallest_m - 1.0 / field.largest_m);
    per_square_ = overlap * envelope * side_m() * side_m();
  }

  double side_m() const { return field_.largest_m; }

  void scatter(std::int64_t column, std::int64_t row, std::vector<Rock>& rocks) const {
    // Both indices in one number, as many squares either way as no grid has.
    constexpr std::int64_t kHalf = std::int64_t{1} << 24U;
    const std::uint64_t key =
        random_key(field_.seed, static_cast<std::uint64_t>((row + kHalf) * 2 * kHalf + column + kHalf));
    double arrived = 0.0;
    for (std::uint64_t i = 0;; ++i) {
      arrived -= std::log(random_uniform(key, 5 * i));
      if (arrived > per_square_) return;
      const double diameter_m =
          1.0 / (1.0 / field_.smallest_m -
                 random_uniform(key, 5 * i + 1) * (1.0 / field_.smallest_m - 1.0 / field_.largest_m));
      if (random_uniform(key, 5 * i + 2) > std::exp(-decay_1_m_ * (diameter_m - field_.smallest_m))) continue;
      rocks.push_back({.x_m = (static_cast<double>(column) + random_uniform(key, 5 * i + 3)) * side_m(),
                       .y_m = (static_cast<double>(row) + random_uniform(key, 5 * i + 4)) * side_m(),
                       .diameter_m = diameter_m});
    }
  }

 private:
  const RockField& field_;
  double decay_1_m_;
  double per_square_ = 0.0;  // of the envelope
};

}  // namespace

double covered_share(const RockField& field) {
  return share_of_at_least(field, field.smallest_m) - share_of_at_least(field, field.largest_m);
}

std::vector<Rock> rocks_in(const RockField& field, const Extent& extent) {
  std::vector<Rock> rocks;
  if (!(field.largest_m > field.smallest_m)) return rocks;
  const Scatterer scatterer(field);
  const auto square_of = [&](double at_m) {
    return static_cast<std::int64_t>(std::floor(at_m / scatterer.side_m()));
  };
  const double reach_m = 0.5 * field.largest_m;
  for (std::int64_t row = square_of(extent.south_m - reach_m); row <= square_of(extent.north_m + reach_m);
       ++row)
    for (std::int64_t column = square_of(extent.west_m - reach_m);
         column <= square_of(extent.east_m + reach_m); ++column)
      scatterer.scatter(column, row, rocks);
  return rocks;
}

void add_rocks(const RockField& field, const GridGeometry& geometry, std::vector<float>& heights) {
  std::vector<double> above_m(heights.size(), 0.0);
  for (const Rock& rock : rocks_in(field, geometry.extent())) {
    const double radius_m = 0.5 * rock.diameter_m, height_m = field.height_share * rock.diameter_m;
    const auto window =
        geometry.window({rock.x_m - radius_m, rock.y_m - radius_m, rock.x_m + radius_m, rock.y_m + radius_m});
    if (!window) continue;
    for (int row = window->row; row < window->row + window->rows; ++row) {
      for (int column = window->column; column < window->column + window->columns; ++column) {
        const Eigen::Vector2d centre = geometry.centre_m({row, column});
        const double from = std::hypot(centre.x() - rock.x_m, centre.y() - rock.y_m) / radius_m;
        if (from >= 1.0) continue;
        double& above = above_m[static_cast<std::size_t>(row) * static_cast<std::size_t>(geometry.columns) +
                                static_cast<std::size_t>(column)];
        above = std::max(above, height_m * std::sqrt(1.0 - from * from));
      }
    }
  }
  for (std::size_t i = 0; i < heights.size(); ++i) heights[i] += static_cast<float>(above_m[i]);
}

}  // namespace slipway::dem
