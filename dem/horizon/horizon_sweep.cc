#include "dem/horizon/horizon_sweep.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <tuple>
#include <utility>

#include "core/parallel_for.h"
#include "dem/horizon/ray_direction.h"

namespace slipway::dem {
namespace {

constexpr float kNoHeight = std::numeric_limits<float>::quiet_NaN();
constexpr int kNearby = 48;  // steps that a place looks along its own ray
constexpr int kClose = 16;   // of them those between which it looks, too
constexpr int kLinesOfBlock = 64;

struct Corner {
  double s_m, w_m;  // along the line, and the height less what the ground falls away from the line's begin
};

double slope(const Corner& from, const Corner& to) {
  return (to.w_m - from.w_m) / (to.s_m - from.s_m);
}

// The upper convex hull of a line's ground; the nearest corner last.
class Hull {
 public:
  void add(const Corner& nearer) {
    while (corners_.size() > 1 && !is_seen(corners_.back(), nearer, corners_[corners_.size() - 2]))
      corners_.pop_back();
    corners_.push_back(nearer);
  }
  // The steepest slope to a corner; -infinity without any. It rises up to one corner and falls behind it, and
  // where the last place saw its horizon the next one mostly does, too.
  double steepest(const Corner& eye) {
    if (corners_.empty()) return -std::numeric_limits<double>::infinity();
    seen_ = std::min(seen_, corners_.size() - 1);
    double best = slope(eye, corners_[seen_]);
    const auto climb = [&](std::size_t to) {
      const double there = slope(eye, corners_[to]);
      if (there < best) return false;
      best = there;
      seen_ = to;
      return true;
    };
    bool moved = false;
    while (seen_ + 1 < corners_.size() && climb(seen_ + 1)) moved = true;
    while (!moved && seen_ > 0 && climb(seen_ - 1)) continue;
    return best;
  }

 private:
  // Whether a corner stands over the line from the nearer to the farther one; without a division.
  static bool is_seen(const Corner& corner, const Corner& nearer, const Corner& farther) {
    return (corner.w_m - nearer.w_m) * (farther.s_m - nearer.s_m) >
           (farther.w_m - nearer.w_m) * (corner.s_m - nearer.s_m);
  }

  std::vector<Corner> corners_;
  std::size_t seen_ = 0;
};

// The grid as the direction sees it: p counts the rows or columns that each ray crosses, growing the way that
// it looks; q counts the others.
struct Course {
  int p_count, q_count;
  bool along_columns, turned;  // p is the column; p counts from the last
  double q_per_p, metres_per_p;
  double closest_m;  // nearer there is but the slope that the rover itself stands on
  std::ptrdiff_t p_stride, q_stride;
  const float* first;
  // Where there is no ground, since it was left out.
  double low_p = 0.0, high_p = 0.0, low_q = 0.0, high_q = 0.0;

  Course(const GridGeometry& grid, const std::vector<float>& heights, const std::optional<Extent>& without,
         double azimuth_rad) {
    const Eigen::Vector2d per_m = index_per_m(grid, azimuth_rad);
    along_columns = std::abs(per_m.y()) >= std::abs(per_m.x());
    const double p_m = along_columns ? per_m.y() : per_m.x(), q_m = along_columns ? per_m.x() : per_m.y();
    turned = p_m < 0.0;
    q_per_p = q_m / std::abs(p_m);
    metres_per_p = 1.0 / std::abs(p_m);
    closest_m = 0.5 * std::min(grid.cell_x_m, grid.cell_y_m);
    p_count = along_columns ? grid.columns : grid.rows;
    q_count = along_columns ? grid.rows : grid.columns;
    p_stride = along_columns ? 1 : grid.columns;
    q_stride = along_columns ? grid.columns : 1;
    first = heights.data();
    if (turned) {
      first += (p_count - 1) * p_stride;
      p_stride = -p_stride;
    }
    if (!without) return;
    const Eigen::Vector2d one = grid.fractional_index(without->west_m, without->north_m),
                          other = grid.fractional_index(without->east_m, without->south_m);
    std::tie(low_p, high_p) = std::minmax({p_of(one), p_of(other)});
    std::tie(low_q, high_q) = std::minmax({q_of(one), q_of(other)});
  }

