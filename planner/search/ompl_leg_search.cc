#include <ompl/base/ProblemDefinition.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/informedtrees/BITstar.h>
#include <ompl/geometric/planners/rrt/RRTstar.h>
#include <ompl/util/Console.h>

#include <algorithm>
#include <array>
#include <memory>
#include <mutex>
#include <stdexcept>

#include "core/random.h"
#include "planner/search/leg_search.h"
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
    nn_ = std::make_shared<BucketNearestNeighbors<Motion*>>();
    setRange(search.range_m);
    setGoalBias(0.05);
    setRewireFactor(kRewireFactor);
  }
};

ob::PlannerPtr make_rrt_star(const ob::SpaceInformationPtr& space, const LegSearch& search) {
  return std::make_shared<RepeatableRrtStar>(space, search);
}

// BIT* draws from the space's sampler alone: its own generator serves just-in-time sampling, which is off.
ob::PlannerPtr make_bit_star(const ob::SpaceInformationPtr& space, const LegSearch& search) {
  constexpr int kBatches = 5;
  constexpr int kLargestBatch = 1000;
  auto planner = std::make_shared<og::BITstar>(space);
  planner->setSamplesPerBatch(
      static_cast<unsigned int>(std::min(search.iterations / kBatches, kLargestBatch)));
  planner->setPruning(false);
  return planner;
}

// How often a planner asks whether to end, per sample: RRT* once a sample, BIT* once an edge.
struct FactoryRow {
  std::string_view name;
  ob::PlannerPtr (*make)(const ob::SpaceInformationPtr&, const LegSearch&);
  long long asks_per_sample;
};

constexpr std::array<FactoryRow, 2> kFactories{
    {{"rrt_star", make_rrt_star, 1}, {"bit_star", make_bit_star, 10}}};

const FactoryRow& factory_of(std::string_view name) {
  for (const FactoryRow& row : kFactories)
    if (row.name == name) return row;
  throw std::invalid_argument("a planner of the catalogue has no factory");
}

std::vector<Pose2> poses_of(const ob::PathPtr& path) {
  std::vector<Pose2> poses;
  const auto* states = path->as<og::PathGeometric>();
  for (std::size_t i = 0; i < states->getStateCount(); ++i)
    poses.push_back(pose_of(states->getState(static_cast<unsigned int>(i))));
  return poses;
}

}  // namespace

std::vector<Pose2> search_leg(std::string_view planner_name, const LegSearch& search) {
  static std::once_flag silenced;
  std::call_once(silenced, [] { ompl::msg::noOutputHandler(); });

  const FactoryRow& factory = factory_of(planner_name);
  const auto space = std::make_shared<MotionSpace>(search);
  const auto information = std::make_shared<ob::SpaceInformation>(space);
  information->setStateValidityChecker(
      [&search](const ob::State* state) { return search.cost->map().may_stand(pose_of(state)); });
  information->setMotionValidator(std::make_shared<FiniteCostValidator>(information, search));
  information->setup();

  const auto problem = std::make_shared<ob::ProblemDefinition>(information);
  ob::ScopedState<> start(space);
  set_pose(start.get(), search.from);
  problem->addStartState(start);
  problem->setGoal(std::make_shared<PlaceGoal>(information, search));
  problem->setOptimizationObjective(std::make_shared<MotionCostObjective>(information, search));

  const ob::PlannerPtr planner = factory.make(information, search);
  planner->setProblemDefinition(problem);
  planner->setup();
  long long asked = 0;
  bool cancelled = false;
  planner->solve(ob::PlannerTerminationCondition([&] {
    if (++asked % 64 == 0 && search.cancelled && search.cancelled()) cancelled = true;
    return cancelled || asked > factory.asks_per_sample * search.iterations;
  }));
  if (cancelled || !problem->hasExactSolution()) return {};
  return poses_of(problem->getSolutionPath());
}

}  // namespace slipway::planner
