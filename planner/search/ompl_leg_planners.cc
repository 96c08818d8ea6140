#include "planner/search/ompl_leg_planners.h"

#include <ompl/base/ProblemDefinition.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/informedtrees/BITstar.h>
#include <ompl/geometric/planners/rrt/RRTstar.h>
#include <ompl/util/Console.h>

#include <algorithm>
#include <memory>
#include <mutex>

#include "core/random.h"
#include "planner/search/ompl_motion_space.h"
#include "planner/search/ompl_nearest_neighbors.h"

namespace slipway::planner {
namespace ob = ompl::base;
namespace og = ompl::geometric;
namespace {

// OMPL asks for 1.1 2^(d+1) e (1 + 1/d) ln n neighbours, nearly 500 of 2,000 in SE(2), which suffices for any
// ground and any sampling. With samples where good routes run, some 40 give the same cost in a tenth of the
// time.
constexpr double kRewireFactor = 0.09;

// Every random number and every order is the planner's own: OMPL draws the seeds of its generators from one
// process-wide stream.
class RepeatableRrtStar final : public og::RRTstar {
 public:
  RepeatableRrtStar(const ob::SpaceInformationPtr& space, const LegSearch& search) : RRTstar(space) {
    // Not 0: OMPL reads that as "none".
    rng_.setLocalSeed(static_cast<std::uint_fast32_t>(random_bits(search.seed, 0) >> 33) + 1U);
    nn_ = std::make_shared<BucketNearestNeighbors<Motion*>>(search.cost->map().cell_m());
    setRange(search.range_m);
    setGoalBias(0.05);
    setRewireFactor(kRewireFactor);
  }
};

ob::PlannerPtr rrt_star(const ob::SpaceInformationPtr& space, const LegSearch& search) {
  return std::make_shared<RepeatableRrtStar>(space, search);
}

// BIT* draws from the space's sampler alone: its own generator serves just-in-time sampling, which is off.
ob::PlannerPtr bit_star(const ob::SpaceInformationPtr& space, const LegSearch& search) {
  constexpr int kBatches = 5;
  constexpr int kMaxBatch = 1000;
  auto planner = std::make_shared<og::BITstar>(space);
  planner->setSamplesPerBatch(static_cast<unsigned int>(std::min(search.iterations / kBatches, kMaxBatch)));
  planner->setPruning(false);
  return planner;
}

std::vector<Pose2> poses_of(const ob::PathPtr& path) {
  std::vector<Pose2> poses;
  const auto* states = path->as<og::PathGeometric>();
  for (std::size_t i = 0; i < states->getStateCount(); ++i)
    poses.push_back(pose_of(states->getState(static_cast<unsigned int>(i))));
  return poses;
}

class OmplLegPlanner final : public LegPlanner {
 public:
  using Make = ob::PlannerPtr (*)(const ob::SpaceInformationPtr&, const LegSearch&);

  // asks_per_sample: how often the planner asks whether to end, for each sample that it draws.
  OmplLegPlanner(Make make, long long asks_per_sample) : make_(make), asks_per_sample_(asks_per_sample) {
    static std::once_flag silenced;
    std::call_once(silenced, [] { ompl::msg::noOutputHandler(); });
  }

  std::vector<Pose2> search(const LegSearch& leg) const override {
    // OMPL waits for a goal to become possible, a millisecond for each time that it asks whether to end.
    const auto may_arrive = [&](double heading_rad) {
      return leg.cost->map().may_stand({leg.to_x_m, leg.to_y_m, heading_rad});
    };
    if (std::none_of(leg.arrival_rad.begin(), leg.arrival_rad.end(), may_arrive)) return {};
    const auto space = std::make_shared<MotionSpace>(leg);
    const auto information = std::make_shared<ob::SpaceInformation>(space);
    information->setStateValidityChecker(
        [&leg](const ob::State* state) { return leg.cost->map().may_stand(pose_of(state)); });
    information->setMotionValidator(std::make_shared<FiniteCostValidator>(information, leg));
    information->setup();

    const auto problem = std::make_shared<ob::ProblemDefinition>(information);
    ob::ScopedState<> start(space);
    set_pose(start.get(), leg.from);
    problem->addStartState(start);
    problem->setGoal(std::make_shared<PlaceGoal>(information, leg));
    problem->setOptimizationObjective(std::make_shared<MotionCostObjective>(information, leg));

    const ob::PlannerPtr planner = make_(information, leg);
    planner->setProblemDefinition(problem);
    planner->setup();
    long long asked = 0;
    bool cancelled = false;
    planner->solve(ob::PlannerTerminationCondition([&] {
      if (++asked % 64 == 0 && leg.cancelled && leg.cancelled()) cancelled = true;
      return cancelled || asked > asks_per_sample_ * leg.iterations;
    }));
    if (cancelled || !problem->hasExactSolution()) return {};
    return poses_of(problem->getSolutionPath());
  }

 private:
  Make make_;
  long long asks_per_sample_;
};

}  // namespace

std::unique_ptr<LegPlanner> make_rrt_star() {
  return std::make_unique<OmplLegPlanner>(rrt_star, 1);  // asks once a sample
}

std::unique_ptr<LegPlanner> make_bit_star() {
  return std::make_unique<OmplLegPlanner>(bit_star, 10);  // asks once an edge
}

}  // namespace slipway::planner
