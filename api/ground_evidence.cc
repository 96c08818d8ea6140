#include "api/ground_evidence.h"

#include <algorithm>
#include <cmath>

#include "core/random.h"
#include "planner/drive_so_far_evidence.h"
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

// The stream of renewals among those of a seed.
constexpr std::uint64_t kRenewals = 1ULL << 40U;

// What can't be simulated tells nothing: a wheel of this rover meets ground that is not known, or none.
Result<void> unless_cancelled(const Result<void>& done) {
  if (!done && done.error().code == ErrorCode::kCancelled) return done;
  return {};
}

// Conditions on the next drive's outcome. Where its slip was measured the steps say more than that it went
// on.
Result<void> learn_drive(const planner::PlanProblem& problem, const PastEvidence& past, Progress& progress,
                         ConditionedGround& ground) {
  const PastDrive& drive = past.outcomes.drives[ground.rows++];
  const bool stopped = drive.outcome == PastOutcome::kSlipStop;
  const bool measured = std::any_of(past.steps.begin(), past.steps.end(),
                                    [&](const steps::SlipStep& step) { return step.sol == drive.sol; });
  if (drive.outcome == PastOutcome::kNoReport) return {};
  if (measured && !stopped) {
    ++ground.drives;
    return {};
  }
  const std::vector<planner::Waypoint> path = on_the_map(problem, drive.path);
  if (path.size() < 2) return {};
  const sim::PastDriveReport report{stopped, kModelError, stopped ? kTriesOfStopped : kTriesOfCompleted};
  const auto done = planner::condition_draws(problem, path, report, progress, ground.draws);
  if (done) ++ground.drives;
  return unless_cancelled(done);
}

// Conditions on the next measured steps that follow each other over some metres.
Result<void> learn_stretch(const planner::PlanProblem& problem, const std::vector<steps::SlipStep>& steps,
                           Progress& progress, ConditionedGround& ground) {
  constexpr double kLength_m = 4.0, kApart_m = 1.5;
  planner::MeasuredWay way;
  const int sol = steps[ground.steps].sol;
  for (; ground.steps < steps.size() && way.measured.rolled_m < kLength_m; ++ground.steps) {
    const steps::SlipStep& step = steps[ground.steps];
    if (step.sol != sol) break;
    if (!step.x_eqc_m || !step.y_eqc_m || !step.course_rad) {
      if (way.along.empty()) continue;
      break;
    }
    const planner::Waypoint from{*step.x_eqc_m, *step.y_eqc_m, {}};
    if (!way.along.empty() &&
        std::hypot(from.x_m - way.along.back().x_m, from.y_m - way.along.back().y_m) > kApart_m)
      break;
    const double come_m = std::max(1.0 - step.slip, 0.0) * step.odometry_m;
    if (way.along.empty()) way.along.push_back(from);
    way.along.push_back(
        {from.x_m + come_m * std::sin(*step.course_rad), from.y_m + come_m * std::cos(*step.course_rad), {}});
    way.measured.rolled_m += step.odometry_m;
    way.measured.come_m += come_m;
  }
  way.along = on_the_map(problem, way.along);
  if (way.along.size() < 2) return {};
  const auto done = planner::condition_on_way(problem, way, kTriesOfMeasured, progress, ground.draws);
  if (done) ground.measured_m += way.measured.rolled_m;
  return unless_cancelled(done);
}

}  // namespace

std::vector<planner::Waypoint> places_of(const PastEvidence& past, int as_of_sol) {
  std::vector<planner::Waypoint> places;
  for (const PastDrive& drive : past.outcomes.drives)
    if (counts(drive, as_of_sol)) places.insert(places.end(), drive.path.begin(), drive.path.end());
  for (const steps::SlipStep& step : past.steps)
    if (step.sol < as_of_sol && step.x_eqc_m && step.y_eqc_m)
      places.push_back({*step.x_eqc_m, *step.y_eqc_m, {}});
  return places;
}

Result<void> condition_draws(const planner::PlanProblem& problem, const PastEvidence& past, int as_of_sol,
                             Progress& progress, ConditionedGround& ground) {
  ground.draws.resize(static_cast<std::size_t>(problem.risk.draws));
  const auto& drives = past.outcomes.drives;
  for (;;) {
    const bool has_drive = ground.rows < drives.size() && drives[ground.rows].sol < as_of_sol;
    const bool has_step = ground.steps < past.steps.size() && past.steps[ground.steps].sol < as_of_sol;
    if (!has_drive && !has_step) return {};
    const bool is_step = has_step && (!has_drive || past.steps[ground.steps].sol <= drives[ground.rows].sol);
    if (const auto done = is_step ? learn_stretch(problem, past.steps, progress, ground)
                                  : learn_drive(problem, past, progress, ground);
        !done)
      return done;
    if (sim::effective_draws(ground.draws) < 0.5 * static_cast<double>(ground.draws.size()))
      ground.draws = sim::renewed(ground.draws, ground.draws.size(),
                                  random_key(problem.risk.seed, kRenewals + ground.rows + ground.steps));
  }
}

GroundEvidence evidence_of(const ConditionedGround& ground, std::size_t count, std::uint64_t seed) {
  return {std::make_shared<const std::vector<sim::ConditionedDraw>>(
              sim::renewed(ground.draws, count, random_key(seed, kRenewals))),
          ground.drives, ground.measured_m};
}

Result<GroundEvidence> ConditionedGroundCache::get(const std::string& key,
                                                   const planner::PlanProblem& problem,
                                                   const PastEvidence& past, int as_of_sol, std::size_t count,
                                                   Progress& progress) {
  ConditionedGround ground;
  const auto is_past = [&](int sol) { return sol < as_of_sol; };
  {
    const std::lock_guard lock(mutex_);
    const bool serves = ground_ && !key.empty() && key_ == key &&
                        (ground_->rows == 0 || is_past(past.outcomes.drives[ground_->rows - 1].sol)) &&
                        (ground_->steps == 0 || is_past(past.steps[ground_->steps - 1].sol));
    if (serves) ground = *ground_;
  }
  if (const auto done = condition_draws(problem, past, as_of_sol, progress, ground); !done)
    return fail(done.error());
  if (!key.empty()) {
    const std::lock_guard lock(mutex_);
    key_ = key;
    ground_ = std::make_shared<const ConditionedGround>(ground);
  }
  return evidence_of(ground, count, problem.risk.seed);
}

}  // namespace slipway::api
