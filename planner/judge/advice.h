#pragma once

#include <initializer_list>
#include <optional>
#include <vector>

#include "core/progress.h"
#include "planner/problem/problem.h"
#include "planner/problem/route.h"
#include "planner/problem/verdict.h"
#include "sim/prediction/drive_prediction.h"

namespace slipway::planner {

// What would make a drive that is no GO better, each found by the prediction that it would lead to. Where it
// is no GO from some displaced start no drive of its beginning is looked for.

// The longest beginning of the drive that was found to be a GO, of 4 m or more: predicted and judged like the
// whole. Nothing where the two that are tried are none, or where it was cancelled.
std::optional<Advice> shorter_drive(const PlanProblem& problem, const std::vector<sim::PathStation>& path,
                                    const sim::DrivePrediction& drive, const DriveVerdict& verdict,
                                    Progress& progress);

// A scout drive that would make a drive which is UNKNOWN for its ground a GO with a probability of a tenth or
// more, and that keeps the bars itself.
std::optional<Advice> scout_drive(const PlanProblem& problem, const sim::DrivePrediction& drive,
                                  const DriveVerdict& verdict);

// The first route that is a GO where the first is none.
std::optional<Advice> other_route(const std::vector<Route>& routes);

// Tells a drive's operator what was found, and where that is nothing what each rule that is no GO leaves to
// change. `draws`: that the drive was judged by.
void advise(std::initializer_list<std::optional<Advice>> found, int draws, DriveVerdict& verdict);

}  // namespace slipway::planner
