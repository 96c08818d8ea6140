#include "planner/search/pose_sampler.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/angle.h"
#include "core/random.h"

namespace slipway::planner {
namespace {

constexpr double kShareGuided = 0.65;
constexpr double kShareAlongWay = 0.20;  // the rest is uniform over the map
constexpr double kSpread = 0.03;         // of the optimum: a cell that is worse by this is drawn e times less
constexpr double kWorst = 0.25;          // of the optimum: cells beyond are left to the uniform draws
constexpr double kHeadingSpread_rad = 0.3;
constexpr double kShareFlowHeading = 0.85;
constexpr double kAcrossSpread_m = 1.5;

}  // namespace

PoseSampler::PoseSampler(const GridSearch& grid, const TraverseMap& map, const CostField& to_go,
                         double start_x_m, double start_y_m)
    : map_(map), way_(grid.way(to_go, start_x_m, start_y_m)), flow_step_(to_go.step) {
  optimum_ = way_.empty() ? std::numeric_limits<double>::infinity() : to_go.cost[way_.front()];
}

PoseSampler::PoseSampler(const GridSearch& grid, const TraverseMap& map, const CostField& to_come,
                         const CostField& to_go, double start_x_m, double start_y_m)
    : PoseSampler(grid, map, to_go, start_x_m, start_y_m) {
  if (way_.empty()) return;
  double sum = 0.0;
  for (std::size_t i = 0; i < map.cells(); ++i) {
    const double worse =
        (static_cast<double>(to_come.cost[i]) + to_go.cost[i]) / std::max(optimum_, 1e-9) - 1.0;
    if (!(worse <= kWorst)) continue;
    sum += std::exp(-worse / kSpread);
    cells_.push_back(i);
    cumulative_.push_back(sum);
  }
}

double PoseSampler::flow_rad(std::size_t cell) const {
  return flow_step_[cell] < 0 ? 0.0 : GridSearch::heading_rad(flow_step_[cell]);
}

Pose2 PoseSampler::draw(std::uint64_t seed, std::uint64_t counter) const {
  const std::uint64_t key = random_key(seed, counter);
  const dem::GridGeometry& g = map_.geometry();
  const double kind = random_uniform(key, 0);
  const auto within = [&](std::size_t cell) {
    return Eigen::Vector2d(map_.centre_m(cell) +
                           Eigen::Vector2d((random_uniform(key, 2) - 0.5) * g.cell_x_m,
                                           (random_uniform(key, 3) - 0.5) * g.cell_y_m));
  };
  Eigen::Vector2d place;
  if (kind < kShareGuided && !cells_.empty()) {
    const auto at =
        std::upper_bound(cumulative_.begin(), cumulative_.end(), random_uniform(key, 1) * cumulative_.back());
    place = within(cells_[std::min(static_cast<std::size_t>(at - cumulative_.begin()), cells_.size() - 1)]);
  } else if (kind < kShareGuided + kShareAlongWay && !way_.empty()) {
    const auto k = static_cast<std::size_t>(random_uniform(key, 1) * static_cast<double>(way_.size()));
    place = map_.centre_m(way_[k]);
    place.x() += kAcrossSpread_m * random_normal(key, 2);
    place.y() += kAcrossSpread_m * random_normal(key, 3);
  } else if (map_.holds_blocks()) {
    const auto k = static_cast<std::size_t>(random_uniform(key, 1) * static_cast<double>(map_.cells()));
    place = within(std::min(k, map_.cells() - 1));
  } else {
    place = {g.west_m + random_uniform(key, 1) * g.columns * g.cell_x_m,
             g.north_m - random_uniform(key, 2) * g.rows * g.cell_y_m};
  }
  const dem::Extent extent = g.extent();
  Pose2 pose{std::clamp(place.x(), extent.west_m, extent.east_m),
             std::clamp(place.y(), extent.south_m, extent.north_m), 0.0};
  const long long cell = map_.index_at(pose.x_m, pose.y_m);
  const bool flows = cell >= 0 && flow_step_[static_cast<std::size_t>(cell)] >= 0;
  pose.yaw_rad =
      flows && random_uniform(key, 4) < kShareFlowHeading
          ? wrapped_rad(flow_rad(static_cast<std::size_t>(cell)) + kHeadingSpread_rad * random_normal(key, 5))
          : wrapped_rad(2.0 * std::numbers::pi * random_uniform(key, 6));
  return pose;
}

}  // namespace slipway::planner
