#include "planner/search/ground_tables.h"

#include <algorithm>

#include "core/parallel_for.h"
#include "planner/search/slip_table_cache.h"
#include "sim/prediction/likely_soils.h"

namespace slipway::planner {
namespace {

// At a limit of 25 deg these columns are 3.1 deg of roll apart; cubic between them, the table's error of slip
// stays mostly below a hundredth up to the traction limit (measured in docs/validation.md, with columns 2.5
// deg apart).
constexpr double kNodesToLimit = 8.0;

// Soils that a kind of ground may have: enough for a mean over ten alternatives, and for one over a tail of
// 10 %. Their tables have columns twice as far apart.
constexpr std::size_t kLikelySoils = 20, kLikelySoilsOfTail = 40;
constexpr double kLikelyNodesToLimit = 4.0;

// The soils that lie anywhere on the map: a legend may name many more, and a table costs hundreds of
// balances.
std::vector<bool> soils_in_use(const PlanProblem& problem, const Progress& progress) {
  std::vector<bool> used(problem.beliefs.known.size(), false);
  if (!problem.soil_map) return used;
  const dem::GridGeometry& g = problem.soil_map->geometry();
  std::size_t missing = used.size();
  for (int row = 0; row < g.rows && missing > 0 && !progress.cancelled(); ++row) {
    for (int column = 0; column < g.columns; ++column) {
      const Eigen::Vector2d centre = g.centre_m({row, column});
      const std::optional<std::size_t> soil = problem.soil_map->soil_at(centre.x(), centre.y());
      if (!soil || used.at(*soil)) continue;
      used[*soil] = true;
      --missing;
    }
  }
  return used;
}

// Kept between the plans of a process.
sim::SlipTable table_of(const PlanProblem& problem, const sim::Soil& soil, double limit_rad,
                        double step_rad) {
  const SlipTableKey key{.rover = *problem.rover,
                         .gravity_m_s2 = problem.gravity_m_s2,
                         .soil = soil,
                         .limit_rad = limit_rad,
                         .step_rad = step_rad,
                         .conditions = problem.conditions};
  static SlipTableCache cache;
  return cache.get(key);
}

// The tables of the soils that each kind of ground in use may have, see GroundTable; parallel over all of
// them.
std::vector<std::vector<LikelyTable>> likely_tables(const PlanProblem& problem,
                                                    const std::vector<const sim::SoilDistribution*>& beliefs,
                                                    const std::vector<bool>& used, double limit_rad,
                                                    const Progress& progress) {
  struct Job {
    std::size_t kind = 0;
    sim::LikelySoil soil;
  };
  const bool by_tail = problem.ranking.by == RankBy::kCvar;
  const sim::LevelGroundTest drives_level(*problem.rover, problem.gravity_m_s2);
  std::vector<Job> jobs;
  for (std::size_t kind = 0; kind < beliefs.size(); ++kind) {
    if (!used[kind] || (!by_tail && beliefs[kind]->alternatives.empty())) continue;
    for (sim::LikelySoil& soil :
         sim::likely_soils(*beliefs[kind], by_tail ? kLikelySoilsOfTail : kLikelySoils, drives_level))
      jobs.push_back({kind, std::move(soil)});
  }
  std::vector<std::optional<sim::SlipTable>> tables(jobs.size());
  parallel_for(jobs.size(), problem.threads, [&](std::size_t i) {
    if (progress.cancelled()) return;
    tables[i].emplace(table_of(problem, jobs[i].soil.soil, limit_rad, limit_rad / kLikelyNodesToLimit));
  });
  std::vector<std::vector<LikelyTable>> likely(beliefs.size());
  if (progress.cancelled()) return likely;
  for (std::size_t i = 0; i < jobs.size(); ++i)
    likely[jobs[i].kind].push_back({std::move(*tables[i]), jobs[i].soil.weight});
  return likely;
}

}  // namespace

sim::Soil weak_soil(const sim::SoilDistribution& belief) {
  return sim::draw_soil(belief, sim::towards_weakness());
}

GroundTables build_ground_tables(const PlanProblem& problem, const Progress& progress) {
  const std::size_t kinds = problem.beliefs.known.size() + 1;
  const double limit = problem.max_tilt_rad();
  std::vector<std::optional<sim::SlipTable>> tables(2 * kinds);
  std::vector<const sim::SoilDistribution*> beliefs;
  for (const sim::SoilDistribution& known : problem.beliefs.known) beliefs.push_back(&known);
  beliefs.push_back(&problem.beliefs.unknown);
  std::vector<bool> used = soils_in_use(problem, progress);
  used.push_back(true);  // unknown ground
  parallel_for(tables.size(), problem.threads, [&](std::size_t i) {
    if (!used[i / 2] || progress.cancelled()) return;
    const sim::SoilDistribution& of = *beliefs[i / 2];
    const sim::Soil soil = i % 2 == 0 ? of.mean : weak_soil(of);
    tables[i].emplace(table_of(problem, soil, limit, limit / kNodesToLimit));
  });
  std::vector<std::vector<LikelyTable>> likely = likely_tables(problem, beliefs, used, limit, progress);
  GroundTables all;
  if (progress.cancelled()) return all;
  for (std::size_t kind = 0; kind < kinds; ++kind) {
    if (!used[kind]) {
      all.known.emplace_back();
      continue;
    }
    GroundTable table{std::move(*tables[2 * kind]), std::move(*tables[2 * kind + 1]),
                      beliefs[kind]->correlation_length_m, std::move(likely[kind])};
    if (kind + 1 < kinds) {
      all.known.emplace_back(std::move(table));
    } else {
      all.unknown.emplace(std::move(table));
    }
  }
  return all;
}

}  // namespace slipway::planner
