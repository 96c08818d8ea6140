#include "research/validation/worlds/world_execution.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>

#include "api/files/catalogue.h"
#include "planner/judge/route_stations.h"
#include "planner/predict_path.h"
#include "research/validation/worlds/world_planners.h"
#include "research/validation/worlds/world_soils.h"
#include "research/validation/worlds/world_study.h"

namespace slipway::validation {
namespace {

std::shared_ptr<const sim::RoverModel> rover() {
  static const auto catalogue = api::load_catalogue(SLIPWAY_DATA_FOLDER);
  return catalogue->rovers.at("mer-class");
}

std::vector<sim::PathStation> stations_of(const std::vector<planner::Waypoint>& corners) {
  return planner::route_stations(planner::path_motions(corners), sim::max_station_spacing_m(*rover()));
}

// A way with a bend; the same with x and y exchanged.
const std::vector<planner::Waypoint> kWay{{8.0, 8.0, {}}, {20.0, 40.0, {}}, {60.0, 48.0, {}}};
const std::vector<planner::Waypoint> kMirrored{{8.0, 8.0, {}}, {40.0, 20.0, {}}, {48.0, 60.0, {}}};

std::vector<sim::DrawnOutcome> executed(const SeededWorld& world,
                                        const std::vector<sim::SoilDistribution>& soils,
                                        const std::vector<planner::Waypoint>& way, int drives,
                                        std::uint64_t seed = 3) {
  const auto outcomes = execute(world, problem_of(world, rover()), soils, stations_of(way), drives, seed);
  EXPECT_TRUE(outcomes) << outcomes.error().detail;
  return outcomes.value_or(std::vector<sim::DrawnOutcome>{});
}

// Without spread and without hidden ground there is but one ground, that of the prediction.
TEST(WorldExecution, WithoutSpreadItIsThePrediction) {
  const SeededWorld world =
      make_world({.seed = 2, .rms_height_m = 0.1, .max_craters = 0, .hidden_share = 0.0});
  planner::PlanProblem problem = problem_of(world, rover());
  for (int k = 0; k < kWorldSoils; ++k)
    problem.beliefs.known[static_cast<std::size_t>(k)] = soil_of_class(k, 0.0);
  problem.risk.draws = 0;
  NoProgress progress;
  const auto drive = planner::predict_path(problem, kWay, progress);
  ASSERT_TRUE(drive);
  ASSERT_FALSE(drive->immobilised);
  for (const sim::DrawnOutcome& each : executed(world, problem.beliefs.known, kWay, 3)) {
    EXPECT_NEAR(each.driven_m, drive->length_m, 1e-9);
    EXPECT_NEAR(each.mean_slip_ratio(), drive->mean_slip_ratio, 1e-5);
    EXPECT_NEAR(each.duration_s, drive->duration_s, 1e-4 * drive->duration_s);
  }
}

// With all of the spread shared by the whole ground of a class a draw does not know places, and hidden
// patches are drawn by their number.
TEST(WorldExecution, AMirroredWorldHasTheMirroredExecution) {
  const SeededWorld world = make_world({.seed = 9});
  std::vector<sim::SoilDistribution> soils = world_beliefs().known;
  for (sim::SoilDistribution& soil : soils) soil.shares = {1.0, 0.0, 0.0};
  const auto drives = executed(world, soils, kWay, 6),
             others = executed(mirrored(world), soils, kMirrored, 6);
  ASSERT_EQ(drives.size(), others.size());
  for (std::size_t k = 0; k < drives.size(); ++k) {
    EXPECT_EQ(drives[k].stops, others[k].stops);
    EXPECT_EQ(drives[k].embedded, others[k].embedded);
    EXPECT_NEAR(drives[k].driven_m, others[k].driven_m, 0.3);
    EXPECT_NEAR(drives[k].mean_slip_ratio(), others[k].mean_slip_ratio(), 2e-3);
  }
  // The drives differ from each other by more than that.
  EXPECT_GT(std::abs(drives[0].mean_slip_ratio() - drives[1].mean_slip_ratio()), 2e-3);
}

TEST(WorldExecution, HiddenPatchesAreOtherSoilsFromDriveToDriveAndVisibleOnesAreNot) {
  std::vector<sim::SoilDistribution> soils;
  for (int k = 0; k < kWorldSoils; ++k) soils.push_back(soil_of_class(k, 0.0));
  const auto distinct = [&](double hidden) {
    std::set<double> slips;
    for (const sim::DrawnOutcome& each :
         executed(make_world({.seed = 2, .rms_height_m = 0.1, .max_craters = 0, .hidden_share = hidden}),
                  soils, kWay, 5))
      slips.insert(each.mean_slip_ratio());
    return slips.size();
  };
  EXPECT_EQ(distinct(0.0), 1U);
  EXPECT_EQ(distinct(1.0), 5U);
}

TEST(WorldPlanners, TheShortestKnowsNothingOfSoils) {
  const SeededWorld world = make_world({.seed = 1});
  planner::PlanProblem problem = problem_of(world, rover());
  ASSERT_EQ(world_planners()[0].name, "shortest");
  world_planners()[0].set(problem);
  EXPECT_TRUE(problem.beliefs.unknown.alternatives.empty());
  for (const sim::SoilDistribution& belief : problem.beliefs.known)
    EXPECT_EQ(belief.mean.friction_angle_rad, problem.beliefs.unknown.mean.friction_angle_rad);
  EXPECT_EQ(problem.weights.of("duration"), 1.0);
  for (const char* const term : {"energy", "slip", "unknown", "risk"})
    EXPECT_EQ(problem.weights.of(term), 0.0);
}

TEST(WorldStudy, ScoresDoNotDependOnThreadsAndComeBackFromTheirFile) {
  WorldStudyOptions options{.seed = 11,
                            .worlds = 2,
                            .drives = 3,
                            .planning_draws = 4,
                            .prediction_draws = 8,
                            .routes = 1,
                            .threads = 1};
  const auto quiet = [](int) {};
  const auto one = study_worlds(options, rover(), quiet, NoProgress());
  options.threads = 2;
  options.worlds = 1;  // the first of them
  const auto two = study_worlds(options, rover(), quiet, NoProgress());
  ASSERT_TRUE(one && two);
  EXPECT_TRUE(csv_of(*one).starts_with(csv_of(*two)));
  EXPECT_LT(two->size(), one->size());
  ASSERT_EQ(one->size() % 3, 0U);
  EXPECT_NE(one->front().length_m, one->back().length_m) << "two seeds gave one world";
  for (const WorldScore& score : *one) {
    EXPECT_EQ(score.drives, 3);
    EXPECT_GT(score.length_m, 113.0);
    EXPECT_LE(score.slip_p05, score.slip_p95);
  }
  const auto file = std::filesystem::temp_directory_path() / "slipway_world_scores_test.csv";
  std::ofstream(file) << csv_of(*one);
  const auto read = read_world_scores(file);
  std::filesystem::remove(file);
  ASSERT_TRUE(read);
  EXPECT_EQ(csv_of(*read), csv_of(*one));
}

}  // namespace
}  // namespace slipway::validation
