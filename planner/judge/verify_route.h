#pragma once

#include <vector>

#include "core/progress.h"
#include "core/result.h"
#include "planner/problem/dynamic_verification.h"
#include "planner/problem/motion.h"
#include "planner/problem/problem.h"
#include "planner/problem/route.h"

namespace slipway::planner {

// Drives the motions in the dynamic simulation and compares the drive with its quasi-static prediction.
// A drive that ends early, leaves its route or the known ground or defeats the integrator is an answer.
// Errors: cancelled.
Result<DynamicVerification> verify_route(const PlanProblem& problem, const std::vector<Motion>& motions,
                                         const Manner& manner, const sim::DrivePrediction& quasi_static,
                                         Progress& progress);

}  // namespace slipway::planner
