#include "api/ground_evidence.h"

#include <cmath>

#include "planner/predict_path.h"

namespace slipway::api {
namespace {

// The longest run of corners that lie on the terrain with room for the rover around them.
std::vector<planner::Waypoint> on_the_map(const planner::PlanProblem& problem,
                                          const std::vector<planner::Waypoint>& path) {
  const double reach = 2.0 * problem.rover->body_width_m;
  std::vector<planner::Waypoint> longest, run;
  for (const planner::Waypoint& corner : path) {
    bool inside = true;
    for (const double dx : {-reach, 0.0, reach})
      for (const double dy : {-reach, 0.0, reach})
        inside = inside && problem.terrain->height_m(corner.x_m + dx, corner.y_m + dy).has_value();
    if (inside) run.push_back(corner);
    if (!inside || &corner == &path.back()) {
      if (run.size() > longest.size()) longest = run;
      run.clear();
    }
  }
  return longest;
}

bool counts(const PastDrive& drive, int as_of_sol) {
  return drive.sol < as_of_sol && drive.outcome != PastOutcome::kNoReport;
}

}  // namespace

double effective_draws(const std::vector<sim::ConditionedDraw>& draws, double power) {
  double sum = 0.0, squares = 0.0;
  for (const sim::ConditionedDraw& draw : draws) {
    sum += std::pow(draw.weight, power);
    squares += std::pow(draw.weight, 2.0 * power);
  }
  return sum * sum / squares;
}

void flatten(std::vector<sim::ConditionedDraw>& draws) {
  const double wanted = kMinEffective * static_cast<double>(draws.size());
  double low = 0.0, high = 1.0;
  double power = 1.0;
  if (effective_draws(draws, 1.0) < wanted) {
    constexpr int kHalvings = 40;
    for (int k = 0; k < kHalvings; ++k) {
      power = 0.5 * (low + high);
      (effective_draws(draws, power) < wanted ? high : low) = power;
    }
    power = low;
  }
  double sum = 0.0;
  for (sim::ConditionedDraw& draw : draws) sum += draw.weight = std::pow(draw.weight, power);
  for (sim::ConditionedDraw& draw : draws) draw.weight *= static_cast<double>(draws.size()) / sum;
}

std::vector<planner::Waypoint> places_of(const DriveOutcomeTable& table, int as_of_sol) {
  std::vector<planner::Waypoint> places;
  for (const PastDrive& drive : table.drives)
    if (counts(drive, as_of_sol)) places.insert(places.end(), drive.path.begin(), drive.path.end());
  return places;
}

Result<void> condition_draws(const planner::PlanProblem& problem, const DriveOutcomeTable& table,
                             int as_of_sol, Progress& progress, ConditionedGround& ground) {
  ground.draws.resize(static_cast<std::size_t>(problem.risk.draws));
  for (; ground.rows < table.drives.size() && table.drives[ground.rows].sol < as_of_sol; ++ground.rows) {
    const PastDrive& drive = table.drives[ground.rows];
    if (!counts(drive, as_of_sol)) continue;
    const std::vector<planner::Waypoint> path = on_the_map(problem, drive.path);
    if (path.size() < 2) continue;
    const bool stopped = drive.outcome == PastOutcome::kSlipStop;
    const sim::PastDriveReport report{stopped, kModelError, stopped ? kTriesOfStopped : kTriesOfCompleted};
    if (const auto done = planner::condition_draws(problem, path, report, progress, ground.draws); !done) {
      if (done.error().code == ErrorCode::kCancelled) return fail(done.error());
      continue;  // a wheel of this rover meets ground that is not known
    }
    ++ground.drives;
  }
  return {};
}

GroundEvidence evidence_of(ConditionedGround ground) {
  flatten(ground.draws);
  return {std::make_shared<const std::vector<sim::ConditionedDraw>>(std::move(ground.draws)), ground.drives};
}

Result<GroundEvidence> ConditionedGroundCache::get(const std::string& key,
                                                   const planner::PlanProblem& problem,
                                                   const DriveOutcomeTable& table, int as_of_sol,
                                                   Progress& progress) {
  ConditionedGround ground;
  {
    const std::lock_guard lock(mutex_);
    const bool serves = ground_ && !key.empty() && key_ == key &&
                        (ground_->rows == 0 || table.drives[ground_->rows - 1].sol < as_of_sol);
    if (serves) ground = *ground_;
  }
  if (const auto done = condition_draws(problem, table, as_of_sol, progress, ground); !done)
    return fail(done.error());
  if (key.empty()) return evidence_of(std::move(ground));
  const std::lock_guard lock(mutex_);
  key_ = key;
  ground_ = std::make_shared<const ConditionedGround>(ground);
  return evidence_of(std::move(ground));
}

}  // namespace slipway::api
