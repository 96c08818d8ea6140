#pragma once

#include <vector>

#include "core/progress.h"
#include "core/result.h"
#include "planner/problem/dynamic_verification.h"
#include "planner/problem/problem.h"

namespace slipway::planner {

// Predicts the drive along a given path, whose corners are joined by turns in place and straight drives.
// Errors: off_map, no_data with the corner or place ("/path/3").
Result<sim::DrivePrediction> predict_path(const PlanProblem& problem, const std::vector<Waypoint>& corners,
                                          Progress& progress, const Manner& manner = {});

// Drives the same path, of which predict_path() gave `prediction`, in the dynamic simulation. Errors:
// cancelled.
Result<DynamicVerification> verify_path(const PlanProblem& problem, const std::vector<Waypoint>& corners,
                                        const sim::DrivePrediction& prediction, Progress& progress,
                                        const Manner& manner = {});

}  // namespace slipway::planner
