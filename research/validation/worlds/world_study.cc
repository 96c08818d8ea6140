#include "research/validation/worlds/world_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <mutex>
#include <optional>

#include "core/parallel_for.h"
#include "core/random.h"
#include "planner/judge/drive_verdict.h"
#include "planner/make_plan.h"
#include "planner/problem/terrain_ground.h"
#include "research/validation/report/csv_table.h"
#include "research/validation/worlds/seeded_world.h"
#include "research/validation/worlds/world_execution.h"
#include "research/validation/worlds/world_planners.h"
#include "research/validation/worlds/world_soils.h"

namespace slipway::validation {
namespace {

// Streams of a world's random numbers besides those of the world itself.
enum Stream : std::uint64_t { kPlanning = 100, kExecution, kOtherSoils };

class Unreported final : public Progress {
 public:
  explicit Unreported(const Progress& outer) : outer_(outer) {}
  void report(std::string_view /*stage*/, double /*fraction*/) override {}
  bool cancelled() const override { return outer_.cancelled(); }

 private:
  const Progress& outer_;
};

// One world of the study.
class WorldTrial {
 public:
  WorldTrial(const WorldStudyOptions& options, std::uint64_t seed,
             const std::shared_ptr<const sim::RoverModel>& rover, const Progress& progress)
      : options_(options),
        seed_(seed),
        world_(make_world({.seed = seed})),
        given_(problem_of(world_, rover)),
        progress_(progress) {
    given_.routes = options.routes;
    given_.risk.draws = options.planning_draws;
    given_.risk.seed = random_key(seed, kPlanning);
    given_.threads = 1;
  }

  Result<std::vector<WorldScore>> run() {
    for (const WorldPlanner& planner : world_planners())
      if (const auto tried = add(planner); !tried) return fail(tried.error());
    return std::move(scores_);
  }

 private:
  Result<void> add(const WorldPlanner& planner) {
    planner::PlanProblem problem = given_;
    planner.set(problem);
    const auto plan = planner::make_plan(problem, progress_);
    if (!plan) return fail(plan.error());
    WorldScore score;
    score.world = seed_;
    score.planner = planner.name;
    const auto before = scores_.size();
    for (const planner::Route& route : plan->routes) {
      // Its stations end where the rover is immobilised on the soils that it was planned with.
      if (route.prediction.immobilised) continue;
      score.route = route.rank;
      if (auto scored = add_route(score, route); !scored) return scored;
    }
    if (scores_.size() == before) {
      score.truth = kTruths[0];
      score.decision = planner::describe(planner::Verdict::kNoGo);
      scores_.push_back(score);
    }
    return {};
  }

  Result<void> add_route(WorldScore score, const planner::Route& route) {
    std::vector<sim::PathStation> stations;
    for (const sim::StationPrediction& station : route.prediction.stations)
      stations.push_back(station.station);
    sim::RiskOptions risk = given_.risk;
    risk.draws = options_.prediction_draws;
    const auto drive = sim::predict_drive(
        *given_.rover, given_.gravity_m_s2, planner::TerrainGround(given_.terrain, given_.soil_map),
        given_.beliefs, stations, given_.limits, risk, given_.threads, progress_, given_.conditions);
    if (!drive) return fail(drive.error());
    score.decision = planner::describe(planner::judge_drive(given_, *drive).verdict);
    score.length_m = stations.back().distance_m;
    score.duration_s = drive->duration_s;
    score.stop = drive->outcomes.stop.share;
    score.embedding = drive->outcomes.embedding.share;
    score.expected_stops = drive->outcomes.expected_stops;
    score.slip_p05 = drive->mean_slip_ratio_p05;
    score.slip_p95 = drive->mean_slip_ratio_p95;
    for (const char* const truth : kTruths) {
      const auto drives = executed(truth, stations);
      if (!drives) return fail(drives.error());
      WorldScore row = score;
      row.truth = truth;
      count(*drives, row);
      scores_.push_back(row);
    }
    return {};
  }

  Result<std::vector<sim::DrawnOutcome>> executed(std::string_view truth,
                                                  const std::vector<sim::PathStation>& stations) const {
    const std::uint64_t key = random_key(seed_, kExecution);
    if (progress_.cancelled()) return fail(ErrorCode::kCancelled, "the study was given up");
    if (truth == "belief") return execute_belief(given_, stations, options_.drives, key);
    const sim::SoilBeliefs soils =
        truth == "other" ? other_soils(random_key(seed_, kOtherSoils)) : world_beliefs();
    return execute(world_, given_, soils.known, stations, options_.drives, key);
  }

