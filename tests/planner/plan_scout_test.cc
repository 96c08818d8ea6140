// What a scout drive is worth to the choice between routes, by hand.
#include "planner/judge/plan_scout.h"

#include <gtest/gtest.h>

namespace slipway::planner {
namespace {

// The first half of the draws is firm ground, the second loose.
Route route(int rank, double firm_cost, double loose_cost) {
  Route out;
  out.rank = rank;
  for (int d = 0; d < 200; ++d) out.drawn_costs.push_back({d < 100 ? firm_cost : loose_cost, 1.0});
  return out;
}

std::vector<Route> routes(double firm_slip, double loose_slip) {
  // Straight over the ground that may be loose, and round it.
  std::vector<Route> out{route(1, 1.0, 10.0), route(2, 6.0, 6.0)};
  sim::ScoutDrive scout;
  scout.to_m = 5.0;
  for (int d = 0; d < 200; ++d)
    scout.drawn_slip.push_back(static_cast<float>(d < 100 ? firm_slip : loose_slip));
  out.front().prediction.scout = scout;
  return out;
}

TEST(PlanScout, IsWorthTheExpectedDropOfTheCostOfTheRouteThatIsTaken) {
  const auto scout = scout_of(routes(0.1, 0.6));
  ASSERT_TRUE(scout);
  EXPECT_EQ(scout->route, 1);
  // Now 5.5, straight on. Known: 1 on firm ground and 6 round the loose, 3.5. In one of twenty measurements
  // nothing is learnt.
  EXPECT_NEAR(scout->worth, 2.0 * 0.95, 0.06);
  EXPECT_NEAR(scout->other_route, 0.5, 0.03);
}

TEST(PlanScout, IsWorthNothingWhereTheSlipTellsNothing) {
  const auto scout = scout_of(routes(0.3, 0.3));
  ASSERT_TRUE(scout);
  EXPECT_NEAR(scout->worth, 0.0, 1e-9);
  EXPECT_EQ(scout->other_route, 0.0);
  std::vector<Route> without = routes(0.1, 0.6);
  without.front().prediction.scout.reset();
  EXPECT_FALSE(scout_of(without));
  EXPECT_FALSE(scout_of({}));
}

}  // namespace
}  // namespace slipway::planner
