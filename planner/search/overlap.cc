#include "planner/search/overlap.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>

namespace slipway::planner {
namespace {

std::uint64_t bucket_key(int column, int row) {
  return static_cast<std::uint64_t>(static_cast<std::uint32_t>(column)) << 32 |
         static_cast<std::uint32_t>(row);
}

// Places in squares as wide as the distance that is asked for: nine squares hold all that is near.
class Buckets {
 public:
  Buckets(const std::vector<Eigen::Vector2d>& places, double width_m) : width_m_(width_m) {
    for (const Eigen::Vector2d& place : places)
      squares_[bucket_key(index(place.x()), index(place.y()))].push_back(place);
  }
  bool any_near(const Eigen::Vector2d& place) const {
    for (int dc = -1; dc <= 1; ++dc) {
      for (int dr = -1; dr <= 1; ++dr) {
        const auto square = squares_.find(bucket_key(index(place.x()) + dc, index(place.y()) + dr));
        if (square == squares_.end()) continue;
        for (const Eigen::Vector2d& other : square->second)
          if ((other - place).squaredNorm() <= width_m_ * width_m_) return true;
      }
    }
    return false;
  }

 private:
  int index(double metres) const { return static_cast<int>(std::floor(metres / width_m_)); }

  double width_m_;
  std::unordered_map<std::uint64_t, std::vector<Eigen::Vector2d>> squares_;
};

}  // namespace

std::vector<Eigen::Vector2d> centreline(const std::vector<Motion>& motions, double spacing_m) {
  std::vector<Eigen::Vector2d> line;
  for (const Motion& motion : motions) {
    if (line.empty()) line.emplace_back(motion.from.x_m, motion.from.y_m);
    const int pieces = static_cast<int>(std::ceil(motion.length_m / spacing_m));
    for (int k = 1; k <= pieces; ++k) {
      const Pose2 pose = motion.at(motion.length_m * k / pieces);
      line.emplace_back(pose.x_m, pose.y_m);
    }
  }
  return line;
}

double overlap(const std::vector<Eigen::Vector2d>& a, const std::vector<Eigen::Vector2d>& b, double width_m) {
  const Buckets near_b(b, width_m);
  double length = 0.0;
  double shared = 0.0;
  for (std::size_t i = 1; i < a.size(); ++i) {
    const double piece = (a[i] - a[i - 1]).norm();
    length += piece;
    if (near_b.any_near(0.5 * (a[i] + a[i - 1]))) shared += piece;
  }
  return length > 0.0 ? shared / length : 1.0;
}

}  // namespace slipway::planner
