#include "research/validation/worlds/world_execution.h"

#include <utility>

#include "core/progress.h"
#include "core/random.h"
#include "planner/problem/terrain_ground.h"
#include "research/validation/worlds/world_soils.h"

namespace slipway::validation {
namespace {

enum Stream : std::uint64_t { kHiddenClass, kSpread };

// A world with the soils that are really there in one drive.
class TrueGround final : public sim::Ground {
 public:
  TrueGround(const SeededWorld& world, std::uint64_t key)
      : world_(world), shape_(world.terrain, world.soil_map) {
    const std::uint64_t classes = random_key(key, kHiddenClass);
    for (std::size_t k = 0; k < world.patches.size(); ++k) {
      const SoilPatch& patch = world.patches[k];
      soil_of_patch_.push_back(
          patch.hidden ? static_cast<std::size_t>(random_bits(classes, k) % std::uint64_t{kWorldSoils})
                       : static_cast<std::size_t>(patch.soil_class));
    }
  }

  std::optional<sim::GroundPoint> at(double x_m, double y_m) const override { return shape_.at(x_m, y_m); }
  std::optional<std::size_t> soil_at(double x_m, double y_m) const override {
    return soil_of_patch_[world_.patch_at(x_m, y_m)];
  }

 private:
  const SeededWorld& world_;
  planner::TerrainGround shape_;
  std::vector<std::size_t> soil_of_patch_;
};

Result<std::vector<sim::DrawnOutcome>> driven(const planner::PlanProblem& problem, const sim::Ground& ground,
                                              const sim::SoilBeliefs& soils,
                                              std::span<const sim::PathStation> stations, int drives,
                                              std::uint64_t seed) {
  sim::RiskOptions risk = problem.risk;
  risk.draws = drives;
  risk.seed = seed;
  NoProgress progress;
  return sim::drawn_outcomes(*problem.rover, problem.gravity_m_s2, ground, soils, stations, problem.limits,
                             risk, problem.threads, progress, problem.conditions);
}

}  // namespace

planner::PlanProblem problem_of(const SeededWorld& world, std::shared_ptr<const sim::RoverModel> rover) {
  constexpr double kSlipCheckEvery_m = 20.0;
  planner::PlanProblem problem;
  problem.terrain = world.terrain;
  problem.soil_map = world.soil_map;
  problem.beliefs = world_beliefs();
  problem.limits.max_tilt_rad = rover->max_tilt_rad;
  problem.rover = std::move(rover);
  problem.start = {kWorldStart_m, kWorldStart_m, std::nullopt};
  problem.goal = {kWorldGoal_m, kWorldGoal_m, std::nullopt};
  problem.risk.checks.slip_check_every_m = kSlipCheckEvery_m;
  return problem;
}

Result<std::vector<sim::DrawnOutcome>> execute(const SeededWorld& world, const planner::PlanProblem& problem,
                                               const std::vector<sim::SoilDistribution>& soils,
                                               std::span<const sim::PathStation> stations, int drives,
                                               std::uint64_t seed) {
  const sim::SoilBeliefs truth{soils, {}};
  std::vector<sim::DrawnOutcome> outcomes;
  for (int k = 0; k < drives; ++k) {
    const std::uint64_t key = random_key(seed, static_cast<std::uint64_t>(k));
    const auto one = driven(problem, TrueGround(world, key), truth, stations, 1, random_key(key, kSpread));
    if (!one) return fail(one.error());
    outcomes.push_back(one->front());
  }
  return outcomes;
}

Result<std::vector<sim::DrawnOutcome>> execute_belief(const planner::PlanProblem& problem,
                                                      std::span<const sim::PathStation> stations, int drives,
                                                      std::uint64_t seed) {
  return driven(problem, planner::TerrainGround(problem.terrain, problem.soil_map), problem.beliefs, stations,
                drives, seed);
}

}  // namespace slipway::validation
