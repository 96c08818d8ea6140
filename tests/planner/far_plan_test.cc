// Plans over distances for which one window of finest cells would not do.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <ctime>
#include <mutex>
#include <numeric>
#include <string>

#include "planner/search/block_map.h"
#include "planner/search/corridor.h"
#include "planner/search/far_search.h"
#include "planner/search/grid_search.h"
#include "tests/planner/ground_fixture.h"

namespace slipway::planner {
namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

// Waves of many lengths and directions, with slopes up to what the rover does not climb.
double hills_m(double x, double y) {
  double sum = 0.0;
  for (int k = 0; k < 9; ++k) {
    const double wave = 600.0 * std::pow(0.6, k), turned = 1.7 * k;
    sum += 0.009 * wave *
           std::sin(2.0 * 3.14159265 / wave * (x * std::cos(turned) + y * std::sin(turned)) + 0.4 * k * k);
  }
  return sum;
}

PlanProblem hills(int rows, int columns) {
  PlanProblem problem = problem_on(rows, columns, 1.0, 1.0, hills_m);
  problem.routes = 1;
  return problem;
}

// Of the request's own objective, on every cell of the map.
double optimum_on_all_cells(const PlanProblem& problem, const KeepOut& none, const GroundTables& tables) {
  NoProgress progress;
  const dem::GridGeometry g = finest_geometry(problem.terrain->geometry());
  std::vector<std::uint32_t> all(static_cast<std::size_t>(block_columns(g) * block_rows(g)));
  std::iota(all.begin(), all.end(), 0U);
  const TraverseMap map(problem, none, all, progress);
  const MotionCost cost(problem, map, tables, problem.weights, problem.ranking.ranked_tail());
  const GridSearch grid(cost);
  const CostField to_go = grid.cost_to_go(problem.goal.x_m, problem.goal.y_m);
  return to_go.cost[static_cast<std::size_t>(map.index_at(problem.start.x_m, problem.start.y_m))];
}

TEST(FarPlan, CostsHardlyMoreThanTheGridOfAllCells) {
  PlanProblem problem = hills(900, 1100);
  const KeepOut none({}, *problem.rover);
  const GroundTables tables = build_ground_tables(problem);
  NoProgress progress;
  int pairs = 0;
  for (const auto& [from, to] : {std::pair{Eigen::Vector2d(60.5, 80.5), Eigen::Vector2d(1040.5, 820.5)},
                                 {Eigen::Vector2d(90.5, 800.5), Eigen::Vector2d(1000.5, 300.5)},
                                 {Eigen::Vector2d(500.5, 40.5), Eigen::Vector2d(620.5, 860.5)}}) {
    problem.start = {from.x(), from.y(), std::nullopt};
    problem.goal = {to.x(), to.y(), std::nullopt};
    const double all = optimum_on_all_cells(problem, none, tables);
    if (!std::isfinite(all)) continue;
    ++pairs;
    const FarProposal far = propose_far_routes(problem, {}, none, tables, progress);
    EXPECT_GE(far.proposal.grid_optimum, all * 0.9999);
    EXPECT_LE(far.proposal.grid_optimum, all * 1.02);
    ASSERT_FALSE(far.proposal.candidates.empty());
    // Turns cost, which the grid has for nothing; its sixteen directions cost too.
    EXPECT_LE(far.proposal.candidates[far.proposal.by_cost().front()].cost, all * 1.1);
  }
  EXPECT_GE(pairs, 2);
}

// Walls of rooms of 64 m, each with one gap of 4 m, over gentle waves.
double rooms_m(double x, double y) {
  const auto stands = [](double across, double along, double salt) {
    const double room = std::floor(along / 64.0), wall = std::round(across / 64.0);
    const double gap_at = 10.0 + std::fmod(17.0 * room + 29.0 * wall + salt, 44.0);
    return std::abs(across - 64.0 * wall) < 1.5 && std::abs(along - 64.0 * room - gap_at) > 2.0;
  };
  return 0.15 * hills_m(x, y) + (stands(x, y, 3.0) || stands(y, x, 11.0) ? 4.0 : 0.0);
}

TEST(FarPlan, CostsHardlyMoreThanTheGridOfAllCellsBetweenWallsEither) {
  PlanProblem problem = problem_on(900, 1100, 1.0, 1.0, rooms_m);
  problem.routes = 1;
  problem.start = {30.5, 40.5, std::nullopt};
  problem.goal = {1050.5, 850.5, std::nullopt};
  const KeepOut none({}, *problem.rover);
  const GroundTables tables = build_ground_tables(problem);
  NoProgress progress;
  const double all = optimum_on_all_cells(problem, none, tables);
  ASSERT_TRUE(std::isfinite(all));
  const FarProposal far = propose_far_routes(problem, {}, none, tables, progress);
  EXPECT_GE(far.proposal.grid_optimum, all * 0.9999);
  EXPECT_LE(far.proposal.grid_optimum, all * 1.02);
}

// Of the best route around a wall of 30 m on cells of 1 m, whose one gap is 6 m wide and off the straight
// line.
bool stops_beside_wall(int side, double from_wall_m, double start_y_m, double gap_at_m) {
  const double wall_at_m = 0.5 * side + 0.5;
  PlanProblem problem = problem_on(side, side, 1.0, 1.0, [&](double x, double y) {
    const bool is_wall = std::abs(x - wall_at_m) < 2.0 && std::abs(y - gap_at_m) > 3.0;
    return 0.5 * hills_m(x, y) + (is_wall ? 30.0 : 0.0);
  });
  const auto rover = std::make_shared<sim::RoverModel>(*test_rover());
  rover->body_width_m = 2.9;
  for (sim::WheelModel& wheel : rover->wheels) wheel.position_m.y() *= 2.0;
  problem.rover = rover;
  problem.start = {wall_at_m - from_wall_m, start_y_m, std::nullopt};
  problem.goal = {wall_at_m + from_wall_m, start_y_m, std::nullopt};
  problem.routes = 1;
  problem.risk.draws = 1;
  const Plan plan = plan_on(problem);
  if (plan.routes.empty()) {
    ADD_FAILURE() << plan.fewer_because.at(0);
    return true;
  }
  return plan.routes.front().prediction.immobilised.has_value();
}

// Heights run on between cells: a wheel beside a wall's last open cell stands on its foot.
TEST(FarPlan, KeepsItsWheelsOffTheFootOfAWall) {
  for (const double gap_at : {1200.0, 1350.0, 1449.0})
    EXPECT_FALSE(stops_beside_wall(1500, 250.0, 400.5, gap_at)) << "gap at " << gap_at;
}

TEST(ShortPlan, KeepsItsWheelsOffTheFootOfAWall) {
  for (const double gap_at : {60.0, 90.3, 120.7, 149.0})
    EXPECT_FALSE(stops_beside_wall(200, 40.0, 50.5, gap_at)) << "gap at " << gap_at;
}

// The block map's joints are those of the cells, walls and gaps alike.
TEST(BlockMap, JoinsWhatTheCellsJoin) {
  const auto walls = [](double x, double y, double gap_at_m, double gap_m) {
    return std::abs(x - 200.5) < 1.0 && std::abs(y - gap_at_m) > 0.5 * gap_m ? kNothing : 0.0;
  };
  for (const double gap_at : {40.3, 47.9, 128.0, 300.6}) {
    for (const double gap : {0.0, 3.0, 7.0, 9.0}) {
      PlanProblem problem =
          problem_on(400, 400, 1.0, 1.0, [&](double x, double y) { return walls(x, y, gap_at, gap); });
      problem.start = {150.5, 200.5, std::nullopt};
      problem.goal = {250.5, 200.5, std::nullopt};
      const KeepOut none({}, *problem.rover);
      const GroundTables tables = build_ground_tables(problem);
      const bool leads = std::isfinite(optimum_on_all_cells(problem, none, tables));
      NoProgress progress;
      const BlockMap blocks(problem, none, progress);
      const auto from = blocks.node_at(150.5, 200.5), to = blocks.node_at(250.5, 200.5);
      ASSERT_TRUE(from && to);
      EXPECT_EQ(reach_of(blocks, *from, *to).leads, leads) << "gap of " << gap << " m at " << gap_at;
    }
  }
}

TEST(FarPlan, FindsTheOnlyGapFarAside) {
  PlanProblem problem = problem_on(1500, 1500, 1.0, 1.0, [](double x, double y) {
    const bool first = std::abs(x - 500.5) < 2.0 && std::abs(y - 1450.0) > 4.0;
    const bool second = std::abs(x - 900.5) < 2.0 && std::abs(y - 60.0) > 4.0;
    return first || second ? 25.0 : 0.0;
  });
  problem.start = {450.5, 100.5, std::nullopt};
  problem.goal = {1000.5, 100.5, std::nullopt};
  problem.routes = 1;
  problem.risk.draws = 1;
  const Plan plan = plan_on(problem);
  ASSERT_FALSE(plan.routes.empty()) << plan.fewer_because.at(0);
  EXPECT_GT(plan.routes.front().prediction.length_m, 2700.0);
  EXPECT_FALSE(plan.routes.front().prediction.immobilised);
}

// What was read of a map around the places is not the map: a wall may have its gap beyond.
TEST(FarPlan, AsksForMoreTerrainWhereThereIsNoWayOrTheBestComesToItsEdge) {
  const auto needs_more = [](double gap_at_m, bool is_whole_map) {
    PlanProblem problem = problem_on(800, 900, 1.0, 1.0, [&](double x, double y) {
      return std::abs(x - 450.5) < 2.0 && std::abs(y - gap_at_m) > 4.0 ? 25.0 : 0.0;
    });
    problem.start = {60.5, 400.5, std::nullopt};
    problem.goal = {840.5, 400.5, std::nullopt};
    problem.terrain_is_whole_map = is_whole_map;
    problem.routes = 1;
    problem.risk.draws = 1;
    return plan_on(problem).needs_wider_terrain;
  };
  EXPECT_TRUE(needs_more(2'000.0, false)) << "no gap in sight";
  EXPECT_TRUE(needs_more(797.5, false)) << "the only one is at the edge";
  EXPECT_FALSE(needs_more(600.5, false));
  EXPECT_FALSE(needs_more(2'000.0, true)) << "there is no more";
}

TEST(FarPlan, SaysHowNearTheReachableGroundComesWhereThereIsNoWay) {
  PlanProblem problem = problem_on(
      800, 900, 1.0, 1.0, [](double x, double) { return std::abs(x - 500.5) < 6.0 ? kNothing : 0.0; });
  problem.start = {60.5, 100.5, std::nullopt};
  problem.goal = {840.5, 700.5, std::nullopt};
  const Plan plan = plan_on(problem);
  ASSERT_TRUE(plan.routes.empty());
  ASSERT_EQ(plan.fewer_because.size(), 1U);
  EXPECT_NE(plan.fewer_because[0].find("on the whole map: from the start"), std::string::npos)
      << plan.fewer_because[0];
}

TEST(FarPlan, IsTheSameOnAnyNumberOfThreads) {
  PlanProblem problem = hills(700, 1000);
  problem.start = {60.5, 80.5, std::nullopt};
  problem.goal = {940.5, 620.5, std::nullopt};
  problem.routes = 2;
  problem.risk.draws = 2;
  problem.threads = 1;
  const Plan one = plan_on(problem);
  problem.threads = 3;
  const Plan three = plan_on(problem);
  ASSERT_FALSE(one.routes.empty());
  ASSERT_EQ(one.routes.size(), three.routes.size());
  for (std::size_t r = 0; r < one.routes.size(); ++r) {
    EXPECT_EQ(one.routes[r].cost, three.routes[r].cost);
    const auto &a = one.routes[r].prediction.stations, &b = three.routes[r].prediction.stations;
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t s = 0; s < a.size(); ++s) {
      EXPECT_EQ(a[s].station.pose.x_m, b[s].station.pose.x_m);
      EXPECT_EQ(a[s].state.slip_ratio, b[s].state.slip_ratio);
    }
  }
}

// Beyond a kilometre a drive is decided in segments.
TEST(FarPlan, HasSegmentsWithVerdictsOfTheirOwn) {
  PlanProblem problem = hills(500, 1300);
  problem.start = {60.5, 250.5, std::nullopt};
  problem.goal = {1240.5, 250.5, std::nullopt};
  problem.risk.draws = 8;
  const Plan plan = plan_on(problem);
  ASSERT_FALSE(plan.routes.empty()) << plan.fewer_because.at(0);
  const sim::DrivePrediction& drive = plan.routes.front().prediction;
  const std::vector<sim::SegmentRisk>& segments = drive.outcomes.segments;
  ASSERT_GE(segments.size(), 4U);
  EXPECT_EQ(segments.front().from_m, 0.0);
  EXPECT_NEAR(segments.back().to_m, drive.length_m, 1.0);
  double most = 0.0;
  for (std::size_t k = 0; k < segments.size(); ++k) {
    if (k > 0) {
      EXPECT_EQ(segments[k].from_m, segments[k - 1].to_m);
    }
    most = std::max(most, segments[k].stop.share * segments[k].reached);
  }
  EXPECT_LE(most, drive.outcomes.stop.share + 1e-9) << "a halt on a segment is one on the way";
}

class Listens final : public Progress {
 public:
  void report(std::string_view stage, double fraction) override {
    const std::scoped_lock lock(mutex_);
    backwards_ |= fraction < last_ - 1e-9;
    last_ = fraction;
    stages_.emplace_back(stage);
  }
  bool cancelled() const override { return cancelled_; }
  void found(const RouteSoFar& route) override {
    const std::scoped_lock lock(mutex_);
    routes_.push_back(route);
  }
  std::mutex mutex_;
  std::atomic<bool> cancelled_{false};
  bool backwards_ = false;
  double last_ = 0.0;
  std::vector<std::string> stages_;
  std::vector<RouteSoFar> routes_;
};

TEST(FarPlan, TellsTheBestSoFarAndItsProgress) {
  PlanProblem problem = hills(500, 1000);
  problem.start = {60.5, 250.5, std::nullopt};
  problem.goal = {940.5, 250.5, std::nullopt};
  problem.risk.draws = 2;
  Listens listens;
  const Result<Plan> plan = make_plan(problem, listens);
  ASSERT_TRUE(plan);
  ASSERT_FALSE(plan->routes.empty());
  ASSERT_FALSE(listens.routes_.empty());
  EXPECT_FALSE(listens.routes_.front().verdict.empty()) << "judged before other planners begin";
  EXPECT_FALSE(listens.routes_.back().verdict.empty());
  for (const RouteSoFar& route : listens.routes_) {
    EXPECT_GT(route.length_m, 800.0);
    EXPECT_LE(route.line_m.size(), 300U);
    EXPECT_NEAR(route.line_m.front()[0], 60.5, 1e-6);
    EXPECT_NEAR(route.line_m.back()[0], 940.5, 0.05);
  }
  EXPECT_FALSE(listens.backwards_);
}

// How long the work goes on at most between two questions whether it was cancelled, in time of the processor.
class AskedOften final : public Progress {
 public:
  void report(std::string_view stage, double /*fraction*/) override {
    const std::scoped_lock lock(mutex_);
    stage_ = stage;
  }
  bool cancelled() const override {
    const std::scoped_lock lock(mutex_);
    const std::clock_t now = std::clock();
    const double silent_s = static_cast<double>(now - last_) / CLOCKS_PER_SEC;
    last_ = now;
    if (silent_s > longest_s_) {
      longest_s_ = silent_s;
      where_ = stage_;
    }
    return false;
  }
  double longest_s() const { return longest_s_; }
  const std::string& where() const { return where_; }

 private:
  mutable std::mutex mutex_;
  mutable std::clock_t last_ = std::clock();
  mutable double longest_s_ = 0.0;
  mutable std::string where_;
  std::string stage_;
};

TEST(FarPlan, AsksAllTheTimeWhetherItWasCancelled) {
  PlanProblem problem = hills(900, 1100);
  problem.start = {60.5, 80.5, std::nullopt};
  problem.goal = {1040.5, 820.5, std::nullopt};
  problem.routes = 3;
  problem.risk.draws = 16;
  AskedOften progress;
  const Result<Plan> plan = make_plan(problem, progress);
  ASSERT_TRUE(plan);
  EXPECT_FALSE(plan->routes.empty());
  EXPECT_LT(progress.longest_s(), 0.5) << "while " << progress.where();
}

}  // namespace
}  // namespace slipway::planner
