// Properties that hold whatever the ground: a search that draws random poses is compared in what it answers,
// not pose by pose.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/angle.h"
#include "tests/full_size.h"
#include "tests/planner/ground_fixture.h"

namespace slipway::planner {
namespace {

constexpr int kCells = 64;
// Two searches for the same best route end within so much of its cost of each other.
constexpr double kSameCost = 0.03;

double hills_m(double x, double y) {
  return 1.3 * std::sin(0.21 * x + 0.4) * std::sin(0.17 * y) + 0.5 * std::sin(0.11 * x - 0.23 * y);
}

// (x, y) of a changed map to (x, y) of the first.
struct Change {
  const char* name;
  double (*x)(double x, double y);
  double (*y)(double x, double y);
  // And the other way, for start and goal.
  double (*to_x)(double x, double y);
  double (*to_y)(double x, double y);
};

constexpr double kSide_m = kCells;
const Change kChanges[] = {
    {"mirrored", [](double x, double) { return kSide_m - x; }, [](double, double y) { return y; },
     [](double x, double) { return kSide_m - x; }, [](double, double y) { return y; }},
    {"turned by 90 deg", [](double, double y) { return y; }, [](double x, double) { return kSide_m - x; },
     [](double, double y) { return kSide_m - y; }, [](double x, double) { return x; }},
    {"transposed", [](double, double y) { return y; }, [](double x, double) { return x; },
     [](double, double y) { return y; }, [](double x, double) { return x; }},
};

PlanProblem from_to(PlanProblem problem, const Waypoint& start, const Waypoint& goal) {
  problem.start = start;
  problem.goal = goal;
  problem.routes = 1;
  problem.risk.draws = 16;
  return problem;
}

const Waypoint kStart{10.0, 12.0, std::nullopt}, kGoal{53.0, 47.0, std::nullopt};

void expect_same(const Plan& plan, const Plan& other, const char* name) {
  ASSERT_FALSE(plan.routes.empty()) << name;
  ASSERT_FALSE(other.routes.empty()) << name;
  EXPECT_EQ(plan.routes[0].verdict(), other.routes[0].verdict()) << name;
  EXPECT_NEAR(plan.routes[0].cost, other.routes[0].cost, kSameCost * plan.routes[0].cost) << name;
  EXPECT_NEAR(plan.routes[0].prediction.length_m, other.routes[0].prediction.length_m,
              0.1 * plan.routes[0].prediction.length_m)
      << name;
}

TEST(PlanSymmetry, MirroredTurnedAndTransposedMapsHaveTheSameVerdictAndCost) {
  const Plan plan = plan_on(from_to(problem_on(kCells, kCells, 1.0, 1.0, hills_m), kStart, kGoal));
  for (const Change& change : kChanges) {
    const auto changed = problem_on(kCells, kCells, 1.0, 1.0, [&](double x, double y) {
      return hills_m(change.x(x, y), change.y(x, y));
    });
    const auto place = [&](const Waypoint& p) {
      return Waypoint{change.to_x(p.x_m, p.y_m), change.to_y(p.x_m, p.y_m), std::nullopt};
    };
    expect_same(plan, plan_on(from_to(changed, place(kStart), place(kGoal))), change.name);
  }
}

// Of 24 such pairs all were within 3 % when this was written, the worst 2.9 %.
TEST(PlanSymmetry, OnManyGroundsTheFirstRouteCostsTheSameWithin3Percent) {
  int pairs = 0, same = 0;
  for (const int k : full_size() ? std::vector{0, 2, 4, 6} : std::vector{4}) {
    const double steep = 0.6 + 0.08 * k;
    const auto ground = [&](double x, double y) { return steep * hills_m(x + 7.0 * k, y - 5.0 * k); };
    const Plan plan = plan_on(from_to(problem_on(kCells, kCells, 1.0, 1.0, ground), kStart, kGoal));
    ASSERT_FALSE(plan.routes.empty()) << k;
    for (const Change& change : kChanges) {
      const auto place = [&](const Waypoint& p) {
        return Waypoint{change.to_x(p.x_m, p.y_m), change.to_y(p.x_m, p.y_m), std::nullopt};
      };
      const Plan other = plan_on(
          from_to(problem_on(kCells, kCells, 1.0, 1.0,
                             [&](double x, double y) { return ground(change.x(x, y), change.y(x, y)); }),
                  place(kStart), place(kGoal)));
      ASSERT_FALSE(other.routes.empty()) << k << change.name;
      ++pairs;
      const double a = plan.routes[0].cost, b = other.routes[0].cost;
      same += std::abs(a - b) <= kSameCost * std::min(a, b) ? 1 : 0;
    }
  }
  EXPECT_GE(same, pairs - 1);
}

TEST(PlanSymmetry, ATransposedMapOfCellsThatAreNotSquareHasTheSameVerdictAndCost) {
  const auto rocky = [](double x, double y) { return hills_m(x, y) + rock_m(x, y, 1.0, 0.5, 0.004); };
  const auto transposed = [&](double x, double y) { return rocky(y, x); };
  expect_same(plan_on(from_to(problem_on(2 * kCells, kCells, 1.0, 0.5, rocky), kStart, kGoal)),
              plan_on(from_to(problem_on(kCells, 2 * kCells, 0.5, 1.0, transposed),
                              {12.0, 10.0, std::nullopt}, {47.0, 53.0, std::nullopt})),
              "transposed");
}

TEST(PlanSymmetry, AMovedMapHasTheSameRouteMoved) {
  const auto problem = problem_on(kCells, kCells, 1.0, 1.0, hills_m);
  PlanProblem moved = problem;
  dem::GridGeometry g = problem.terrain->geometry();
  // By powers of two, so that no place is rounded.
  g.west_m += 4096.0;
  g.north_m -= 8192.0;
  std::vector<float> heights;
  for (int row = 0; row < kCells; ++row)
    for (int column = 0; column < kCells; ++column)
      heights.push_back(static_cast<float>(*problem.terrain->height_m(dem::Cell{row, column})));
  const std::size_t cells = heights.size();
  moved.terrain = std::make_shared<dem::Terrain>(g, std::move(heights), std::vector<std::uint8_t>(cells, 1));
  moved.soil_map = std::make_shared<dem::SoilMap>(g, std::vector<std::int16_t>(cells, 0),
                                                  std::vector<std::uint8_t>(cells, 1),
                                                  std::vector<dem::SoilClass>{{0, "a", "firm"}});
  expect_same(plan_on(from_to(problem, kStart, kGoal)),
              plan_on(from_to(moved, {kStart.x_m + 4096.0, kStart.y_m - 8192.0, std::nullopt},
                              {kGoal.x_m + 4096.0, kGoal.y_m - 8192.0, std::nullopt})),
              "moved");
}

// Over a dozen grounds from gentle to steep: wherever the straight line itself can be driven within every
// limit, there is a plan, and it is not dearer.
TEST(PlanProperty, WhereTheStraightLineIsWithinEveryLimitThereIsAPlan) {
  int drivable = 0;
  for (int k = 0; k < 12; k += full_size() ? 1 : 3) {
    const double steep = 0.5 + 0.1 * k;
    PlanProblem problem =
        from_to(problem_on(kCells, kCells, 1.0, 1.0,
                           [&](double x, double y) { return steep * hills_m(x + 7.0 * k, y - 5.0 * k); }),
                kStart, kGoal);
    NoProgress progress;
    const auto line = predict_path(problem, {problem.start, problem.goal}, progress);
    if (!line || line->immobilised || !line->broken_limits.empty()) continue;
    ++drivable;
    const Plan plan = plan_on(problem);
    ASSERT_FALSE(plan.routes.empty()) << k << ": " << plan.fewer_because.front();
    EXPECT_NE(plan.routes[0].verdict(), Verdict::kNoGo) << k;
    EXPECT_LT(plan.routes[0].prediction.duration_s, 1.5 * line->duration_s) << k;
  }
  EXPECT_GE(drivable, full_size() ? 4 : 2);
}

}  // namespace
}  // namespace slipway::planner
