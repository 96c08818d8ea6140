// What a plan says and does where the way is far aside, or where there is none.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/angle.h"
#include "planner/search/planner_catalogue.h"
#include "planner/search/search_window.h"
#include "tests/planner/ground_fixture.h"

namespace slipway::planner {
namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

// A wall along x = 750 whose only gap is seven cells, 150 m north of the straight line: so narrow that the
// larger cells of the whole map close it.
TEST(SearchWindow, GrowsUntilItHoldsTheOnlyGap) {
  PlanProblem problem = problem_on(1500, 1500, 1.0, 1.0, [](double x, double y) {
    return std::abs(x - 750.5) < 1.0 && std::abs(y - 749.5) > 3.6 ? kNothing : 0.0;
  });
  problem.start = {730.5, 599.5, std::nullopt};
  problem.goal = {770.5, 599.5, std::nullopt};
  problem.routes = 1;
  const KeepOut none({}, *problem.rover);
  const GroundTables tables = build_ground_tables(problem);
  const TraverseMap whole(problem, none, problem.terrain->geometry().extent());
  ASSERT_EQ(window_fit(problem, whole, tables), WindowFit::kNoWay);
  const TraverseMap first(problem, none, search_extent(problem));
  ASSERT_EQ(window_fit(problem, first, tables), WindowFit::kNoWay);
  const Plan plan = plan_on(problem);
  ASSERT_FALSE(plan.routes.empty()) << plan.fewer_because.at(0) << plan.fewer_because.at(1);
  EXPECT_GT(plan.routes.front().prediction.length_m, 300.0);
}

// The wall ends beyond the first window; near its end lies a bank of unknown ground, thinner the further
// aside, so that the best way within the window keeps to the window's edge.
TEST(SearchWindow, GrowsWhereTheBestWayTouchesItsEdge) {
  PlanProblem problem = problem_on(300, 300, 1.0, 1.0, [](double x, double y) {
    return std::abs(x - 150.5) < 1.0 && std::abs(y - 150.0) < 52.0 ? kNothing : 0.0;
  });
  const dem::GridGeometry g = problem.terrain->geometry();
  std::vector<std::uint8_t> mapped;
  for (int row = 0; row < g.rows; ++row)
    for (int column = 0; column < g.columns; ++column) {
      const Eigen::Vector2d p = g.centre_m({row, column});
      const double aside = std::abs(p.y() - 150.0);
      mapped.push_back(aside > 15.0 && std::abs(p.x() - 150.5) < 0.5 * (85.0 - aside) ? 0 : 1);
    }
  problem.soil_map = std::make_shared<dem::SoilMap>(g, std::vector<std::int16_t>(mapped.size(), 0), mapped,
                                                    std::vector<dem::SoilClass>{{0, "a", "firm"}});
  problem.weights.set("unknown", 1000.0);
  problem.start = {130.5, 150.0, std::nullopt};
  problem.goal = {170.5, 150.0, std::nullopt};
  problem.routes = 1;
  const KeepOut none({}, *problem.rover);
  const GroundTables tables = build_ground_tables(problem);
  const TraverseMap first(problem, none, search_extent(problem));
  ASSERT_EQ(window_fit(problem, first, tables), WindowFit::kAtEdge);
  const Plan plan = plan_on(problem);
  ASSERT_FALSE(plan.routes.empty());
  double aside = 0.0;
  for (const auto& s : plan.routes.front().prediction.stations)
    aside = std::max(aside, std::abs(s.station.pose.y_m - 150.0));
  EXPECT_GT(aside, 62.0) << "the first window ends 60 m aside";
}

// A ridge across the whole map, with flanks of `steep_deg` and a saddle of `saddle_deg` at y = 42.
PlanProblem ridge(double steep_deg, double saddle_deg) {
  PlanProblem problem = problem_on(60, 80, 1.0, 1.0, [&](double x, double y) {
    const double flank = std::abs(y - 42.0) < 4.0 ? saddle_deg : steep_deg;
    return std::max(0.0, 6.0 - std::abs(x - 40.0)) * std::tan(rad_from_deg(flank));
  });
  problem.start = {20.0, 20.0, std::nullopt};
  problem.goal = {60.0, 20.0, std::nullopt};
  problem.routes = 1;
  return problem;
}

TEST(NoWay, NamesTheBottleneckAndTheLeastChangeOfALimitThatOpensIt) {
  PlanProblem problem = ridge(22.0, 15.0);
  problem.limits.max_tilt_rad = rad_from_deg(12.0);
  const Plan closed = plan_on(problem);
  ASSERT_TRUE(closed.routes.empty());
  ASSERT_EQ(closed.fewer_because.size(), 1U);
  const std::string& why = closed.fewer_because.front();
  EXPECT_NE(why.find("deg of tilt where 12.0 is the limit"), std::string::npos) << why;
  const auto at = why.find("with max_tilt_deg = ");
  ASSERT_NE(at, std::string::npos) << why;
  const double opened_deg = std::stod(why.substr(at + 20));
  EXPECT_NEAR(opened_deg, 15.0, 1.0) << "the saddle, not the flanks: " << why;
  // It is the least: a tenth of a degree less opens nothing.
  problem.limits.max_tilt_rad = rad_from_deg(opened_deg - 0.2);
  EXPECT_TRUE(plan_on(problem).routes.empty());
  problem.limits.max_tilt_rad = rad_from_deg(opened_deg);
  const Plan open = plan_on(problem);
  ASSERT_FALSE(open.routes.empty()) << open.fewer_because.front();
  const auto& stations = open.routes.front().prediction.stations;
  EXPECT_TRUE(std::any_of(stations.begin(), stations.end(), [](const auto& s) {
    return std::abs(s.station.pose.x_m - 40.0) < 1.0 && std::abs(s.station.pose.y_m - 42.0) < 4.0;
  }));
}

TEST(NoWay, NamesTheKeepOutThatClosesTheWay) {
  PlanProblem problem = ridge(0.0, 0.0);
  problem.keep_out = {{{10.0, 50.0}, {12.0, 50.0}, {12.0, 52.0}},
                      {{39.0, -1.0}, {41.0, -1.0}, {41.0, 61.0}, {39.0, 61.0}}};
  const Plan plan = plan_on(problem);
  ASSERT_TRUE(plan.routes.empty());
  const std::string& why = plan.fewer_because.front();
  EXPECT_NE(why.find("in or too near to a keep-out; with no keep_out/1 there is a way"), std::string::npos)
      << why;
}

TEST(NoWay, NamesTheKeepInThatClosesTheWay) {
  PlanProblem problem = ridge(0.0, 0.0);
  problem.keep_in = {{{-1.0, -1.0}, {90.0, -1.0}, {90.0, 70.0}, {-1.0, 70.0}},
                     {{2.0, 2.0},
                      {38.0, 2.0},
                      {38.0, 6.0},
                      {42.0, 6.0},
                      {42.0, 2.0},
                      {78.0, 2.0},
                      {78.0, 58.0},
                      {41.0, 58.0},
                      {41.0, 7.0},
                      {39.0, 7.0},
                      {39.0, 58.0},
                      {2.0, 58.0}}};
  const Plan plan = plan_on(problem);
  ASSERT_TRUE(plan.routes.empty());
  const std::string& why = plan.fewer_because.front();
  EXPECT_NE(why.find("outside a keep-in or too near to its edge; with no keep_in/1 there is a way"),
            std::string::npos)
      << why;
}

TEST(NoWay, SaysThatNoLimitOpensAWayOverMissingElevation) {
  PlanProblem problem = problem_on(
      60, 80, 1.0, 1.0, [](double x, double) { return std::abs(x - 40.0) < 1.0 ? kNothing : 0.0; });
  problem.start = {20.0, 20.0, std::nullopt};
  problem.goal = {60.0, 20.0, std::nullopt};
  const Plan plan = plan_on(problem);
  ASSERT_TRUE(plan.routes.empty());
  const std::string& why = plan.fewer_because.front();
  EXPECT_NE(why.find("where elevation is missing"), std::string::npos) << why;
  EXPECT_NE(why.find("no limit of the request opens a way"), std::string::npos) << why;
}

TEST(NoWay, SaysWhereTheMeanSoilHoldsNoRover) {
  PlanProblem problem = ridge(19.0, 19.0);
  problem.beliefs.known = {soft_soil("firm")};
  const Plan plan = plan_on(problem);
  ASSERT_TRUE(plan.routes.empty());
  const std::string& why = plan.fewer_because.front();
  EXPECT_NE(why.find("that the mean soil does not hold the rover on"), std::string::npos) << why;
}

// Straight at the goal, whatever lies between.
class Beeline final : public LegPlanner {
 public:
  std::vector<Pose2> search(const LegSearch& leg) const override {
    return {leg.from, {leg.to_x_m, leg.to_y_m, leg.arrival_rad.front()}};
  }
};

class FindsNothing final : public LegPlanner {
 public:
  std::vector<Pose2> search(const LegSearch&) const override { return {}; }
};

template <typename Planner>
std::vector<PlannerRow> only() {
  return {{"only", "for this test", "here", true,
           []() -> std::unique_ptr<LegPlanner> { return std::make_unique<Planner>(); }}};
}

TEST(NoPlannerFoundMotions, NamesThePlaceAndTheLimitThatClosedWhatWasFound) {
  PlanProblem problem = ridge(22.0, 15.0);
  problem.limits.max_tilt_rad = rad_from_deg(18.0);
  NoProgress progress;
  const auto plan = make_plan(problem, progress, only<Beeline>());
  ASSERT_TRUE(plan);
  ASSERT_TRUE(plan->routes.empty());
  ASSERT_GE(plan->fewer_because.size(), 2U);
  EXPECT_NE(plan->fewer_because[1].find("only found is closed at (3"), std::string::npos)
      << plan->fewer_because[1];
  EXPECT_NE(plan->fewer_because[1].find("deg of tilt where 18.0 is the limit"), std::string::npos)
      << plan->fewer_because[1];
}

TEST(NoPlannerFoundMotions, NamesTheHardestPlaceOfTheGridsWayWhereNothingWasFound) {
  PlanProblem problem = ridge(22.0, 15.0);
  problem.limits.max_tilt_rad = rad_from_deg(18.0);
  NoProgress progress;
  const auto plan = make_plan(problem, progress, only<FindsNothing>());
  ASSERT_TRUE(plan);
  ASSERT_TRUE(plan->routes.empty());
  ASSERT_EQ(plan->fewer_because.size(), 2U);
  EXPECT_NE(plan->fewer_because[1].find("the grid's way is steepest at ("), std::string::npos)
      << plan->fewer_because[1];
  EXPECT_NE(plan->fewer_because[1].find("narrowest between"), std::string::npos) << plan->fewer_because[1];
}

// A ring of eight walls around the start, between which the body does not pass.
TEST(NoWay, AStartInsideARingOfKeepOutsIsToldWhichOneClosesIt) {
  PlanProblem problem = problem_on(40, 40, 1.0, 1.0, [](double, double) { return 0.0; });
  problem.start = {10.0, 20.0, std::nullopt};
  problem.goal = {32.0, 20.0, std::nullopt};
  for (int k = 0; k < 8; ++k) {
    const auto corner = [&](double radius, double aside) {
      const double angle = rad_from_deg(45.0 * k + aside);
      return Eigen::Vector2d(10.0 + radius * std::cos(angle), 20.0 + radius * std::sin(angle));
    };
    problem.keep_out.push_back(
        {corner(3.0, -18.0), corner(3.0, 18.0), corner(3.3, 18.0), corner(3.3, -18.0)});
  }
  const Plan plan = plan_on(problem);
  ASSERT_TRUE(plan.routes.empty());
  std::string words;
  for (const std::string& each : plan.fewer_because) words += each + "\n";
  EXPECT_NE(words.find("keep_out/"), std::string::npos) << words;
  EXPECT_EQ(words.find("no planner found"), std::string::npos) << words;
}

TEST(PlanFaults, AGoalWhereTheStartIsIsRefusedAndNamesBoth) {
  PlanProblem problem = problem_on(40, 40, 1.0, 1.0, [](double, double) { return 0.0; });
  problem.start = {10.0, 20.0, std::nullopt};
  problem.goal = {10.0, 20.0, 1.0};
  NoProgress progress;
  const Result<Plan> plan = make_plan(problem, progress);
  ASSERT_FALSE(plan.has_value());
  EXPECT_EQ(plan.error().code, ErrorCode::kInvalidRequest);
  EXPECT_EQ(plan.error().faults.at(0).pointer, "/goal");
  EXPECT_NE(plan.error().faults.at(0).message.find("/start"), std::string::npos);
}

}  // namespace
}  // namespace slipway::planner
