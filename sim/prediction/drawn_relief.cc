#include "sim/prediction/drawn_relief.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/random.h"

namespace slipway::sim {
namespace {

enum Stream : std::uint64_t { kError, kRoughness, kRocks, kThinning };

constexpr int kSteps = 400;  // of the integral over widths; its error is below 1e-4 of it

std::uint64_t cell_key(std::uint64_t key, double column, double row) {
  return random_key(random_key(key, static_cast<std::uint64_t>(static_cast<long long>(column))),
                    static_cast<std::uint64_t>(static_cast<long long>(row)));
}

// Rocks on a square metre by metre of their width, where they cover the share k.
double per_width(double k, double width_m) {
  const double q = 1.79 + 0.152 / k;
  return k * q * std::exp(-q * width_m) / (std::numbers::pi * width_m * width_m / 4.0);
}

}  // namespace

double rocks_per_m2(const ReliefSpread& spread, double min_width_m) {
  if (spread.rock_share <= 0.0 || spread.max_rock_m <= min_width_m) return 0.0;
  const double step = (spread.max_rock_m - min_width_m) / kSteps;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) sum += per_width(spread.rock_share, min_width_m + (i + 0.5) * step) * step;
  return sum;
}

DrawnRelief::DrawnRelief(const Ground& ground, const ReliefSpread& spread, std::uint64_t key,
                         const std::optional<StandingPlace>& standing)
    : ground_(ground),
      spread_(spread),
      key_(key),
      standing_(standing),
      rocks_per_m2_(rocks_per_m2(spread, spread.min_rock_m)) {
  if (rocks_per_m2_ <= 0.0) return;
  // Down the widths, where as many are wider as each share asks for.
  constexpr int kQuantiles = 64;
  const double step = (spread.max_rock_m - spread.min_rock_m) / kSteps;
  double wider = 0.0, width = spread.max_rock_m;
  widths_m_.push_back(width);
  for (int i = 1; i < kQuantiles; ++i) {
    const double wanted = rocks_per_m2_ * i / kQuantiles;
    double here = per_width(spread.rock_share, width - 0.5 * step) * step;
    while (wider + here < wanted && width - step > spread.min_rock_m) {
      wider += here;
      width -= step;
      here = per_width(spread.rock_share, width - 0.5 * step) * step;
    }
    widths_m_.push_back(width - step * std::clamp((wanted - wider) / here, 0.0, 1.0));
  }
  widths_m_.push_back(spread.min_rock_m);
}

// The corners' numbers, blended by the smooth step 3 t^2 - 2 t^3, over the root of the weights' squares.
DrawnRelief::Rise DrawnRelief::noise(std::uint64_t key, double deviation_m, double length_m, double x_m,
                                     double y_m) {
  if (deviation_m <= 0.0) return {};
  const double u = x_m / length_m, v = y_m / length_m;
  const double column = std::floor(u), row = std::floor(v), a = u - column, b = v - row;
  const double s = a * a * (3.0 - 2.0 * a), t = b * b * (3.0 - 2.0 * b);
  const double ds = 6.0 * a * (1.0 - a), dt = 6.0 * b * (1.0 - b);
  const std::array<double, 2> wx{1.0 - s, s}, wy{1.0 - t, t}, dx{-ds, ds}, dy{-dt, dt};
  double sum = 0.0, sum_x = 0.0, sum_y = 0.0;
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t j = 0; j < 2; ++j) {
      const double z =
          random_normal(cell_key(key, column + static_cast<double>(i), row + static_cast<double>(j)), 0);
      sum += wx[i] * wy[j] * z;
      sum_x += dx[i] * wy[j] * z;
      sum_y += wx[i] * dy[j] * z;
    }
  }
  const double across = wx[0] * wx[0] + wx[1] * wx[1], along = wy[0] * wy[0] + wy[1] * wy[1];
  const double root = std::sqrt(across * along);
  // By the quotient's rule: d(root) / root = (w0 dw0 + w1 dw1) / (w0^2 + w1^2).
  const double turn_x = (wx[0] * dx[0] + wx[1] * dx[1]) / across;
  const double turn_y = (wy[0] * dy[0] + wy[1] * dy[1]) / along;
  const double scale = deviation_m / root;
  return {scale * sum, scale * (sum_x - sum * turn_x) / length_m, scale * (sum_y - sum * turn_y) / length_m};
}