  double p_of(const Eigen::Vector2d& row_and_column) const {
    const double p = along_columns ? row_and_column.y() : row_and_column.x();
    return turned ? p_count - 1 - p : p;
  }
  double q_of(const Eigen::Vector2d& row_and_column) const {
    return along_columns ? row_and_column.x() : row_and_column.y();
  }
  const float* at(int p, int q) const { return first + p * p_stride + q * q_stride; }
  // On a whole p, between two whole q.
  double height_m(int p, double q) const {
    if (!(q >= 0.0 && q <= q_count - 1)) return kNoHeight;
    return inner_height_m(p, q);
  }
  double inner_height_m(int p, double q) const {
    const int below = std::min(static_cast<int>(q), q_count - 2);
    return between(at(p, below), q_stride, q - below);
  }
  // Anywhere on the grid.
  double inner_height_m(double p, double q) const {
    const int before = std::min(static_cast<int>(p), p_count - 2),
              below = std::min(static_cast<int>(q), q_count - 2);
    const float* const from = at(before, below);
    const double here = between(from, q_stride, q - below);
    return here + (p - before) * (between(from + p_stride, q_stride, q - below) - here);
  }
  // On a whole q, between two whole p.
  double inner_height_m(double p, int q) const {
    const int before = std::min(static_cast<int>(p), p_count - 2);
    return between(at(before, q), p_stride, p - before);
  }
  static double between(const float* here, std::ptrdiff_t stride, double share) {
    return here[0] + share * (here[stride] - here[0]);
  }
  // How many steps from (p, q) the ground ends, and how many before it begins: both 0 where it is never met.
  std::pair<double, double> met(double p, double q) const {
    double begin = std::max(0.0, -p), end = p_count - 1 - p;
    if (q_per_p != 0.0) {
      const std::pair<double, double> across = std::minmax({-q / q_per_p, (q_count - 1 - q) / q_per_p});
      begin = std::max(begin, across.first);
      end = std::min(end, across.second);
    } else if (q < 0.0 || q > q_count - 1) {
      end = 0.0;
    }
    if (p > low_p && p < high_p && q > low_q && q < high_q) {
      double leaves = high_p - p;
      if (q_per_p != 0.0) leaves = std::min(leaves, ((q_per_p > 0.0 ? high_q : low_q) - q) / q_per_p);
      begin = std::max(begin, leaves);
    }
    return begin < end ? std::pair(begin, end) : std::pair(0.0, 0.0);
  }
};

// Some lines side by side, q = j + q_per_p p for whole j, and the eyes between them.
class Lines {
 public:
  Lines(const Course& course, double body_radius_m, int first_j, int count)
      : course_(course),
        per_diameter_(0.5 / body_radius_m),
        first_j_(first_j),
        count_(count),
        hulls_(static_cast<std::size_t>(count) + 1) {}

  // The ground on a whole p.
  void add(int p) {
    if (p < 0 || p >= course_.p_count) return;
    const double s = p * course_.metres_per_p, fallen = s * s * per_diameter_;
    for (int k = 0; k <= count_; ++k) {
      const double height = course_.height_m(p, first_j_ + k + course_.q_per_p * p);
      if (!std::isnan(height)) hulls_[static_cast<std::size_t>(k)].add({s, height - fallen});
    }
  }

  // What an eye at (p, q) sees: nearby along its own ray, beyond along the lines beside it. Higher
  // than `enough` it is not looked for.
  double tangent(double p, double q, double height_m, double enough) {
    const double beyond = tangent_beyond(p, q, height_m);
    if (beyond >= enough) return beyond;
    return std::max(beyond, tangent_nearby(p, q, height_m, enough));
  }

 private:
  double tangent_beyond(double p, double q, double height_m) {
    const double s = p * course_.metres_per_p;
    const Corner eye{s, height_m - s * s * per_diameter_};
    const double line = q - course_.q_per_p * p - first_j_, share = line - std::floor(line);
    const auto k = static_cast<std::size_t>(std::floor(line));
    const double one = hulls_[k].steepest(eye), other = hulls_[k + 1].steepest(eye);
    const double far =
        std::isinf(one) || std::isinf(other) ? std::max(one, other) : (1.0 - share) * one + share * other;
    return far + 2.0 * s * per_diameter_;
  }

