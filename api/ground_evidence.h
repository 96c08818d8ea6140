#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "api/files/drive_outcomes.h"
#include "core/progress.h"
#include "core/result.h"
#include "planner/problem/problem.h"
#include "steps/slip_step.h"

namespace slipway::api {

// What was driven and measured on this ground, and the ground after it.
struct GroundEvidence {
  std::shared_ptr<const std::vector<sim::ConditionedDraw>> draws;  // of equal weight
  int drives = 0;           // whose outcomes or measured slip were used
  double measured_m = 0.0;  // over which slip was measured
};

// What is known of drives of the past on a terrain.
struct PastEvidence {
  const DriveOutcomeTable& outcomes;
  const std::vector<steps::SlipStep>& steps;  // by sol
};

// The share of drives whose outcome a model calls wrongly though its ground is right: what it leaves out,
// rocks and ripples above all, stops drives too. Assumed.
inline constexpr double kModelError = 0.05;

// Draws that are conditioned where a request says no number: some of them weigh little.
inline constexpr int kWeighedDraws = 200;

// Draws of the ground under a completed drive and under one that stopped: a stop is the rarer, and drives
// that stopped are short.
inline constexpr int kTriesOfCompleted = 2, kTriesOfStopped = 16;

// Draws of the ground under a measured stretch.
inline constexpr int kTriesOfMeasured = 4;

// Draws that are conditioned on what was first, by sol.
struct ConditionedGround {
  std::size_t rows = 0;   // of the table of outcomes that are done with
  std::size_t steps = 0;  // of the measured steps
  int drives = 0;         // that were used
  double measured_m = 0.0;
  std::vector<sim::ConditionedDraw> draws;
};

// Conditions the problem's draws on the outcomes of the drives before `as_of_sol`, in their order: the ground
// under each is drawn several times and one draw kept by how well it goes with the outcome, 1 - kModelError
// where it stops as the drive did or passes as it did, and kModelError where it does not; a draw's weight is
// the product of the mean likelihoods [sequential importance resampling, with the belief as its proposal].
// The measured slip of its sol is evidence in the same way, stretch by stretch (sim::condition_on_stretch).
// Where less than half of the draws is effective they are renewed (sim::renewed).
// Drives of which nothing is known count for nothing, those halted by something else as far as they came.
// Parts of their paths off the problem's terrain are left out. The problem's rover, limits, checks, seed and
// number of draws are those of the answer. Goes on from `ground`, which is empty at first. Errors: cancelled,
// with `ground` undefined.
Result<void> condition_draws(const planner::PlanProblem& problem, const PastEvidence& past, int as_of_sol,
                             Progress& progress, ConditionedGround& ground);

// `count` draws of equal weight.
GroundEvidence evidence_of(const ConditionedGround& ground, std::size_t count, std::uint64_t seed);

// Keeps the ground that was conditioned last, since requests that differ in their path alone ask for the same
// again, and a later sol only adds drives to it. Thread-safe.
class ConditionedGroundCache {
 public:
  // `key` names all that the answer depends on but the sol; nothing is kept where it is empty.
  Result<GroundEvidence> get(const std::string& key, const planner::PlanProblem& problem,
                             const PastEvidence& past, int as_of_sol, std::size_t count, Progress& progress);

 private:
  std::mutex mutex_;
  std::string key_;
  std::shared_ptr<const ConditionedGround> ground_;
};

// The places of drives and steps before a sol, so that the ground under them is read too.
std::vector<planner::Waypoint> places_of(const PastEvidence& past, int as_of_sol);

}  // namespace slipway::api
