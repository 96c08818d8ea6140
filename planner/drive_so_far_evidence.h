#pragma once

#include <vector>

#include "core/progress.h"
#include "core/result.h"
#include "planner/problem/drive_so_far.h"
#include "planner/problem/problem.h"

namespace slipway::planner {

// What was predicted of a stretch of the drive so far, before it was measured.
struct LearntStretch {
  TelemetryStretch stretch;
  sim::StretchForecast forecast;
};

// Draws of the ground for a drive under way, by their cost: draws of a short drive are cheap, and many are
// needed since few fit what is measured.
int draws_for(const PlanProblem& problem, const DriveSoFar& drive);

// Conditions draws of the ground on a drive under way, stretch by stretch in its order (see
// sim::condition_on_stretch()); the problem's rover has driven it. Draws that together have less than a
// thousandth of the weight are left out on the way; at its end kMaxLearntDraws stay, by their weights.
// `number` tells which are left. Errors as predict_path(), with the stretch's row ("/drive_so_far/rows/3").
Result<std::vector<LearntStretch>> condition_on_drive(const PlanProblem& problem, const DriveSoFar& drive,
                                                      Progress& progress,
                                                      std::vector<sim::ConditionedDraw>& draws);

// A measured stretch of a past drive, along places of the map.
struct MeasuredWay {
  std::vector<Waypoint> along;  // two or more
  sim::MeasuredStretch measured;
};

// Conditions draws of the ground on one. Errors as predict_path().
Result<void> condition_on_way(const PlanProblem& problem, const MeasuredWay& way, int tries,
                              Progress& progress, std::vector<sim::ConditionedDraw>& draws);

inline constexpr std::size_t kMaxLearntDraws = 600;

}  // namespace slipway::planner