  double tangent_nearby(double p, double q, double height_m, double enough) const {
    double best = -std::numeric_limits<double>::infinity();
    const auto look = [&](double height, double steps) {
      const double d = steps * course_.metres_per_p;
      const double over = height - height_m - d * d * per_diameter_;
      if (over > best * d) best = over / d;  // not where there is no height
    };
    const auto q_after = [&](double steps) { return q + course_.q_per_p * steps; };
    const auto look_after = [&](double steps) {
      look(course_.inner_height_m(p + steps, q_after(steps)), steps);
    };
    const int here = static_cast<int>(std::floor(p));
    const auto [begins, ends] = course_.met(p, q);
    constexpr double kRounding = 1e-9;  // the rim of the grid is on it
    const double first = std::max(begins, course_.closest_m / course_.metres_per_p),
                 last = std::min(ends, here + kNearby - 1.0 - p) + kRounding;
    if (first > last) return best;
    look_after(first);
    const int next = static_cast<int>(std::floor(p + first)) + 1,
              end = static_cast<int>(std::floor(p + last));
    // Between two crossings the ground is a parabola.
    const int close = std::min(end, here + kClose - 1);
    if (next <= close) look_after(0.5 * (first + next - p));
    for (int k = next + 1; k <= close; ++k) look_after(k - 0.5 - p);
    for (int k = next; k <= end && best < enough; ++k) look(course_.inner_height_m(k, q_after(k - p)), k - p);
    if (course_.q_per_p == 0.0) return best;
    const bool rises = course_.q_per_p > 0.0;
    const double q_first = q_after(first), q_last = q_after(last), per_q = 1.0 / course_.q_per_p;
    const int from = static_cast<int>(rises ? std::floor(q_first) + 1.0 : std::ceil(q_last)),
              to = static_cast<int>(rises ? std::floor(q_last) : std::ceil(q_first) - 1.0);
    for (int k = from; k <= to && best < enough; ++k) {
      const double steps = (k - q) * per_q;
      look(course_.inner_height_m(p + steps, k), steps);
    }
    return best;
  }

