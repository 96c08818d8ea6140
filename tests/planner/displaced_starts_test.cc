// A drive's commands from starts beside the one that is said.
#include "planner/judge/displaced_starts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/angle.h"
#include "tests/planner/ground_fixture.h"

namespace slipway::planner {
namespace {

constexpr int kCells = 64;
constexpr StartError kError{.position_m = 0.5, .heading_rad = rad_from_deg(3.0)};

// 30 m to the east, an arc to the left at its end.
DriveSteps to_the_east() {
  return {.start = {10.0, 30.0, 0.0}, .steps = {{.drive_m = 20.0}, {.drive_m = 10.0, .radius_m = 20.0}}};
}

PlanProblem level() {
  return problem_on(kCells, kCells, 1.0, 1.0, [](double, double) { return 0.0; });
}

std::shared_ptr<const DisplacedStarts> driven(const PlanProblem& problem, const DriveSteps& commands) {
  NoProgress progress;
  return drive_from_displaced_starts(problem, commands, kError, progress);
}

DriveVerdict judged(const DisplacedStarts& starts) {
  DriveVerdict verdict;
  verdict.verdict = Verdict::kGo;
  judge_starts(starts, {}, verdict);
  return verdict;
}

TEST(DisplacedStarts, HaveTheMomentsOfTheErrorAndTheirMirrorImages) {
  const auto found = driven(level(), to_the_east());
  ASSERT_EQ(found->starts.size(), 25U);
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const DisplacedStart& start : found->starts) {
    const Eigen::Vector3d at(start.ahead_m / kError.position_m, start.left_m / kError.position_m,
                             start.turned_rad / kError.heading_rad);
    sum += at;
    moments += at * at.transpose() / 24.0;
    EXPECT_EQ(std::count_if(found->starts.begin(), found->starts.end(),
                            [&](const DisplacedStart& other) {
                              return other.ahead_m == start.ahead_m && other.left_m == -start.left_m &&
                                     other.turned_rad == -start.turned_rad;
                            }),
              1);
  }
  EXPECT_EQ(found->starts.front().ahead_m, 0.0);
  EXPECT_TRUE(moments.isApprox(Eigen::Matrix3d::Identity(), 1e-12)) << moments;
  EXPECT_LT(sum.norm(), 1e-12);
  EXPECT_EQ(found->count(Verdict::kGo), 25U);
  const DriveVerdict verdict = judged(*found);
  EXPECT_EQ(verdict.verdict, Verdict::kGo);
  ASSERT_EQ(verdict.rules.size(), 1U);
  EXPECT_EQ(verdict.rules.front().name, "start");
  EXPECT_EQ(verdict.reasons.size(), 1U);
}

TEST(DisplacedStarts, WhereSomeBreakARuleTheDriveIsOpenAndSaysWhichIsWorst) {
  PlanProblem problem = level();
  // The way's left side is 0.73 m from its middle, at most.
  problem.keep_out = {{{20.0, 31.4}, {24.0, 31.4}, {24.0, 33.0}, {20.0, 33.0}}};
  const auto found = driven(problem, to_the_east());
  EXPECT_EQ(found->starts.front().verdict, Verdict::kGo);
  EXPECT_GT(found->count(Verdict::kNoGo), 0U);
  EXPECT_LT(found->count(Verdict::kNoGo), 12U);
  EXPECT_EQ(found->worst().verdict, Verdict::kNoGo);
  ASSERT_TRUE(found->worst().rule);
  EXPECT_EQ(found->worst().rule->name, "keep_out");
  EXPECT_GT(found->worst().left_m + 12.0 * found->worst().turned_rad, 0.5);
  const DriveVerdict verdict = judged(*found);
  EXPECT_EQ(verdict.verdict, Verdict::kUnknown);
  EXPECT_NEAR(verdict.rules.front().value, static_cast<double>(found->count(Verdict::kNoGo)) / 25.0, 1e-12);
  EXPECT_NE(verdict.reasons.front().find("starts that are wrong by 0.5 m and 3 deg"), std::string::npos)
      << verdict.reasons.front();
}

TEST(DisplacedStarts, ALaneAsNarrowAsTheRoverIsANoGo) {
  PlanProblem problem = level();
  problem.keep_in = {{{5.0, 29.2}, {35.0, 29.2}, {35.0, 30.8}, {5.0, 30.8}}};
  const auto found = driven(problem, {.start = {10.0, 30.0, 0.0}, .steps = {{.drive_m = 20.0}}});
  EXPECT_EQ(found->starts.front().verdict, Verdict::kGo);
  EXPECT_EQ(judged(*found).verdict, Verdict::kNoGo);
}

TEST(DisplacedStarts, BesideGroundThatIsNotKnownTheyAreOpen) {
  const PlanProblem problem = problem_on(kCells, kCells, 1.0, 1.0, [](double x, double y) {
    return x > 20.0 && x < 24.0 && y > 31.5 ? std::nan("") : 0.0;
  });
  const auto found = driven(problem, to_the_east());
  EXPECT_EQ(found->starts.front().verdict, Verdict::kGo);
  EXPECT_GT(found->count(Verdict::kUnknown), 0U);
  ASSERT_TRUE(found->worst().rule);
  EXPECT_EQ(found->worst().rule->name, "ground");
  EXPECT_EQ(judged(*found).verdict, Verdict::kUnknown);
}

TEST(DisplacedStarts, AMirroredMapHasTheMirroredAnswer) {
  const auto hills_m = [](double x, double y) {
    return 0.66 * std::sin(0.21 * x + 0.4) * std::sin(0.17 * y) + 0.3 * std::sin(0.11 * x - 0.23 * y);
  };
  PlanProblem problem = problem_on(kCells, kCells, 1.0, 1.0, hills_m);
  PlanProblem mirrored =
      problem_on(kCells, kCells, 1.0, 1.0, [&](double x, double y) { return hills_m(x, kCells - y); });
  for (PlanProblem* each : {&problem, &mirrored}) each->limits.max_tilt_rad = rad_from_deg(9.8);
  DriveSteps other = to_the_east();
  other.start.y_m = kCells - other.start.y_m;
  other.steps.back().radius_m = -other.steps.back().radius_m;
  const auto left = driven(problem, to_the_east()), right = driven(mirrored, other);
  EXPECT_GT(left->count(Verdict::kNoGo), 0U);
  EXPECT_GT(left->count(Verdict::kGo), 0U);
  for (const Verdict each : {Verdict::kGo, Verdict::kUnknown, Verdict::kNoGo})
    EXPECT_EQ(left->count(each), right->count(each));
  const DisplacedStart &a = left->worst(), &b = right->worst();
  EXPECT_EQ(a.ahead_m, b.ahead_m);
  EXPECT_EQ(a.left_m, -b.left_m);
  EXPECT_EQ(a.turned_rad, -b.turned_rad);
  EXPECT_NEAR(a.max_slip_ratio, b.max_slip_ratio, 1e-6);
}

TEST(DisplacedStarts, APlanIsRankedByThemToo) {
  PlanProblem problem = level();
  problem.start = {10.0, 30.0, 0.0};
  problem.goal = {40.0, 30.0, {}};
  problem.routes = 1;
  const Plan without = plan_on(problem);
  ASSERT_FALSE(without.routes.empty());
  EXPECT_EQ(without.routes.front().decision.starts, nullptr);
  problem.start_error = kError;
  const Plan plan = plan_on(problem);
  ASSERT_FALSE(plan.routes.empty());
  const DriveVerdict& decision = plan.routes.front().decision;
  ASSERT_NE(decision.starts, nullptr);
  EXPECT_EQ(std::count_if(decision.rules.begin(), decision.rules.end(),
                          [](const JudgedRule& rule) { return rule.name == "start"; }),
            1);
  EXPECT_EQ(plan.routes.front().prediction.length_m, without.routes.front().prediction.length_m);
}

}  // namespace
}  // namespace slipway::planner
