// The figures that rank routes: properties of the CVaR, intervals of paired differences, and their words.
#include "planner/problem/ranking.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "core/angle.h"
#include "core/random.h"
#include "planner/judge/rank.h"
#include "planner/search/metre.h"
#include "tests/planner/ground_fixture.h"

namespace slipway::planner {
namespace {

// Skewed as costs of draws are: most alike, a few dear.
std::vector<WeightedCost> skewed(std::uint64_t key, std::size_t count) {
  std::vector<WeightedCost> costs;
  for (std::size_t k = 0; k < count; ++k)
    costs.push_back({std::exp(random_normal(key, k)), 0.2 + random_uniform(random_key(key, 1), k)});
  return costs;
}

double mean_of(const std::vector<WeightedCost>& costs) {
  double sum = 0.0, weights = 0.0;
  for (const WeightedCost& each : costs) {
    sum += each.weight * each.cost;
    weights += each.weight;
  }
  return sum / weights;
}

TEST(Cvar, IsAtLeastTheMeanGrowsTowardsTheTailAndIsTheMeanWhereTheTailIsAll) {
  for (std::uint64_t key = 0; key < 20; ++key) {
    const auto costs = skewed(key, 37);
    EXPECT_NEAR(conditional_value_at_risk(costs, 1.0), mean_of(costs), 1e-12);
    double before = mean_of(costs);
    for (const double tail : {0.9, 0.5, 0.2, 0.1, 0.01}) {
      const double cvar = conditional_value_at_risk(costs, tail);
      EXPECT_GE(cvar, before - 1e-12) << tail;
      before = cvar;
      const auto weights = tail_weights(costs, tail);
      EXPECT_NEAR(std::accumulate(weights.begin(), weights.end(), 0.0), 1.0, 1e-12);
    }
  }
}

TEST(Cvar, IsByHandTheMeanOfTheWorst) {
  const std::vector<WeightedCost> costs{{1.0}, {9.0}, {2.0}, {5.0}};
  EXPECT_DOUBLE_EQ(conditional_value_at_risk(costs, 0.25), 9.0);
  EXPECT_DOUBLE_EQ(conditional_value_at_risk(costs, 0.5), 7.0);
  EXPECT_DOUBLE_EQ(conditional_value_at_risk(costs, 0.375), (9.0 + 0.5 * 5.0) / 1.5);
  EXPECT_DOUBLE_EQ(conditional_value_at_risk({{3.0}, {3.0}, {3.0}}, 0.1), 3.0);
}

// What makes a sum over cells an upper bound.
TEST(Cvar, OfASumIsAtMostTheSumOfTheCvars) {
  for (std::uint64_t key = 0; key < 20; ++key) {
    const auto a = skewed(key, 50);
    auto b = skewed(key + 100, 50), sum = a;
    for (std::size_t k = 0; k < sum.size(); ++k) {
      b[k].weight = a[k].weight;
      sum[k].cost += b[k].cost;
    }
    EXPECT_LE(conditional_value_at_risk(sum, 0.1),
              conditional_value_at_risk(a, 0.1) + conditional_value_at_risk(b, 0.1) + 1e-9);
  }
}

TEST(CostDifference, OfPairedDrawsIsToldWhereEitherAloneIsNot) {
  auto a = skewed(3, 40), b = a;
  for (std::size_t k = 0; k < b.size(); ++k) b[k].cost += 0.2 + 0.1 * random_uniform(9, k);
  const CostDifference dearer = difference_of(b, a, 1.0), cheaper = difference_of(a, b, 1.0);
  EXPECT_TRUE(dearer.decided());
  EXPECT_NEAR(dearer.value, 0.25, 0.03);
  EXPECT_DOUBLE_EQ(cheaper.value, -dearer.value);
  EXPECT_DOUBLE_EQ(cheaper.low, -dearer.high);
  EXPECT_EQ(dearer.draws, 40);
  EXPECT_FALSE(difference_of(a, a, 1.0).decided());
  EXPECT_FALSE(difference_of(skewed(4, 40), skewed(5, 40), 0.1).decided());
  // Over the draws that both have.
  b.resize(17);
  EXPECT_EQ(difference_of(a, b, 0.5).draws, 17);
  EXPECT_EQ(difference_of(a, {}, 0.5).draws, 0);
}

// Each interval of 90 % holds the true difference in some nine of ten sets of draws; with a tail the true one
// is that of very many draws.
TEST(CostDifference, AnIntervalOf90PercentHoldsTheTruthInNineOfTenSets) {
  const auto pair_of = [](std::uint64_t key, std::size_t count) {
    std::vector<WeightedCost> a, b;
    for (std::size_t k = 0; k < count; ++k) {
      const double ground = random_normal(key, k);
      a.push_back({ground + 0.5 * random_normal(random_key(key, 1), k)});
      b.push_back({1.2 * ground + 0.5 * random_normal(random_key(key, 2), k)});
    }
    return std::pair(a, b);
  };
  for (const double tail : {1.0, 0.25}) {
    const auto [many_a, many_b] = pair_of(77, 200'000);
    const double truth = difference_of(many_a, many_b, tail).value;
    int held = 0;
    for (std::uint64_t key = 0; key < 400; ++key) {
      const auto [a, b] = pair_of(random_key(5, key), 64);
      const CostDifference found = difference_of(a, b, tail);
      held += found.low <= truth && truth <= found.high ? 1 : 0;
    }
    EXPECT_GE(held, 340) << tail;
    EXPECT_LE(held, 384) << tail;
  }
}

// Two routes over the same draws.
std::vector<Route> routes_of(const std::vector<WeightedCost>& first,
                             const std::vector<WeightedCost>& second) {
  std::vector<Route> routes(2);
  routes[0].drawn_costs = first;
  routes[1].drawn_costs = second;
  for (Route& route : routes) {
    route.prediction.draws = static_cast<int>(route.drawn_costs.size());
    for (const WeightedCost& each : route.drawn_costs)
      route.prediction.drawn.push_back({.weight = each.weight, .breaks_a_limit = each.cost > 2.0});
    for (const sim::DrawFigures& draw : route.prediction.drawn)
      route.prediction.risk += (draw.breaks_a_limit ? 1.0 : 0.0) / route.prediction.draws;
    route.cost = conditional_value_at_risk(route.drawn_costs, 1.0);
  }
  return routes;
}

bool says(const Route& route, std::string_view words) {
  for (const std::string& reason : route.reasons)
    if (reason.find(words) != std::string::npos) return true;
  return false;
}

TEST(Explain, SaysByHowMuchTheBestLeadsAndSafestOnlyWhereTheDrawsTellIt) {
  std::vector<WeightedCost> cheap, dear;
  for (int k = 0; k < 64; ++k) {
    cheap.push_back({1.0 + 0.01 * (k % 7)});
    dear.push_back({k % 4 == 0 ? 3.0 : 1.5});
  }
  std::vector<Route> told = routes_of(cheap, dear);
  explain(told);
  EXPECT_TRUE(says(told[0], "best: costs 0.85 less than route 2 in the mean of 64 draws, 90 % interval 0."))
      << told[0].reasons[1];
  EXPECT_TRUE(says(told[0], "safest: risk 0 % against 25 % of route 2, 90 % interval of the difference"));
  EXPECT_TRUE(says(told[1], "behind route 1: cost 1.88 against 1.03 in the mean of 64 draws"));
  EXPECT_EQ(order_of(told[0], told[1], {}), RankOrder::kTold);

  auto near = cheap;
  near[3].cost = 2.5;
  std::vector<Route> alike = routes_of(cheap, near);
  explain(alike);
  EXPECT_TRUE(says(alike[0], "tied with route 2: costs 0.02 less than route 2 in the mean of 64 draws"))
      << alike[0].reasons[1];
  EXPECT_TRUE(says(alike[0], "alike in risk: risk 0 % against 2 % of route 2"));
  EXPECT_FALSE(says(alike[0], "safest"));
  EXPECT_TRUE(says(alike[1], "tied with route 1: cost 1.05 against 1.03"));
  EXPECT_EQ(order_of(alike[0], alike[1], {}), RankOrder::kTied);

  explain(told, {.by = RankBy::kCvar, .tail = 0.25});
  EXPECT_TRUE(says(told[0], "in the mean of the worst 25 % of 64 draws")) << told[0].reasons[1];
}

Route figures(double duration_s, double energy_j, double stops, double embedding) {
  Route route;
  route.prediction.duration_s = duration_s;
  route.prediction.energy_j = energy_j;
  route.prediction.outcomes.expected_stops = stops;
  route.prediction.outcomes.embedding.share = embedding;
  return route;
}

TEST(Pareto, MarksTheRoutesThatNoOtherDominates) {
  std::vector<Route> routes{figures(10, 5, 0.1, 0.01), figures(9, 6, 0.1, 0.01), figures(10, 6, 0.1, 0.01),
                            figures(10, 5, 0.1, 0.01), figures(1, 1, 0.0, 0.0)};
  routes[4].prediction.immobilised.emplace();
  mark_pareto_front(routes);
  EXPECT_TRUE(routes[0].pareto);
  EXPECT_TRUE(routes[1].pareto) << "faster than the first";
  EXPECT_FALSE(routes[2].pareto) << "the first needs less energy and nothing more";
  EXPECT_TRUE(routes[3].pareto) << "equal to the first, so that neither dominates";
  EXPECT_FALSE(routes[4].pareto) << "cheap because it ends early";
  // Where energy is not known, it does not tell routes apart.
  for (Route& route : routes) route.prediction.by_slip_curve = true;
  mark_pareto_front(routes);
  EXPECT_FALSE(routes[0].pareto);
}

TEST(RankedOrder, IsByCostAndWhatBreaksALimitComesLast) {
  std::vector<WeightedCost> dear, cheap, cheapest;
  for (std::size_t k = 0; k < 64; ++k) {
    dear.push_back({6.0 + random_normal(1, k)});
    cheap.push_back({5.0 + random_normal(2, k)});
    cheapest.push_back({2.0 + random_normal(3, k)});
  }
  std::vector<Route> routes = routes_of(dear, cheap);
  routes.push_back(routes_of(cheapest, cheapest).front());
  routes[0].prediction.length_m = 10.0;  // does not help it
  EXPECT_EQ(ranked_order(routes), (std::vector<std::size_t>{2, 1, 0}));
  // Neither an unknown verdict nor a draw of luck changes the order, a broken limit does.
  routes[2].decision.verdict = Verdict::kUnknown;
  EXPECT_EQ(ranked_order(routes), (std::vector<std::size_t>{2, 1, 0}));
  routes[2].decision.verdict = Verdict::kNoGo;
  EXPECT_EQ(ranked_order(routes), (std::vector<std::size_t>{1, 0, 2}));
}

TEST(RankedOrder, IsTiedOnlyWithin3PercentAndOpenWhereFewDrawsDoNotTell) {
  std::vector<WeightedCost> one, other, further;
  for (std::size_t k = 0; k < 64; ++k) {
    one.push_back({5.0 + random_normal(1, k)});
    other.push_back({5.05 + random_normal(2, k)});
    further.push_back({5.0 + 8.0 * std::abs(random_normal(3, k)) * (k % 16 == 0 ? 1.0 : 0.0)});
  }
  const std::vector<Route> close = routes_of(one, other), far = routes_of(one, further);
  const double share = std::abs(far[0].cost - far[1].cost) / std::min(far[0].cost, far[1].cost);
  ASSERT_GT(share, 0.03);
  ASSERT_FALSE(ranked_difference(far[0], far[1], {}).decided());
  EXPECT_EQ(order_of(far[0], far[1], {}), RankOrder::kUndecided);
  EXPECT_EQ(order_of(close[0], close[1], {}), RankOrder::kTied);
}

sim::SoilDistribution without_spread(sim::SoilDistribution soil) {
  soil.std = {};
  return soil;
}

TEST(RankedPlan, WithoutSpreadTheCvarAndTheMeanAreOne) {
  PlanProblem problem = problem_on(
      32, 32, 1.0, 1.0, [](double x, double y) { return 0.4 * std::sin(0.2 * x) * std::cos(0.15 * y); });
  problem.beliefs = {{without_spread(firm_soil("firm"))}, without_spread(soft_soil("unknown"))};
  problem.start = {5.0, 6.0, std::nullopt};
  problem.goal = {26.0, 24.0, std::nullopt};
  for (const RankBy by : {RankBy::kExpected, RankBy::kCvar}) {
    problem.ranking = {by, 0.1};
    const Plan plan = plan_on(problem);
    ASSERT_FALSE(plan.routes.empty());
    for (const Route& route : plan.routes) {
      EXPECT_NEAR(route.cvar_cost, route.expected_cost, 1e-5 * route.cost);
      EXPECT_EQ(route.cost, by == RankBy::kCvar ? route.cvar_cost : route.expected_cost);
    }
  }
}

TEST(RankedPlan, TheCvarIsAtLeastTheMeanAndTheTermsAddUpToWhatRanks) {
  PlanProblem problem = problem_on(
      32, 32, 1.0, 1.0, [](double x, double y) { return 0.8 * std::sin(0.2 * x) * std::cos(0.15 * y); });
  problem.start = {5.0, 6.0, std::nullopt};
  problem.goal = {26.0, 24.0, std::nullopt};
  problem.risk.draws = 24;
  for (const Ranking& ranking : {Ranking{}, Ranking{RankBy::kCvar, 0.2}, Ranking{RankBy::kCvar, 1.0}}) {
    problem.ranking = ranking;
    const Plan plan = plan_on(problem);
    ASSERT_FALSE(plan.routes.empty());
    const Route* before = nullptr;
    for (const Route& route : plan.routes) {
      EXPECT_GE(route.cvar_cost, route.expected_cost - 1e-12);
      if (ranking.tail == 1.0) {
        EXPECT_NEAR(route.cvar_cost, route.expected_cost, 1e-9);
      }
      double sum = 0.0;
      for (const CostShare& share : route.shares) sum += share.cost;
      EXPECT_NEAR(sum, route.cost, 1e-9);
      if (before != nullptr && (before->verdict() == Verdict::kNoGo) == (route.verdict() == Verdict::kNoGo)) {
        EXPECT_GE(route.cost, before->cost);
      }
      before = &route;
    }
  }
}

TEST(RankedPlan, ATailOfNothingOrOfMoreThanAllIsRefusedAtItsPlace) {
  for (const double tail : {0.0, -0.1, 1.01, std::nan("")}) {
    PlanProblem problem = problem_of("S . . . . . . .\n. . . . . . . G\n");
    problem.ranking.tail = tail;
    NoProgress progress;
    const Result<Plan> plan = make_plan(problem, progress);
    ASSERT_FALSE(plan.has_value());
    EXPECT_EQ(plan.error().faults.at(0).pointer, "/ranking/tail") << tail;
  }
}

// On slopes from level to steep: what a metre adds.
TEST(Metre, StopsGrowWithTheSlopeAndTheTailCostsAtLeastTheMeanOfItsGround) {
  PlanProblem problem = problem_of("S . .\n. . .\n. . G\n");
  problem.ranking.by = RankBy::kCvar;
  problem.beliefs.known = {soft_soil("firm")};
  const GroundTables tables = build_ground_tables(problem);
  const GroundTable& table = *tables.known.at(0);
  ASSERT_FALSE(table.likely.empty());
  double before = -1.0;
  for (const double deg : {0.0, 4.0, 8.0, 10.0, 12.0}) {
    const auto metre = expected_metre(problem, table, false, -rad_from_deg(deg), 0.0);
    if (!metre) break;
    EXPECT_GE(metre->figures.expected_stops, before) << deg;
    before = metre->figures.expected_stops;
    const auto tail = [&](double share) {
      return tail_cost_of_metre(problem, table, false, -rad_from_deg(deg), 0.0, problem.weights, share);
    };
    EXPECT_GE(tail(0.1), tail(0.5));
    EXPECT_GE(tail(0.5), tail(1.0));
  }
  EXPECT_GT(before, 0.001);
}

}  // namespace
}  // namespace slipway::planner
