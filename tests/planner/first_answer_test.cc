// What who waits for a plan is told first.

#include <gtest/gtest.h>

#include <mutex>
#include <string>
#include <vector>

#include "planner/make_plan.h"
#include "planner/search/select_routes.h"
#include "tests/planner/gale_fixture.h"

namespace slipway::planner {
namespace {

class Hears final : public Progress {
 public:
  void report(std::string_view stage, double fraction) override {
    const std::scoped_lock lock(mutex);
    if (stage.starts_with("simulating")) choosing = true;
    EXPECT_GE(fraction, last);
    last = fraction;
  }
  bool cancelled() const override { return false; }
  void found(const RouteSoFar& route) override {
    const std::scoped_lock lock(mutex);
    routes.push_back(route);
    if (!choosing) ++before_choosing;
  }

  std::mutex mutex;
  std::vector<RouteSoFar> routes;
  bool choosing = false;
  int before_choosing = 0;
  double last = 0.0;
};

PlanProblem down_the_slope() {
  PlanProblem problem = gale();
  problem.start = {8142640.0, -276730.0, std::nullopt};
  problem.goal = {8142590.0, -276680.0, std::nullopt};
  return problem;
}

TEST(FirstAnswer, HasAVerdictBeforeRoutesAreChosenAndIsFollowedByBetterOnesAlone) {
  Hears progress;
  const auto plan = make_plan(down_the_slope(), progress);
  ASSERT_TRUE(plan && !plan->routes.empty());
  EXPECT_GE(progress.before_choosing, 1);
  for (std::size_t k = 0; k < progress.routes.size(); ++k) {
    EXPECT_FALSE(progress.routes[k].verdict.empty()) << k;
    if (k == 0 || progress.routes[k].verdict != progress.routes[k - 1].verdict) continue;
    EXPECT_LE(progress.routes[k].cost, progress.routes[k - 1].cost);
  }
}

// Where no planner is named, the others are begun where they may gain something alone.
TEST(FirstAnswer, IsNoMoreThanATieDearerThanWhatAllPlannersFind) {
  PlanProblem problem = down_the_slope();
  problem.routes = 1;
  NoProgress progress;
  const auto plan = make_plan(problem, progress);
  problem.planners = {"rrt_star", "bit_star"};
  const auto by_all = make_plan(problem, progress);
  ASSERT_TRUE(plan && by_all && !plan->routes.empty() && !by_all->routes.empty());
  EXPECT_LE(plan->routes.front().cost, (1.0 + kTiedShare) * by_all->routes.front().cost);
}

}  // namespace
}  // namespace slipway::planner
