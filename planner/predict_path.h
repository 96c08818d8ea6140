#pragma once

#include <vector>

#include "core/progress.h"
#include "core/result.h"
#include "planner/problem/drive_step.h"
#include "planner/problem/dynamic_verification.h"
#include "planner/problem/motion.h"
#include "planner/problem/problem.h"
#include "planner/problem/verdict.h"

namespace slipway::planner {

// The motions of a path: turns in place and straight drives from corner to corner, by their direction of
// travel.
std::vector<Motion> path_motions(const std::vector<Waypoint>& corners, const Manner& manner = {});

// Predicts the drive along given motions. Errors: no_data with the place ("/stations/12").
Result<sim::DrivePrediction> predict_motions(const PlanProblem& problem, const std::vector<Motion>& motions,
                                             Progress& progress, const Manner& manner = {});

// Predicts the drive along a given path, whose corners are joined by turns in place and straight drives.
// Errors: off_map, no_data with the corner or place ("/path/3").
Result<sim::DrivePrediction> predict_path(const PlanProblem& problem, const std::vector<Waypoint>& corners,
                                          Progress& progress, const Manner& manner = {});

// Judges the drive along motions of which predict_motions() gave `prediction`, and says what would make it
// better. `dynamic` is the same drive in motion, where there is one. The motions are by the direction of
// travel.
DriveVerdict judge_motions(const PlanProblem& problem, const std::vector<Motion>& motions,
                           const Manner& manner, const sim::DrivePrediction& prediction,
                           const DynamicVerification* dynamic, Progress& progress);

// How drives of the past in a terrain's table were watched: Curiosity looks at its slip after each step of
// about a metre, and was not halted for sliding aside.
inline constexpr double kPastLook_m = 1.0;
void watch_as_past_drives(sim::DriveLimits& limits, sim::SlipChecks& checks);

// Conditions draws of the ground on a drive of the past along a path, the problem's rover having driven it by
// the problem's limits; see sim::condition_draws(). Errors as predict_path().
Result<void> condition_draws(const PlanProblem& problem, const std::vector<Waypoint>& corners,
                             const sim::PastDriveReport& report, Progress& progress,
                             std::vector<sim::ConditionedDraw>& draws);

// Drives the same path, of which predict_path() gave `prediction`, in the dynamic simulation. Errors:
// cancelled.
Result<DynamicVerification> verify_path(const PlanProblem& problem, const std::vector<Waypoint>& corners,
                                        const sim::DrivePrediction& prediction, Progress& progress,
                                        const Manner& manner = {});

}  // namespace slipway::planner
