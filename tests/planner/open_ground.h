#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <string_view>

#include "planner/make_plan.h"
#include "tests/planner/plan_fixture.h"

namespace slipway::planner {

inline constexpr std::string_view kOpen = R"(
. . . . . . . . . . . . . . . . . . . . . .
. . . . . . . . . . . . . . . . . . . . . .
. . . . . . . . . . . . . . . . . . . . . .
. . . . . . . . . . . . . . . . . . . . . .
. . . S . . . . . . . . . . . . . . . G . .
. . . . . . . . . . . . . . . . . . . . . .
. . . . . . . . . . . . . . . . . . . . . .
. . . . . . . . . . . . . . . . . . . . . .
. . . . . . . . . . . . . . . . . . . . . .
)";

// With one gap between what lies west and what lies east.
inline constexpr std::string_view kOneGap = R"(
. . . . . . . . . . # . . . . . . . . . . .
. . . . . . . . . . # . . . . . . . . . . .
. . . . . . . . . . # . . . . . . . . . . .
. . . . . . . . . . # . . . . . . . . . . .
. . . S . . . . . . . . . . . . . . . G . .
. . . . . . . . . . . . . . . . . . . . . .
. . . . . . . . . . . . . . . . . . . . . .
. . . . . . . . . . # . . . . . . . . . . .
. . . . . . . . . . # . . . . . . . . . . .
)";

inline Plan plan_of(const PlanProblem& problem) {
  NoProgress progress;
  Result<Plan> plan = make_plan(problem, progress);
  EXPECT_TRUE(plan.has_value()) << plan.error().detail;
  return plan.value_or(Plan{});
}

inline bool ever(const Route& route, const std::function<bool(const sim::StationPrediction&)>& is) {
  return std::any_of(route.prediction.stations.begin(), route.prediction.stations.end(), is);
}

}  // namespace slipway::planner
