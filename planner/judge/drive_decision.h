#pragma once

#include "planner/problem/decision.h"
#include "planner/problem/problem.h"
#include "sim/prediction/drive_prediction.h"

namespace slipway::planner {

// Decides a predicted drive by the problem's bars (sim::OutcomeBars).
//   NO-GO    the rover has no stance somewhere, the ground's shape breaks a limit of clearance, or the lower
//   end of
//            the interval of embedding or of expected stops is over its bar;
//   GO       the upper ends of both are under their bars;
//   UNKNOWN  otherwise, and where a NO-GO hangs on ground that no map names: without what goes wrong there,
//   both
//            are under their bars.
// Of one segment of a drive by the bars alone.
Decision decide(const sim::OutcomeBars& bars, const sim::SegmentRisk& segment);

DriveDecision decide(const PlanProblem& problem, const sim::DrivePrediction& drive);

}  // namespace slipway::planner
