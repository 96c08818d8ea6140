#include "planner/maps/cell_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <string_view>

#include "core/angle.h"
#include "planner/judge/drive_verdict.h"
#include "planner/maps/cell_ground.h"
#include "planner/maps/way_map.h"
#include "planner/predict_path.h"
#include "planner/search/traverse_map.h"
#include "tests/planner/ground_fixture.h"

namespace slipway::planner {
namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

struct Asked {
  MapKind kind = MapKind::kSlipWorst;
  std::optional<double> heading_rad = {};
  bool price_unknown = false;
  double distance_m = 10.0;
};

std::vector<float> map_of(const PlanProblem& problem, const Asked& asked) {
  const CellMap map({.drive = problem,
                     .kind = asked.kind,
                     .heading_rad = asked.heading_rad,
                     .distance_m = asked.distance_m,
                     .price_unknown = asked.price_unknown});
  const dem::GridGeometry& g = problem.terrain->geometry();
  return map.values(*problem.terrain, *problem.soil_map, {0, 0, g.rows, g.columns}, g.extent());
}

float at(const std::vector<float>& values, const PlanProblem& problem, double x_m, double y_m) {
  const dem::GridGeometry& g = problem.terrain->geometry();
  const dem::Cell cell = *g.cell_at(x_m, y_m);
  return values[static_cast<std::size_t>(cell.row) * static_cast<std::size_t>(g.columns) +
                static_cast<std::size_t>(cell.column)];
}

PlanProblem hills(bool mirrored) {
  return problem_on(60, 60, 1.0, 1.0, [=](double x, double y) {
    const double u = mirrored ? 60.0 - x : x;
    if (u > 40.0 && u < 42.0 && y > 20.0 && y < 22.0) return kNothing;
    return 2.5 * std::sin(u / 9.0) * std::cos(y / 7.0) + 0.12 * u;
  });
}

TEST(CellMap, SlipIsWhatAPredictionSaysOnThatSlope) {
  for (const double slope_deg : {4.0, 9.0, 14.0}) {
    const double rise = std::tan(rad_from_deg(slope_deg));
    PlanProblem problem = problem_on(40, 40, 1.0, 1.0, [=](double x, double) { return rise * x; });
    NoProgress progress;
    const auto uphill =
        predict_path(problem, {{12.0, 20.0, std::nullopt}, {28.0, 20.0, std::nullopt}}, progress);
    const auto downhill =
        predict_path(problem, {{28.0, 20.0, std::nullopt}, {12.0, 20.0, std::nullopt}}, progress);
    ASSERT_TRUE(uphill && downhill);
    const auto slip = [&](const Asked& asked) { return at(map_of(problem, asked), problem, 20.0, 20.0); };
    EXPECT_NEAR(slip({.kind = MapKind::kSlip, .heading_rad = 0.0}), uphill->mean_slip_ratio, 0.01);
    // Downhill the wheels turn slower than the ground passes; a drive's mean is of the size.
    EXPECT_NEAR(std::abs(slip({.kind = MapKind::kSlip, .heading_rad = std::numbers::pi})),
                downhill->mean_slip_ratio, 0.01);
    EXPECT_GE(slip({.kind = MapKind::kSlipWorst}) + 0.002,
              std::max(std::abs(uphill->mean_slip_ratio), std::abs(downhill->mean_slip_ratio)));
    EXPECT_LE(slip({.kind = MapKind::kSlipBest}), std::abs(uphill->mean_slip_ratio) + 0.002);
  }
}

TEST(CellMap, OfMirroredGroundIsTheMirroredMap) {
  const PlanProblem there = hills(false), mirrored = hills(true);
  for (const MapKind kind :
       {MapKind::kSlipWorst, MapKind::kSlipBest, MapKind::kStopRisk, MapKind::kVerdict}) {
    const std::vector<float> a = map_of(there, {.kind = kind}), b = map_of(mirrored, {.kind = kind});
    for (std::size_t r = 0; r < 60; ++r)
      for (std::size_t c = 0; c < 60; ++c)
        ASSERT_NEAR(a[r * 60 + c], b[r * 60 + 59 - c], 2e-3)
            << row_of(kind).name << " row " << r << " column " << c;
  }
}

TEST(CellMap, GroundIsThePlaneThatTheSearchTakes) {
  const PlanProblem problem = hills(false);
  const KeepOut none({}, *problem.rover);
  const TraverseMap search(problem, none, problem.terrain->geometry().extent());
  const dem::GridGeometry& g = problem.terrain->geometry();
  const CellGround ground =
      cell_ground(*problem.terrain, {0, 0, g.rows, g.columns}, g.extent(), *problem.rover, true);
  ASSERT_EQ(search.cells(), ground.gradient_x.size());
  int known = 0;
  for (std::size_t i = 0; i < search.cells(); ++i) {
    ASSERT_EQ(search.cell(i).passage == Passage::kNoData, std::isnan(ground.gradient_x[i])) << i;
    if (std::isnan(ground.gradient_x[i])) continue;
    ++known;
    EXPECT_NEAR(search.cell(i).gradient_x, ground.gradient_x[i], 1e-4);
    EXPECT_NEAR(search.cell(i).gradient_y, ground.gradient_y[i], 1e-4);
    EXPECT_NEAR(search.cell(i).rise_m, std::max(0.0F, ground.rise_m[i]), 1e-4);
  }
  EXPECT_GT(known, 2000);
}

TEST(CellMap, UnknownGroundNeverLooksSafe) {
  PlanProblem problem =
      problem_on(40, 40, 1.0, 1.0, [](double x, double) { return x > 30.0 ? kNothing : 0.0; });
  const dem::GridGeometry& g = problem.terrain->geometry();
  std::vector<std::uint8_t> known;
  for (int row = 0; row < g.rows; ++row)
    for (int column = 0; column < g.columns; ++column) known.push_back(column < 15 ? 1 : 0);
  problem.soil_map = std::make_shared<dem::SoilMap>(g, std::vector<std::int16_t>(known.size(), 0), known,
                                                    std::vector<dem::SoilClass>{{0, "a", "firm"}});
  for (const MapKind kind :
       {MapKind::kSlipBest, MapKind::kSlipWorst, MapKind::kStopRisk, MapKind::kEmbeddingRisk}) {
    const std::vector<float> values = map_of(problem, {.kind = kind});
    EXPECT_NE(at(values, problem, 8.0, 20.0), kNoMapValue);
    EXPECT_EQ(at(values, problem, 22.0, 20.0), kNoMapValue);
    EXPECT_EQ(at(values, problem, 35.0, 20.0), kNoMapValue);
    EXPECT_EQ(at(values, problem, 30.0, 20.0), kNoMapValue);  // the body would reach over the missing cells
  }
  const std::vector<float> priced = map_of(problem, {.kind = MapKind::kStopRisk, .price_unknown = true});
  EXPECT_GE(at(priced, problem, 22.0, 20.0), 0.001F);
  const std::vector<float> verdict = map_of(problem, {.kind = MapKind::kVerdict});
  EXPECT_EQ(at(verdict, problem, 8.0, 20.0), map_class::kGo);
  EXPECT_EQ(at(verdict, problem, 35.0, 20.0), map_class::kNoElevation);
  // Of unmapped ground it says what a check does.
  NoProgress progress;
  const auto drive =
      predict_path(problem, {{22.0, 15.0, std::nullopt}, {22.0, 25.0, std::nullopt}}, progress);
  ASSERT_TRUE(drive);
  EXPECT_EQ(at(verdict, problem, 22.0, 20.0) == static_cast<float>(map_class::kGo),
            judge_drive(problem, *drive).verdict == Verdict::kGo);
  const std::vector<float> unknown = map_of(problem, {.kind = MapKind::kUnknown});
  EXPECT_EQ(at(unknown, problem, 8.0, 20.0), map_class::kKnownGround);
  EXPECT_EQ(at(unknown, problem, 22.0, 20.0), map_class::kUnknownGround);
  EXPECT_EQ(at(unknown, problem, 35.0, 20.0), map_class::kWithoutElevation);
}

TEST(CellMap, RiskRisesWithSlopeDistanceAndStepsAreNoGo) {
  const auto risk = [](double slope_deg, double distance_m) {
    const double rise = std::tan(rad_from_deg(slope_deg));
    const PlanProblem problem = problem_on(20, 20, 1.0, 1.0, [=](double x, double) { return rise * x; });
    return at(map_of(problem, {.kind = MapKind::kStopRisk, .distance_m = distance_m}), problem, 10.0, 10.0);
  };
  EXPECT_LT(risk(5.0, 10.0), risk(20.0, 10.0));
  EXPECT_LT(risk(18.0, 5.0), risk(18.0, 200.0));
  EXPECT_EQ(risk(27.0, 10.0), 1.0F);  // beyond the tilt limit of 25 deg
  const PlanProblem step =
      problem_on(20, 20, 1.0, 1.0, [](double x, double) { return x > 10.0 && x < 11.0 ? 0.9 : 0.0; });
  EXPECT_EQ(at(map_of(step, {.kind = MapKind::kVerdict}), step, 10.5, 10.0), map_class::kNoGo);
}

TEST(WayMap, ReachesFartherWithMoreOfTheBudget) {
  const PlanProblem problem = hills(false);
  NoProgress progress;
  const Waypoint from{20.0, 30.0, std::nullopt};
  const auto reached = [&](const WayBudget& budget) {
    const auto map = reachable_map(problem, from, budget, "/from", progress);
    EXPECT_TRUE(map) << (map ? "" : map.error().detail);
    return std::count(map->values.begin(), map->values.end(), static_cast<float>(map_class::kReachable));
  };
  const auto little = reached({.energy_j = 2'000.0}), more = reached({.energy_j = 8'000.0});
  EXPECT_GT(little, 1);
  EXPECT_GT(more, little);
  EXPECT_LE(reached({.energy_j = 8'000.0, .sols = 0.02}), more);
  const auto away = reachable_map(problem, {41.0, 21.0, std::nullopt}, {.energy_j = 1.0}, "/from", progress);
  ASSERT_FALSE(away);  // missing elevation
  EXPECT_EQ(away.error().faults.front().pointer, "/from");
}

TEST(WayMap, CostToGoIsNothingAtThePlaceAndGrowsAwayFromIt) {
  const PlanProblem problem = hills(false);
  NoProgress progress;
  const auto map = cost_to_go_map(problem, {20.5, 30.5, std::nullopt}, "/to", progress);
  ASSERT_TRUE(map);
  EXPECT_EQ(at(map->values, problem, 20.5, 30.5), 0.0F);
  EXPECT_GT(at(map->values, problem, 30.5, 30.5), at(map->values, problem, 25.5, 30.5));
  EXPECT_EQ(at(map->values, problem, 41.0, 21.0), kNoMapValue);
}

// Above what a plan's window may have, and still in the terrain's own cells.
TEST(WayMap, OfALargeTerrainIsThatOfASmallOneWhereBothReach) {
  const auto waves = [](double x, double y) { return 1.5 * std::sin(x / 15.0) * std::cos(y / 11.0); };
  const PlanProblem large = problem_on(760, 760, 1.0, 1.0, waves),
                    small = problem_on(300, 300, 1.0, 1.0, waves);
  ASSERT_FALSE(in_finest_cells(large.terrain->geometry(), large.terrain->geometry().extent()));
  NoProgress progress;
  const Waypoint place{150.5, 150.5, std::nullopt};
  const auto of_large = cost_to_go_map(large, place, "/to", progress);
  const auto of_small = cost_to_go_map(small, place, "/to", progress);
  ASSERT_TRUE(of_large && of_small);
  EXPECT_EQ(of_large->geometry, large.terrain->geometry());
  for (const double x : {110.5, 150.5, 181.5})
    for (const double y : {120.5, 149.5, 190.5}) {
      const float cost = at(of_small->values, small, x, y);
      EXPECT_NEAR(at(of_large->values, large, x, y), cost, 1e-4F * cost);
    }
  const auto reached = reachable_map(large, place, {.energy_j = 8'000.0}, "/from", progress);
  const auto reached_of_small = reachable_map(small, place, {.energy_j = 8'000.0}, "/from", progress);
  ASSERT_TRUE(reached && reached_of_small);
  const auto count = [](const WayMap& map) {
    return std::count(map.values.begin(), map.values.end(), static_cast<float>(map_class::kReachable));
  };
  EXPECT_GT(count(*reached_of_small), 100);
  EXPECT_NEAR(static_cast<double>(count(*reached)), static_cast<double>(count(*reached_of_small)), 3.0);
}

// Given up when a stage begins.
class GivesUpAt final : public Progress {
 public:
  explicit GivesUpAt(std::string_view stage) : stage_(stage) {}
  void report(std::string_view stage, double /*fraction*/) override {
    given_up_ = given_up_ || stage == stage_;
  }
  bool cancelled() const override { return given_up_; }

 private:
  std::string stage_;
  std::atomic<bool> given_up_{false};
};

TEST(WayMap, IsGivenUpInAnyStage) {
  const PlanProblem problem = problem_on(760, 760, 1.0, 1.0, [](double x, double) { return 0.02 * x; });
  const Waypoint place{150.5, 150.5, std::nullopt};
  for (const char* const stage : {"reading the ground", "searching ways", "adding up ways"}) {
    GivesUpAt progress(stage);
    const auto map = reachable_map(problem, place, {.energy_j = 8'000.0}, "/from", progress);
    ASSERT_FALSE(map) << stage;
    EXPECT_EQ(map.error().code, ErrorCode::kCancelled) << stage;
  }
}

}  // namespace
}  // namespace slipway::planner
