#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "api/files/drive_outcomes.h"
#include "core/progress.h"
#include "core/result.h"
#include "planner/problem/problem.h"

namespace slipway::api {

// What drives of the past make of the draws of the ground.
struct GroundEvidence {
  std::shared_ptr<const std::vector<sim::ConditionedDraw>> draws;  // weights with a mean of 1
  int drives = 0;                                                  // that were used
};

// The share of drives whose outcome a model calls wrongly though its ground is right: what it leaves out,
// rocks and ripples above all, stops drives too. Assumed.
inline constexpr double kModelError = 0.05;

// Where many drives leave few draws with any weight, the weights are flattened until this share is effective:
// the answer then leans less on them than it might, and never on a handful of draws.
inline constexpr double kMinEffective = 0.1;

// Draws that are conditioned where a request says no number: some of them weigh little.
inline constexpr int kWeighedDraws = 200;

// Draws of the ground under a completed drive and under one that stopped: a stop is the rarer, and drives
// that stopped are short.
inline constexpr int kTriesOfCompleted = 2, kTriesOfStopped = 16;

// Draws that are conditioned on the first drives of a table, before their weights are flattened.
struct ConditionedGround {
  std::size_t rows = 0;  // of the table that are done with
  int drives = 0;        // that were used
  std::vector<sim::ConditionedDraw> draws;
};

// Conditions the problem's draws on the outcomes of the drives before `as_of_sol`, in their order: the ground
// under each is drawn several times and one draw kept by how well it goes with the outcome, 1 - kModelError
// where it stops as the drive did or passes as it did, and kModelError where it does not; a draw's weight is
// the product of the mean likelihoods [sequential importance resampling, with the belief as its proposal].
// Drives of which nothing is known count for nothing, those halted by something else as far as they came.
// Parts of their paths off the problem's terrain are left out. The problem's rover, limits, checks, seed and
// number of draws are those of the answer. Goes on from `ground`, which is empty at first. Errors: cancelled,
// with `ground` undefined.
Result<void> condition_draws(const planner::PlanProblem& problem, const DriveOutcomeTable& table,
                             int as_of_sol, Progress& progress, ConditionedGround& ground);

// Raises the weights to the largest power up to 1 that leaves kMinEffective of the draws effective, and
// scales them to a mean of 1.
void flatten(std::vector<sim::ConditionedDraw>& draws);
// (sum of the weights)^2 / sum of their squares.
double effective_draws(const std::vector<sim::ConditionedDraw>& draws, double power = 1.0);

// With flattened weights.
GroundEvidence evidence_of(ConditionedGround ground);

// Keeps the ground that was conditioned last, since requests that differ in their path alone ask for the same
// again, and a later sol only adds drives to it. Thread-safe.
class ConditionedGroundCache {
 public:
  // `key` names all that the answer depends on but the sol; nothing is kept where it is empty.
  Result<GroundEvidence> get(const std::string& key, const planner::PlanProblem& problem,
                             const DriveOutcomeTable& table, int as_of_sol, Progress& progress);

 private:
  std::mutex mutex_;
  std::string key_;
  std::shared_ptr<const ConditionedGround> ground_;
};

// The corners of the drives before a sol, so that the ground under them is read too.
std::vector<planner::Waypoint> places_of(const DriveOutcomeTable& table, int as_of_sol);

}  // namespace slipway::api
