#include "planner/search/leg_search.h"

#include <gtest/gtest.h>

#include <string>

#include "planner/search/grid_search.h"
#include "planner/search/planner_catalogue.h"
#include "planner/search/pose_sampler.h"
#include "planner/search/smooth_route.h"
#include "tests/planner/plan_fixture.h"

namespace slipway::planner {
namespace {

// The straight line is closed, so that no planner answers with it and every seed has a route of its own.
constexpr std::string_view kHills = R"(
. . . . . . . . . . . . . . . . . . . . . .
. . . . . 2 2 2 . . . . . . . 1 1 1 . . . .
. . . . . 2 4 2 . . # 3 3 3 . 1 2 1 . . . .
. . . . . 2 2 2 . . # 3 6 3 . 1 1 1 . . . .
. . . S . . . . . . # 3 3 3 . . . . . G . .
. . . . . . 2 2 . . # . . . . . 2 2 . . . .
. . . . . . 2 2 . . . . . . . . 2 2 . . . .
. . . . . . . . . . . . . . . . . . . . . .
. . . . . . . . . . . . . . . . . . . . . .
. . . . . . . . . . . . . . . . . . . . . .
)";

class LegSearchTest : public testing::TestWithParam<PlannerRow> {
 protected:
  PlanProblem problem = problem_of(kHills);
  KeepOut keep_out{problem.keep_out, *problem.rover};
  GroundTables tables = build_ground_tables(problem);
  TraverseMap map{problem, keep_out, problem.terrain->geometry().extent()};
  MotionCost cost{problem, map, tables, problem.weights};
  GridSearch grid{cost};
  PoseSampler sampler{grid,
                      map,
                      grid.cost_to_come(problem.start.x_m, problem.start.y_m),
                      grid.cost_to_go(problem.goal.x_m, problem.goal.y_m),
                      problem.start.x_m,
                      problem.start.y_m};

  std::unique_ptr<LegPlanner> planner = GetParam().make();

  LegSearch leg(std::uint64_t seed) const {
    LegSearch leg;
    leg.cost = &cost;
    leg.sampler = &sampler;
    leg.from = {problem.start.x_m, problem.start.y_m, 0.0};
    leg.to_x_m = problem.goal.x_m;
    leg.to_y_m = problem.goal.y_m;
    leg.arrival_rad = {0.5};
    leg.seed = seed;
    leg.iterations = 1500;
    return leg;
  }
};

TEST_P(LegSearchTest, FindsARouteNearTheGridsOptimumThatEndsAtTheGoalPose) {
  const std::vector<Pose2> poses = planner->search(leg(3));
  ASSERT_GE(poses.size(), 2U);
  EXPECT_EQ(poses.back(), (Pose2{problem.goal.x_m, problem.goal.y_m, 0.5}));
  const double found = fine_cost(cost, smooth_leg(cost, poses, true));
  EXPECT_LT(found, 1.15 * sampler.optimum());
  EXPECT_GT(found, 0.9 * sampler.optimum());
}

TEST_P(LegSearchTest, RepeatsBitForBitWhateverRanBefore) {
  const std::vector<Pose2> first = planner->search(leg(3));
  ASSERT_GT(first.size(), 2U);
  const std::vector<Pose2> other = planner->search(leg(4));
  // The grid's way is the same for every seed.
  EXPECT_EQ(other == first, GetParam().name == "grid");
  EXPECT_EQ(planner->search(leg(3)), first);
}

TEST_P(LegSearchTest, SmoothingNeverMakesARouteDearer) {
  for (std::uint64_t seed = 1; seed < 6; ++seed) {
    const std::vector<Pose2> poses = planner->search(leg(seed));
    ASSERT_GE(poses.size(), 2U);
    std::vector<Motion> found;
    for (std::size_t i = 1; i < poses.size(); ++i)
      found.push_back(connect(poses[i - 1], poses[i], cost.limits()));
    EXPECT_LE(fine_cost(cost, smooth_leg(cost, poses, true)), 1.02 * fine_cost(cost, found));
  }
}

TEST_P(LegSearchTest, StopsWhenCancelled) {
  LegSearch cancelled = leg(3);
  cancelled.iterations = 20'000;
  cancelled.cancelled = [] { return true; };
  EXPECT_TRUE(planner->search(cancelled).empty());
}

INSTANTIATE_TEST_SUITE_P(EveryPlanner, LegSearchTest,
                         testing::ValuesIn(planner_catalogue().begin(), planner_catalogue().end()),
                         [](const auto& row) { return std::string(row.param.name); });

}  // namespace
}  // namespace slipway::planner
