#include "planner/search/leg_bound.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/random.h"
#include "planner/search/smooth_route.h"
#include "tests/planner/plan_fixture.h"

namespace slipway::planner {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kSide = 12;

// Hills of up to so many steps, as smooth as a sum of two waves of random directions, with walls in some.
std::string hills(std::uint64_t seed, double steps, bool with_wall) {
  std::string drawing;
  const auto wave = [&](std::uint64_t k, int row, int column) {
    const std::uint64_t key = random_key(seed, k);
    const double along = 0.2 + 0.5 * random_uniform(key, 0), turn = 6.3 * random_uniform(key, 1);
    return std::sin(along * (row * std::cos(turn) + column * std::sin(turn)) + 6.3 * random_uniform(key, 2));
  };
  for (int row = 0; row < kSide; ++row) {
    for (int column = 0; column < kSide; ++column) {
      char what = static_cast<char>(
          '0' + std::lround(0.25 * steps * (2.0 + wave(0, row, column) + wave(1, row, column))));
      if (with_wall && column == 6 && row > 2 && row < 9) what = '#';
      if (row == 3 && column == 2) what = 'S';
      if (row == 8 && column == 9) what = 'G';
      drawing += what;
      drawing += column + 1 < kSide ? ' ' : '\n';
    }
  }
  return drawing;
}

struct Ground {
  explicit Ground(PlanProblem of) : problem(std::move(of)) {}

  PlanProblem problem;
  KeepOut keep_out{problem.keep_out, *problem.rover};
  GroundTables tables = build_ground_tables(problem);
  TraverseMap map{problem, keep_out, problem.terrain->geometry().extent()};
  MotionCost cost{problem, map, tables, problem.weights};
  GridSearch grid{cost};

  double bound() const {
    return least_cost_of_leg(cost, grid.cost_to_go(problem.goal.x_m, problem.goal.y_m), problem.start,
                             problem.goal);
  }

  // By straights between any two cells, in any direction, turns in place free: Dijkstra over all pairs.
  double brute_force() const {
    const double step = 0.1 * map.cell_m();
    std::vector<double> reached(map.cells(), kInfinity);
    std::vector<bool> left(map.cells(), false);
    const auto goal = static_cast<std::size_t>(map.index_at(problem.goal.x_m, problem.goal.y_m));
    reached[static_cast<std::size_t>(map.index_at(problem.start.x_m, problem.start.y_m))] = 0.0;
    for (;;) {
      std::size_t at = map.cells();
      for (std::size_t i = 0; i < map.cells(); ++i)
        if (!left[i] && reached[i] < (at < map.cells() ? reached[at] : kInfinity)) at = i;
      if (at == map.cells() || at == goal) return reached[goal];
      left[at] = true;
      const Eigen::Vector2d from = map.centre_m(at);
      for (std::size_t to = 0; to < map.cells(); ++to) {
        if (left[to]) continue;
        const Eigen::Vector2d way = map.centre_m(to) - from;
        const double sum = reached[at] + cost.of(straight({from.x(), from.y(), std::atan2(way.y(), way.x())},
                                                          map.centre_m(to).x(), map.centre_m(to).y()),
                                                 step);
        if (sum < reached[to]) reached[to] = sum;
      }
    }
  }
};

TEST(LegBound, IsNoMoreThanTheCheapestOfAllStraightsOnRandomHills) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const Ground ground(problem_of(hills(seed, 1.0 + static_cast<double>(seed % 4), seed % 3 == 0)));
    const double least = ground.brute_force();
    ASSERT_TRUE(std::isfinite(least)) << seed;
    EXPECT_LE(ground.bound(), least) << seed;
    EXPECT_GT(ground.bound(), 0.8 * least) << seed;
  }
}

TEST(LegBound, OnEvenGroundIsWithinTwoPercent) {
  const Ground ground(problem_of(hills(1, 0.0, false)));
  const double least = ground.brute_force();
  EXPECT_LE(ground.bound(), least);
  EXPECT_GT(ground.bound(), 0.98 * least);
}

TEST(LegBound, IsNoughtWhereThereIsNoWay) {
  PlanProblem problem = problem_of("S . . # . . G\n. . . # . . .\n. . . # . . .\n");
  EXPECT_EQ(Ground(problem).bound(), 0.0);
}

}  // namespace
}  // namespace slipway::planner
