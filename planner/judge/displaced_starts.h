#pragma once

#include <memory>

#include "core/progress.h"
#include "planner/problem/displaced_start.h"
#include "planner/problem/drive_step.h"
#include "planner/problem/problem.h"
#include "planner/problem/verdict.h"

namespace slipway::planner {

// The commands from the start that is said and from 24 beside it, on the mean soils and in the problem's
// areas: a rover that drives by its commands alone shifts and turns with its start, and so does all of its
// path. The 24 are six of Halton's points as sizes of normal errors, with four choices of their signs each:
// ahead, to the left and in heading they have the mean 0, the standard deviations of `error` and no
// correlation, and a mirrored map has the mirrored answer. They reach 1.9 standard deviations. A start from
// which the ground is not known is UNKNOWN. Nothing where it was cancelled.
std::shared_ptr<const DisplacedStarts> drive_from_displaced_starts(const PlanProblem& problem,
                                                                   const DriveSteps& commands,
                                                                   const StartError& error,
                                                                   Progress& progress);

// A rule "start" of the share of starts from which the drive is no GO: GO where it is none, NO-GO where it is
// more than the upper bar of halts. In between where the rover stands decides, which can be looked at before
// the drive: UNKNOWN.
void judge_starts(const DisplacedStarts& starts, const sim::OutcomeBars& bars, DriveVerdict& verdict);

}  // namespace slipway::planner
