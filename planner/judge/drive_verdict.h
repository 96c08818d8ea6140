#pragma once

#include <vector>

#include "planner/problem/dynamic_verification.h"
#include "planner/problem/motion.h"
#include "planner/problem/problem.h"
#include "planner/problem/verdict.h"
#include "sim/prediction/drive_prediction.h"

namespace slipway::planner {

// What a drive is judged by besides its prediction.
struct VerdictSetting {
  // Where they are given, the body must keep the problem's areas along them. By the body's heading.
  const std::vector<Motion>* motions = nullptr;
  const DynamicVerification* dynamic = nullptr;  // where it was driven in motion too
};

// Judges a predicted drive by every rule, from one list:
//   NO-GO    on the mean soils: no stance, immobilised, a limit of the request broken; the body enters a
//            keep-out or leaves a keep-in, also where side slip takes it; the drive in motion refutes it;
//   over the draws: a halt, immobilised, embedded, each by its bars (sim::OutcomeBars): GO where the
//            interval's upper end is below the lower bar, NO-GO where its lower end is above the upper one.
//            What goes wrong on ground that no map names leaves the drive UNKNOWN where all else is a GO;
//   UNKNOWN  where the solver gave up on the mean soils, side slip may take the body into a keep-out, or the
//            drive in motion has no answer.
// A drive in segments is judged segment by segment, each as a sol's drive of its own.
DriveVerdict judge_drive(const PlanProblem& problem, const sim::DrivePrediction& drive,
                         const VerdictSetting& setting = {});

// Of one segment of a drive, by the bars alone.
Verdict judge_segment(const sim::OutcomeBars& bars, const sim::OutcomeShares& segment);

}  // namespace slipway::planner