  static void count(const std::vector<sim::DrawnOutcome>& drives, WorldScore& row) {
    row.drives = static_cast<int>(drives.size());
    for (const sim::DrawnOutcome& drive : drives) {
      row.completed += drive.stops == 0 && !drive.embedded ? 1 : 0;
      row.stopped += drive.stops > 0 ? 1 : 0;
      row.embedded += drive.embedded ? 1 : 0;
      row.stops += drive.stops;
      const double slip = drive.mean_slip_ratio();
      row.below += slip < row.slip_p05 ? 1 : 0;
      row.within += slip >= row.slip_p05 && slip <= row.slip_p95 ? 1 : 0;
      row.mean_slip += slip / row.drives;
      row.mean_duration_s += drive.duration_s / row.drives;
    }
  }

  const WorldStudyOptions& options_;
  std::uint64_t seed_;
  SeededWorld world_;
  planner::PlanProblem given_;
  mutable Unreported progress_;
  std::vector<WorldScore> scores_;
};

// A column of the scores: a whole number or a real one.
struct NumberColumn {
  const char* name;
  double WorldScore::*real;
  int WorldScore::*whole;
};
constexpr NumberColumn kNumbers[] = {
    {"length_m", &WorldScore::length_m, nullptr},
    {"duration_s", &WorldScore::duration_s, nullptr},
    {"stop", &WorldScore::stop, nullptr},
    {"embedding", &WorldScore::embedding, nullptr},
    {"expected_stops", &WorldScore::expected_stops, nullptr},
    {"slip_p05", &WorldScore::slip_p05, nullptr},
    {"slip_p95", &WorldScore::slip_p95, nullptr},
    {"drives", nullptr, &WorldScore::drives},
    {"completed", nullptr, &WorldScore::completed},
    {"stopped", nullptr, &WorldScore::stopped},
    {"embedded", nullptr, &WorldScore::embedded},
    {"stops", nullptr, &WorldScore::stops},
    {"within", nullptr, &WorldScore::within},
    {"below", nullptr, &WorldScore::below},
    {"mean_slip", &WorldScore::mean_slip, nullptr},
    {"mean_duration_s", &WorldScore::mean_duration_s, nullptr},
};

}  // namespace

Result<std::vector<WorldScore>> study_worlds(const WorldStudyOptions& options,
                                             const std::shared_ptr<const sim::RoverModel>& rover,
                                             const std::function<void(int done)>& tell,
                                             const Progress& progress) {
  std::vector<std::optional<Result<std::vector<WorldScore>>>> worlds(
      static_cast<std::size_t>(options.worlds));
  std::mutex telling;
  int done = 0;
  parallel_for(worlds.size(), options.threads, [&](std::size_t k) {
    worlds[k] = WorldTrial(options, options.seed + k, rover, progress).run();
    const std::lock_guard lock(telling);
    tell(++done);
  });
  std::vector<WorldScore> all;
  for (const auto& scores : worlds) {
    if (!*scores) return fail(scores->error());
    all.insert(all.end(), (*scores)->begin(), (*scores)->end());
  }
  return all;
}

std::string csv_of(const std::vector<WorldScore>& scores) {
  std::string text = "world,planner,route,truth,decision";
  for (const NumberColumn& column : kNumbers) text += fmt::format(",{}", column.name);
  text += "\n";
  for (const WorldScore& s : scores) {
    text += fmt::format("{},{},{},{},{}", s.world, s.planner, s.route, s.truth, s.decision);
    for (const NumberColumn& column : kNumbers)
      text +=
          column.whole != nullptr ? fmt::format(",{}", s.*column.whole) : fmt::format(",{}", s.*column.real);
    text += "\n";
  }
  return text;
}

Result<std::vector<WorldScore>> read_world_scores(const std::filesystem::path& csv) {
  CsvTable::Columns columns{
      .numbers = {"world", "route"}, .numbers_or_empty = {}, .texts = {"planner", "truth", "decision"}};
  for (const NumberColumn& column : kNumbers) columns.numbers.emplace_back(column.name);
  const auto table = CsvTable::read(csv, columns);
  if (!table) return fail(table.error());
  std::vector<WorldScore> scores;
  for (std::size_t row = 0; row < table->rows(); ++row) {
    WorldScore s;
    s.world = static_cast<std::uint64_t>(table->number(row, "world"));
    s.planner = table->text(row, "planner");
    s.route = static_cast<int>(table->number(row, "route"));
    s.truth = table->text(row, "truth");
    s.decision = table->text(row, "decision");
    for (const NumberColumn& column : kNumbers) {
      if (column.whole != nullptr)
        s.*column.whole = static_cast<int>(table->number(row, column.name));
      else
        s.*column.real = table->number(row, column.name);
    }
    scores.push_back(std::move(s));
  }
  return scores;
}

}  // namespace slipway::validation
