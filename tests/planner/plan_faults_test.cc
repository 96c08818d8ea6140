#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>

#include "core/angle.h"
#include "dem/synthetic_terrain.h"
#include "tests/planner/open_ground.h"

namespace slipway::planner {
namespace {

TEST(Plan, RefusesAStartOutsideAKeepIn) {
  PlanProblem problem = problem_of(kOpen);
  problem.keep_in = {{{problem.goal.x_m - 3.0, problem.goal.y_m - 3.0},
                      {problem.goal.x_m + 3.0, problem.goal.y_m - 3.0},
                      {problem.goal.x_m + 3.0, problem.goal.y_m + 3.0},
                      {problem.goal.x_m - 3.0, problem.goal.y_m + 3.0}},
                     {{0.0, 0.0}, {1.0, 1.0}}};
  NoProgress progress;
  const Result<Plan> plan = make_plan(problem, progress);
  ASSERT_FALSE(plan.has_value());
  std::vector<std::string> pointers;
  for (const Fault& fault : plan.error().faults) pointers.push_back(fault.pointer);
  EXPECT_EQ(pointers.front(), "/keep_in/1");
  EXPECT_NE(std::find(pointers.begin(), pointers.end(), "/start"), pointers.end());
}

TEST(Plan, ReportsAllFaultsTogether) {
  PlanProblem problem = problem_of(kOpen);
  problem.start.x_m = -5.0;
  problem.goal.x_m = 43.9;
  problem.waypoints = {{22.0, 9.0, std::nullopt}};
  problem.keep_out = {{{20.0, 5.0}, {24.0, 5.0}, {24.0, 13.0}, {20.0, 13.0}}, {{0.0, 0.0}, {1.0, 1.0}}};
  problem.planners = {"rrt_star", "a_star"};
  problem.routes = 0;
  NoProgress progress;
  const Result<Plan> plan = make_plan(problem, progress);
  ASSERT_FALSE(plan.has_value());
  EXPECT_EQ(plan.error().code, ErrorCode::kOffMap);
  std::vector<std::string> pointers;
  for (const Fault& fault : plan.error().faults) pointers.push_back(fault.pointer);
  EXPECT_EQ(pointers, (std::vector<std::string>{"/routes", "/planners/1", "/keep_out/1", "/start", "/goal",
                                                "/waypoints/0"}));
}

TEST(Plan, RefusesAStartSteeperThanTheLimits) {
  PlanProblem problem = problem_of(kOpen);
  problem.terrain = dem::make_ramp({.size_m = 60.0, .cell_m = 1.0}, rad_from_deg(28.0), 0.3);
  problem.soil_map = nullptr;
  problem.start = {0.0, 0.0, std::nullopt};
  problem.goal = {10.0, 0.0, std::nullopt};
  NoProgress progress;
  const Result<Plan> plan = make_plan(problem, progress);
  ASSERT_FALSE(plan.has_value());
  EXPECT_EQ(plan.error().code, ErrorCode::kInvalidRequest);
  EXPECT_NE(plan.error().faults.at(0).message.find("must be at most 25.0 deg"), std::string::npos);
}

class CancelledAt final : public Progress {
 public:
  explicit CancelledAt(double fraction) : fraction_(fraction) {}
  void report(std::string_view /*stage*/, double fraction) override {
    if (fraction >= fraction_ && !cancelled_.exchange(true)) at_ = std::chrono::steady_clock::now();
  }
  bool cancelled() const override { return cancelled_; }
  double seconds_since() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - at_).count();
  }

 private:
  double fraction_;
  std::atomic<bool> cancelled_{false};
  std::chrono::steady_clock::time_point at_;
};

TEST(Plan, StopsWithinTwoSecondsWhenCancelledAtAnyStage) {
  for (const double fraction : {0.0, 0.1, 0.5, 0.7}) {
    CancelledAt progress(fraction);
    const Result<Plan> plan = make_plan(problem_of(kOpen), progress);
    ASSERT_FALSE(plan.has_value()) << fraction;
    EXPECT_EQ(plan.error().code, ErrorCode::kCancelled);
    EXPECT_LT(progress.seconds_since(), 2.0) << fraction;
  }
}

}  // namespace
}  // namespace slipway::planner