  const Course& course_;
  double per_diameter_;
  int first_j_, count_;
  std::vector<Hull> hulls_;
};

}  // namespace

Eyes eyes_over(const Terrain& terrain, const GridGeometry& cells, double eye_m) {
  Eyes eyes{cells, {}};
  eyes.heights_m.reserve(static_cast<std::size_t>(cells.rows) * static_cast<std::size_t>(cells.columns));
  const GridGeometry& whole = terrain.geometry();
  for (int row = 0; row < cells.rows; ++row) {
    // The rows of the terrain that a bilinear height needs.
    const double at = whole.fractional_index(cells.west_m, cells.centre_m({row, 0}).y()).x();
    const int first = static_cast<int>(std::clamp(std::floor(at) - 1.0, 0.0, whole.rows - 1.0));
    const auto part = terrain.part({first, 0, std::min(4, whole.rows - first), whole.columns});
    for (int column = 0; column < cells.columns; ++column) {
      const Eigen::Vector2d centre = cells.centre_m({row, column});
      const auto height = part ? part->height_m(centre.x(), centre.y()) : std::nullopt;
      eyes.heights_m.push_back(height ? static_cast<float>(*height + eye_m) : kNoHeight);
    }
  }
  return eyes;
}

HorizonSweep::HorizonSweep(const Terrain& terrain, double body_radius_m, std::optional<Extent> without)
    : geometry_(terrain.geometry()), without_(without), body_radius_m_(body_radius_m) {
  constexpr int kRowsAtOnce = 256;  // as a tiled raster is read
  heights_m_.reserve(static_cast<std::size_t>(geometry_.rows) * static_cast<std::size_t>(geometry_.columns));
  for (int from = 0; from < geometry_.rows; from += kRowsAtOnce) {
    const int rows = std::min(kRowsAtOnce, geometry_.rows - from);
    const auto part = terrain.part({from, 0, rows, geometry_.columns});
    for (int row = 0; row < rows; ++row)
      for (int column = 0; column < geometry_.columns; ++column) {
        const auto height = part ? part->height_m({row, column}) : std::nullopt;
        const Eigen::Vector2d centre = geometry_.centre_m({from + row, column});
        const bool left_out = without && centre.x() > without->west_m && centre.x() < without->east_m &&
                              centre.y() > without->south_m && centre.y() < without->north_m;
        heights_m_.push_back(height && !left_out ? static_cast<float>(*height) : kNoHeight);
      }
  }
}

void HorizonSweep::raise(const Eyes& eyes, double azimuth_rad, std::size_t threads,
                         std::vector<float>& tangents, double enough) const {
  if (geometry_.rows < 2 || geometry_.columns < 2) return;
  const Course course(geometry_, heights_m_, without_, azimuth_rad);
  const GridGeometry& cells = eyes.cells;
  // The eyes' cells along p and along q, and where they lie.
  const int along_p = course.along_columns ? cells.columns : cells.rows,
            along_q = course.along_columns ? cells.rows : cells.columns;
  const auto index = [&](int p, int q) { return course.along_columns ? Cell{q, p} : Cell{p, q}; };
  const auto place = [&](int p, int q) {
    const Eigen::Vector2d centre = cells.centre_m(index(p, q));
    return geometry_.fractional_index(centre.x(), centre.y());
  };
  const auto at = [&](int p, int q) {
    const Cell cell = index(p, q);
    return static_cast<std::size_t>(cell.row) * static_cast<std::size_t>(cells.columns) +
           static_cast<std::size_t>(cell.column);
  };
  // Those that look stand on the terrain, so that no line begins far from it.
  std::vector<std::pair<double, int>> p_of;
  int begin_q = along_q, end_q = 0;
  for (int p = 0; p < along_p; ++p) {
    bool looks = false;
    for (int q = 0; q < along_q; ++q) {
      if (std::isnan(eyes.heights_m[at(p, q)])) continue;
      looks = true;
      begin_q = std::min(begin_q, q);
      end_q = std::max(end_q, q + 1);
    }
    if (looks) p_of.emplace_back(course.p_of(place(p, 0)), p);
  }
  if (p_of.empty()) return;
  std::sort(p_of.begin(), p_of.end(), std::greater<>());
  const double first_q = course.q_of(place(0, 0));
  const double q_step = along_q > 1 ? course.q_of(place(0, 1)) - first_q : 1.0;
  const double low_p = p_of.back().first, high_p = p_of.front().first;
  const std::pair<double, double> lean = std::minmax({course.q_per_p * low_p, course.q_per_p * high_p});
  const int first_j = static_cast<int>(std::floor(first_q + q_step * begin_q - lean.second)),
            last_j = static_cast<int>(std::floor(first_q + q_step * (end_q - 1) - lean.first));
  const auto blocks = static_cast<std::size_t>((last_j - first_j) / kLinesOfBlock + 1);
  parallel_for(blocks, threads, [&](std::size_t block) {
    const int j = first_j + static_cast<int>(block) * kLinesOfBlock;
    Lines lines(course, body_radius_m_, j, kLinesOfBlock);
    auto next = p_of.begin();
    for (int p = course.p_count - 1 + kNearby; next != p_of.end(); --p) {
      lines.add(p);
      for (; next != p_of.end() && std::floor(next->first) + kNearby >= p; ++next) {
        // Eyes with j <= q - q_per_p p < j + the lines of a block.
        const double from = j + course.q_per_p * next->first, to = from + kLinesOfBlock;
        const int last = std::min(end_q - 1, static_cast<int>(std::ceil((to - first_q) / q_step)));
        for (int k = std::max(begin_q, static_cast<int>(std::floor((from - first_q) / q_step))); k <= last;
             ++k) {
          const double q = first_q + q_step * k;
          const double line = q - course.q_per_p * next->first - j;
          if (line < 0.0 || line >= kLinesOfBlock) continue;
          const std::size_t eye = at(next->second, k);
          if (std::isnan(eyes.heights_m[eye]) || tangents[eye] >= enough) continue;
          tangents[eye] = std::max(
              tangents[eye], static_cast<float>(lines.tangent(next->first, q, eyes.heights_m[eye], enough)));
        }
      }
    }
  });
}

}  // namespace slipway::dem
