#include "planner/search/ompl_motion_space.h"

#include <cmath>
#include <numbers>

#include "core/angle.h"
#include "core/random.h"

namespace slipway::planner {
namespace ob = ompl::base;
namespace {

constexpr double kMetresPerRadian = 1.0;
constexpr double kSameState_m = 1e-6;

class GuidedSampler final : public ob::StateSampler {
 public:
  GuidedSampler(const ob::StateSpace* space, const LegSearch& search)
      : StateSampler(space), search_(search) {}
  void sampleUniform(ob::State* state) override {
    set_pose(state, search_.sampler->draw(search_.seed, counter_++));
  }
  void sampleUniformNear(ob::State* state, const ob::State* near, double distance) override {
    sampleGaussian(state, near, 0.5 * distance);
  }
  void sampleGaussian(ob::State* state, const ob::State* mean, double spread) override {
    const std::uint64_t key = random_key(search_.seed, ~counter_++);
    const Pose2 pose = pose_of(mean);
    set_pose(state, {pose.x_m + spread * random_normal(key, 0), pose.y_m + spread * random_normal(key, 1),
                     wrapped_rad(pose.yaw_rad + spread * random_normal(key, 2) / kMetresPerRadian)});
    space_->enforceBounds(state);
  }

 private:
  const LegSearch& search_;
  std::uint64_t counter_ = 0;
};

}  // namespace

// Due west is pi here and -pi in OMPL, whose headings lie in [-pi, pi): a state at pi would be out of bounds
// and dropped without a word.
Pose2 pose_of(const ob::State* state) {
  const auto* se2 = state->as<ob::SE2StateSpace::StateType>();
  return {se2->getX(), se2->getY(), wrapped_rad(se2->getYaw())};
}

void set_pose(ob::State* state, const Pose2& pose) {
  auto* se2 = state->as<ob::SE2StateSpace::StateType>();
  se2->setXY(pose.x_m, pose.y_m);
  se2->setYaw(pose.yaw_rad >= std::numbers::pi ? -std::numbers::pi : pose.yaw_rad);
}

MotionSpace::MotionSpace(const LegSearch& search) : search_(search) {
  const dem::Extent extent = search.cost->map().geometry().extent();
  ob::RealVectorBounds bounds(2);
  bounds.setLow(0, extent.west_m);
  bounds.setHigh(0, extent.east_m);
  bounds.setLow(1, extent.south_m);
  bounds.setHigh(1, extent.north_m);
  setBounds(bounds);
}

double MotionSpace::distance(const ob::State* a, const ob::State* b) const {
  const Pose2 p = pose_of(a);
  const Pose2 q = pose_of(b);
  return std::hypot(p.x_m - q.x_m, p.y_m - q.y_m) +
         kMetresPerRadian * std::abs(wrapped_rad(p.yaw_rad - q.yaw_rad));
}

void MotionSpace::interpolate(const ob::State* from, const ob::State* to, double t, ob::State* state) const {
  if (t >= 1.0) {
    copyState(state, to);
  } else if (t <= 0.0) {
    copyState(state, from);
  } else {
    const Motion motion = connect(pose_of(from), pose_of(to), search_.cost->limits());
    set_pose(state, motion.at(t * motion.length_m));
  }
}

ob::StateSamplerPtr MotionSpace::allocDefaultStateSampler() const {
  return std::make_shared<GuidedSampler>(this, search_);
}

FiniteCostValidator::FiniteCostValidator(const ob::SpaceInformationPtr& space, const LegSearch& search)
    : MotionValidator(space), search_(search) {}

bool FiniteCostValidator::checkMotion(const ob::State* from, const ob::State* to) const {
  return std::isfinite(search_.cost->of(connect(pose_of(from), pose_of(to), search_.cost->limits())));
}

bool FiniteCostValidator::checkMotion(const ob::State* from, const ob::State* to,
                                      std::pair<ob::State*, double>& last_valid) const {
  last_valid.second = 0.0;
  return checkMotion(from, to);
}

MotionCostObjective::MotionCostObjective(const ob::SpaceInformationPtr& space, const LegSearch& search)
    : OptimizationObjective(space), search_(search) {
  description_ = "predicted cost of a drive";
}

ob::Cost MotionCostObjective::stateCost(const ob::State* state) const {
  return ob::Cost(search_.cost->per_metre(pose_of(state)));
}

ob::Cost MotionCostObjective::motionCost(const ob::State* from, const ob::State* to) const {
  return ob::Cost(search_.cost->of(connect(pose_of(from), pose_of(to), search_.cost->limits())));
}

PlaceGoal::PlaceGoal(const ob::SpaceInformationPtr& space, const LegSearch& search)
    : GoalSampleableRegion(space), search_(search) {
  setThreshold(kSameState_m);
}

void PlaceGoal::sampleGoal(ob::State* state) const {
  set_pose(state,
           {search_.to_x_m, search_.to_y_m, search_.arrival_rad[next_++ % search_.arrival_rad.size()]});
}

unsigned int PlaceGoal::maxSampleCount() const {
  return static_cast<unsigned int>(search_.arrival_rad.size());
}

double PlaceGoal::distanceGoal(const ob::State* state) const {
  const Pose2 pose = pose_of(state);
  const double away = std::hypot(pose.x_m - search_.to_x_m, pose.y_m - search_.to_y_m);
  if (search_.arrival_rad.size() > 1) return away;
  return away + std::abs(wrapped_rad(pose.yaw_rad - search_.arrival_rad.front()));
}

}  // namespace slipway::planner
