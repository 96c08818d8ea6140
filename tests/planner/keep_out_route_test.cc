// Routes around keep-outs, held against a test of body and polygon that shares nothing with the planner's.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/angle.h"
#include "core/random.h"
#include "dem/synthetic_terrain.h"
#include "planner/make_plan.h"
#include "planner/problem/keep_out.h"
#include "planner/search/traverse_map.h"
#include "tests/planner/plan_fixture.h"

namespace slipway::planner {
namespace {

using Convex = std::vector<Eigen::Vector2d>;

Convex body_at(const sim::RoverModel& rover, const Pose2& pose) {
  Convex corners;
  for (const auto& [along, across] : {std::pair{0.5, 0.5}, {-0.5, 0.5}, {-0.5, -0.5}, {0.5, -0.5}}) {
    const double x = along * rover.body_length_m, y = across * rover.body_width_m;
    corners.emplace_back(pose.x_m + std::cos(pose.yaw_rad) * x - std::sin(pose.yaw_rad) * y,
                         pose.y_m + std::sin(pose.yaw_rad) * x + std::cos(pose.yaw_rad) * y);
  }
  return corners;
}

// Two convex polygons are apart where the normal of a side of either separates them.
bool apart(const Convex& a, const Convex& b) {
  for (const auto& [sides, unused] : {std::pair{&a, 0}, std::pair{&b, 0}}) {
    for (std::size_t i = 0; i < sides->size(); ++i) {
      const Eigen::Vector2d side = (*sides)[(i + 1) % sides->size()] - (*sides)[i];
      const Eigen::Vector2d normal(-side.y(), side.x());
      const auto range = [&](const Convex& polygon) {
        std::array<double, 2> ends{normal.dot(polygon.front()), normal.dot(polygon.front())};
        for (const Eigen::Vector2d& p : polygon) {
          ends[0] = std::min(ends[0], normal.dot(p));
          ends[1] = std::max(ends[1], normal.dot(p));
        }
        return ends;
      };
      const auto of_a = range(a), of_b = range(b);
      if (of_a[1] < of_b[0] || of_b[1] < of_a[0]) return true;
    }
  }
  return false;
}

Polygon square(double x_m, double y_m, double side_m) {
  const double h = 0.5 * side_m;
  return {{x_m - h, y_m - h}, {x_m + h, y_m - h}, {x_m + h, y_m + h}, {x_m - h, y_m + h}};
}

// Stations at which the body is in a keep-out, and places between two stations of a turn in place.
int places_inside(const PlanProblem& problem, const Route& route) {
  int inside = 0;
  const auto count = [&](const Pose2& pose) {
    const Convex body = body_at(*problem.rover, pose);
    for (const Polygon& polygon : problem.keep_out) inside += apart(body, polygon) ? 0 : 1;
  };
  for (const sim::StationPrediction& s : route.prediction.stations) {
    count(s.station.pose);
    if (!s.station.turning_in_place) continue;
    for (int k = 1; k < 15; ++k) {
      Pose2 between = s.station.pose;
      between.yaw_rad -= s.station.turned_rad * k / 15.0;
      count(between);
    }
  }
  return inside;
}

PlanProblem flat(double size_m, double cell_m) {
  PlanProblem problem = problem_of("S . .\n. . .\n. . G\n");
  problem.terrain = dem::make_plane({.size_m = size_m, .cell_m = cell_m}, 0.0);
  const dem::GridGeometry g = problem.terrain->geometry();
  const auto cells = static_cast<std::size_t>(g.rows) * static_cast<std::size_t>(g.columns);
  problem.soil_map = std::make_shared<dem::SoilMap>(g, std::vector<std::int16_t>(cells, 0),
                                                    std::vector<std::uint8_t>(cells, 1),
                                                    std::vector<dem::SoilClass>{{0, "a", "firm"}});
  problem.beliefs.known = {firm_soil("firm")};
  problem.risk.draws = 1;
  return problem;
}

struct Site {
  double size_m, terrain_cell_m, search_cell_m, drive_m, side_m;
};

class KeepOutRoutes : public testing::TestWithParam<Site> {};

TEST_P(KeepOutRoutes, NoStationOfAnyRouteHasTheBodyInAKeepOut) {
  const Site site = GetParam();
  PlanProblem problem = flat(site.size_m, site.terrain_cell_m);
  problem.start = {-0.5 * site.drive_m, 0.1, std::nullopt};
  problem.goal = {0.5 * site.drive_m, -0.2, std::nullopt};
  for (std::uint64_t n = 0; problem.keep_out.size() < 100; ++n) {
    const double x = site.drive_m * (random_uniform(5, 3 * n) - 0.5);
    const double y = 0.25 * site.drive_m * (random_uniform(5, 3 * n + 1) - 0.5);
    const double side = site.side_m * (0.5 + random_uniform(5, 3 * n + 2));
    if (std::hypot(std::abs(x) - 0.5 * site.drive_m, y) > 4.0 + side)
      problem.keep_out.push_back(square(x, y, side));
  }
  const KeepOut keep_out(problem.keep_out, *problem.rover);
  ASSERT_EQ(TraverseMap(problem, keep_out, search_extent(problem)).cell_m(), site.search_cell_m);
  NoProgress progress;
  const Result<Plan> plan = make_plan(problem, progress);
  ASSERT_TRUE(plan) << plan.error().detail;
  ASSERT_FALSE(plan->routes.empty()) << plan->fewer_because.at(0);
  for (const Route& route : plan->routes) EXPECT_EQ(places_inside(problem, route), 0) << route.rank;
  EXPECT_EQ(plan->routes.front().verdict(), Verdict::kGo);
}

// Above 500,000 cells a search takes larger ones: a drive of 1.6 km on cells of 1 m is searched at 4 m.
INSTANTIATE_TEST_SUITE_P(
    OnCells, KeepOutRoutes,
    testing::Values(Site{150.0, 0.25, 0.25, 60.0, 1.0}, Site{300.0, 1.0, 1.0, 200.0, 3.0},
                    Site{3000.0, 1.0, 4.0, 1600.0, 10.0}, Site{3000.0, 5.0, 5.0, 1600.0, 10.0}),
    [](const auto& row) {
      return "Of" + std::to_string(static_cast<int>(100.0 * row.param.search_cell_m)) + "Centimetres";
    });

TEST(KeepOutRoutes, ATurnInPlaceKeepsTheBodysCornersOutToo) {
  PlanProblem problem = flat(80.0, 0.5);
  problem.start = {0.0, 0.0, 0.0};
  problem.goal = {0.0, -20.0, std::nullopt};
  // The body is 2.0 m by 1.45 m: its corners reach 1.235 m, its sides 1.0 m and 0.725 m.
  problem.keep_out = {square(1.15, 0.0, 0.1), square(-1.15, 0.0, 0.1), square(0.0, 1.1, 0.2)};
  NoProgress progress;
  const Result<Plan> plan = make_plan(problem, progress);
  ASSERT_TRUE(plan) << plan.error().detail;
  for (const Route& route : plan->routes) EXPECT_EQ(places_inside(problem, route), 0);
}

}  // namespace
}  // namespace slipway::planner