// Rocks are drawn as where they are most common, and thinned elsewhere.
bool DrawnRelief::is_there(double width_m, double x_m, double y_m, double uniform) const {
  if (!spread_.rock_share_at) return true;
  const double share = spread_.rock_share_at(x_m, y_m);
  return share > 0.0 && uniform < per_width(share, width_m) / per_width(spread_.rock_share, width_m);
}

// The highest of the rocks over a place. A rock is h (1 - (r / R)^2)^2 high: half as high as wide, without an
// edge that a wheel's contact would jump over.
DrawnRelief::Rise DrawnRelief::rocks(double x_m, double y_m) const {
  Rise highest;
  if (rocks_per_m2_ <= 0.0) return highest;
  const double length = std::max(1.0, spread_.max_rock_m);  // of a cell: rocks reach into the next ones only
  const double column = std::floor(x_m / length), row = std::floor(y_m / length);
  for (double c = column - 1.0; c <= column + 1.0; c += 1.0) {
    for (double r = row - 1.0; r <= row + 1.0; r += 1.0) {
      const std::uint64_t cell = cell_key(random_key(key_, kRocks), c, r);
      // Poisson's number by the product of uniform numbers [Knuth].
      const double none = std::exp(-rocks_per_m2_ * length * length);
      double product = 1.0;
      for (std::uint64_t n = 0; (product *= random_uniform(cell, 4 * n)) > none; ++n) {
        const double dx = x_m - (c + random_uniform(cell, 4 * n + 1)) * length;
        const double dy = y_m - (r + random_uniform(cell, 4 * n + 2)) * length;
        const double at = random_uniform(cell, 4 * n + 3) * static_cast<double>(widths_m_.size() - 1);
        const auto low = static_cast<std::size_t>(at);
        const double width =
            widths_m_[low] + (at - static_cast<double>(low)) * (widths_m_[low + 1] - widths_m_[low]);
        const double radius = 0.5 * width, left = 1.0 - (dx * dx + dy * dy) / (radius * radius);
        const double height = 0.5 * width * left * left;
        if (left <= 0.0 || height <= highest.height_m) continue;
        if (!is_there(width, x_m - dx, y_m - dy, random_uniform(random_key(cell, kThinning), n))) continue;
        const double slope = -2.0 * width * left / (radius * radius);
        highest = {height, slope * dx, slope * dy};
      }
    }
  }
  return highest;
}

// The share of the drawn relief that lies at a place, with its gradient: a smooth step over the radius.
DrawnRelief::Rise DrawnRelief::drawn_share(double x_m, double y_m) const {
  if (!standing_) return {1.0, 0.0, 0.0};
  const double dx = x_m - standing_->pose.x_m, dy = y_m - standing_->pose.y_m;
  const double away = std::hypot(dx, dy), t = away / standing_->radius_m - 1.0;
  if (t <= 0.0) return {};
  if (t >= 1.0) return {1.0, 0.0, 0.0};
  const double by_way = 6.0 * t * (1.0 - t) / standing_->radius_m;
  return {t * t * (3.0 - 2.0 * t), by_way * dx / away, by_way * dy / away};
}

std::optional<GroundPoint> DrawnRelief::at(double x_m, double y_m) const {
  std::optional<GroundPoint> point = ground_.at(x_m, y_m);
  if (!point) return point;
  const Rise share = drawn_share(x_m, y_m);
  if (share.height_m <= 0.0) return point;
  const std::array<Rise, 3> all{
      noise(random_key(key_, kError), spread_.elevation_error_m, spread_.error_length_m, x_m, y_m),
      noise(random_key(key_, kRoughness), spread_.roughness_m, spread_.roughness_length_m, x_m, y_m),
      rocks(x_m, y_m)};
  double by_x = -point->normal.x() / point->normal.z(), by_y = -point->normal.y() / point->normal.z();
  for (const Rise& rise : all) {
    point->height_m += share.height_m * rise.height_m;
    by_x += share.height_m * rise.by_x + rise.height_m * share.by_x;
    by_y += share.height_m * rise.by_y + rise.height_m * share.by_y;
  }
  point->normal = Eigen::Vector3d(-by_x, -by_y, 1.0).normalized();
  return point;
}

std::optional<std::size_t> DrawnRelief::soil_at(double x_m, double y_m) const {
  return ground_.soil_at(x_m, y_m);
}

}  // namespace slipway::sim
