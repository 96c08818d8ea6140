#include "planner/search/traverse_map.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "core/angle.h"
#include "planner/search/grid_search.h"
#include "planner/search/smooth_route.h"
#include "tests/planner/ground_fixture.h"

namespace slipway::planner {
namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

TEST(TraverseMap, ALargeCellIsClosedWhereAnyTerrainCellInItIs) {
  PlanProblem problem = problem_on(1500, 1500, 1.0, 1.0, [](double x, double y) {
    if (random_uniform(random_key(3, static_cast<std::uint64_t>(x) * 4096 + static_cast<std::uint64_t>(y)),
                       1) < 1e-4)
      return kNothing;
    return rock_m(x, y, 1.0, 1.0, 0.0035);
  });
  problem.start = {700.0, 700.0, std::nullopt};
  problem.goal = {700.0, 700.0, std::nullopt};
  const KeepOut none({}, *problem.rover);
  const TraverseMap coarse(problem, none, problem.terrain->geometry().extent());
  const TraverseMap fine(problem, none, {600.0, 600.0, 690.0, 690.0});
  ASSERT_GT(coarse.cell_m(), 2.5);
  ASSERT_EQ(fine.cell_m(), 1.0);
  int closed = 0;
  for (std::size_t i = 0; i < fine.cells(); ++i) {
    if (fine.cell(i).passage == Passage::kFree) continue;
    ++closed;
    const Eigen::Vector2d place = fine.centre_m(i);
    const auto over = static_cast<std::size_t>(coarse.index_at(place.x(), place.y()));
    EXPECT_NE(coarse.cell(over).passage, Passage::kFree) << place.transpose();
  }
  EXPECT_GT(closed, 100);
}

TEST(TraverseMap, ACellThatHoldsAPlaceOfTheProblemIsJudgedAtThatPlace) {
  // A step of 0.9 m along x = 752.
  PlanProblem problem =
      problem_on(1500, 1500, 1.0, 1.0, [](double x, double) { return x > 752.0 && x < 753.0 ? 0.9 : 0.0; });
  const KeepOut none({}, *problem.rover);
  problem.start = problem.goal = {100.0, 100.0, std::nullopt};
  const TraverseMap away(problem, none, problem.terrain->geometry().extent());
  const auto at = [](const TraverseMap& map, double x) {
    return map.cell(static_cast<std::size_t>(map.index_at(x, 750.5))).passage;
  };
  // The cells from 750 to 753 reach the step, the place at 750.5 does not.
  ASSERT_EQ(at(away, 750.5), Passage::kRough);
  problem.start = {750.5, 750.5, std::nullopt};
  EXPECT_EQ(at(TraverseMap(problem, none, problem.terrain->geometry().extent()), 750.5), Passage::kFree);
}

TEST(TraverseMap, OfATransposedTerrainIsTheTransposedMapAlsoWhereCellsAreNotSquare) {
  const auto height = [](double x, double y) {
    return 0.3 * std::sin(0.5 * x) * std::cos(0.4 * y) + rock_m(x, y, 1.0, 0.25, 0.005);
  };
  const int rows = 240, columns = 60;
  const PlanProblem problem = problem_on(rows, columns, 1.0, 0.25, height);
  // Reflected in the line x = y: east becomes north.
  const PlanProblem transposed =
      problem_on(columns, rows, 0.25, 1.0, [&](double x, double y) { return height(y, x); });
  const KeepOut none({}, *problem.rover);
  const TraverseMap map(problem, none, problem.terrain->geometry().extent());
  const TraverseMap other(transposed, none, transposed.terrain->geometry().extent());
  ASSERT_EQ(map.cells(), other.cells());
  EXPECT_EQ(map.cell_m(), other.cell_m());
  int closed = 0;
  for (std::size_t i = 0; i < map.cells(); ++i) {
    const Eigen::Vector2d place = map.centre_m(i);
    const GroundCell& here = map.cell(i);
    const GroundCell& there = other.cell(static_cast<std::size_t>(other.index_at(place.y(), place.x())));
    EXPECT_EQ(here.passage, there.passage) << place.transpose();
    EXPECT_NEAR(here.gradient_x, there.gradient_y, 1e-5);
    EXPECT_NEAR(here.rise_m, there.rise_m, 1e-5);
    closed += here.passage == Passage::kFree ? 0 : 1;
  }
  EXPECT_GT(closed, 50);
  EXPECT_LT(closed, static_cast<int>(map.cells()) / 2);
}

// Many slopes that the rover gets down and not up.
// Rocks, slopes, a gap in the elevation and an area to keep out of.
PlanProblem varied_ground(double cell_m) {
  PlanProblem problem = problem_on(150, 210, cell_m, cell_m, [&](double x, double y) {
    if (std::hypot(x - 60.0 * cell_m, y - 50.0 * cell_m) < 5.0 * cell_m)
      return std::numeric_limits<double>::quiet_NaN();
    return 3.0 * std::sin(x / 11.0) * std::cos(y / 8.0) + rock_m(x, y, cell_m, cell_m, 0.01);
  });
  const double u = 100.0 * cell_m;
  problem.keep_out = {{{u, u}, {u + 9.0, u}, {u + 4.0, u + 7.0}}};
  problem.start = {20.3 * cell_m, 30.1 * cell_m, std::nullopt};
  problem.goal = {180.3 * cell_m, 120.1 * cell_m, std::nullopt};
  return problem;
}

TEST(TraverseMap, OfAllTheTerrainInStripesIsTheSame) {
  NoProgress progress;
  for (const double cell_m : {0.25, 0.5, 1.0}) {
    const PlanProblem problem = varied_ground(cell_m);
    const KeepOut keep_out(problem.keep_out, *problem.rover);
    for (const long long most : {kMaxSearchCells, 3'000LL}) {
      const TraverseMap map(problem, keep_out, most, progress);
      const GroundJudge judge(problem, keep_out, map.geometry());
      ASSERT_LE(static_cast<long long>(map.cells()), most);
      int open = 0;
      for (std::size_t i = 0; i < map.cells(); ++i) {
        const GroundCell& cell = map.cell(i);
        const GroundCell alone = judge.cell(*problem.terrain, map.centre_m(i));
        ASSERT_EQ(cell.passage, alone.passage) << i;
        ASSERT_EQ(cell.soil, alone.soil) << i;
        if (cell.passage != Passage::kFree && cell.passage != Passage::kNearKeepOut) continue;
        ++open;
        ASSERT_NEAR(cell.gradient_x, alone.gradient_x, 1e-4) << i;
        ASSERT_NEAR(cell.gradient_y, alone.gradient_y, 1e-4) << i;
        ASSERT_NEAR(cell.tilt_rad, alone.tilt_rad, 1e-4) << i;
        ASSERT_NEAR(cell.rise_m, alone.rise_m, 1e-4) << i;
      }
      EXPECT_GT(open, 100) << cell_m << " m, at most " << most << " cells";
      EXPECT_LT(open, static_cast<int>(map.cells()) - 10);
    }
  }
}

TEST(GridSearch, CostToGoAndCostToComeAreTheSameWayOverOneWaySlopes) {
  PlanProblem problem = problem_on(60, 60, 1.0, 1.0, [](double x, double y) {
    return 0.42 * std::sin(0.35 * x) * std::sin(0.3 * y) + 0.16 * std::sin(0.9 * x + 0.7 * y);
  });
  problem.beliefs.known = {soft_soil("firm")};
  const KeepOut none({}, *problem.rover);
  const TraverseMap map(problem, none, problem.terrain->geometry().extent());
  const GroundTables tables = build_ground_tables(problem);
  const MotionCost cost(problem, map, tables, problem.weights);
  const GridSearch grid(cost);
  int reached = 0, one_way = 0;
  for (int k = 0; k < 12; ++k) {
    const Eigen::Vector2d a(6.5 + 4.0 * k, 10.5 + 3.0 * (k % 5));
    const CostField come = grid.cost_to_come(a.x(), a.y());
    const CostField back = grid.cost_to_go(a.x(), a.y());
    for (int j = 0; j < 12; ++j) {
      const Eigen::Vector2d b(53.5 - 4.0 * j, 45.5 - 3.0 * (j % 7));
      const CostField go = grid.cost_to_go(b.x(), b.y());
      const auto from = static_cast<std::size_t>(map.index_at(a.x(), a.y()));
      const auto to = static_cast<std::size_t>(map.index_at(b.x(), b.y()));
      ASSERT_EQ(std::isfinite(come.cost[to]), std::isfinite(go.cost[from])) << a << " to " << b;
      if (!std::isfinite(come.cost[to])) continue;
      ++reached;
      one_way += std::isfinite(back.cost[to]) ? 0 : 1;
      EXPECT_NEAR(come.cost[to], go.cost[from], 1e-4 * go.cost[from]) << a << " to " << b;
    }
  }
  EXPECT_GT(reached, 20);
  EXPECT_GT(one_way, 5);
}

TEST(RoundCorner, LeavesNoGapAndNoKinkForAnyTurnAndRadius) {
  for (double turn_deg = -100.0; turn_deg <= 100.0; turn_deg += 0.5) {
    if (turn_deg == 0.0) continue;
    for (const double radius : {1.5, 2.5, 4.0, 6.0, 10.0}) {
      const Motion in = straight({3.0, -2.0, 0.7}, 3.0 + 20.0 * std::cos(0.7), -2.0 + 20.0 * std::sin(0.7));
      const double on = 0.7 + turn_deg * std::numbers::pi / 180.0;
      const Motion out = straight(in.to, in.to.x_m + 20.0 * std::cos(on), in.to.y_m + 20.0 * std::sin(on));
      const std::vector<Motion> parts = round_corner(in, out, radius);
      ASSERT_EQ(parts.size(), 3U);
      Pose2 at = in.from;
      for (const Motion& part : parts) {
        EXPECT_NEAR(std::hypot(part.from.x_m - at.x_m, part.from.y_m - at.y_m), 0.0, 1e-9);
        EXPECT_NEAR(wrapped_rad(part.departure_rad() - at.yaw_rad), 0.0, 1e-9);
        at = part.at(part.length_m);
      }
      EXPECT_NEAR(std::hypot(out.to.x_m - at.x_m, out.to.y_m - at.y_m), 0.0, 1e-9)
          << turn_deg << " " << radius;
    }
  }
}

}  // namespace
}  // namespace slipway::planner
