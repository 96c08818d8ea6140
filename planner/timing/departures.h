#pragma once

#include "core/progress.h"
#include "planner/problem/departure.h"
#include "planner/problem/problem.h"
#include "sim/prediction/drive_prediction.h"
#include "sim/rover/rover_model.h"

namespace slipway::planner {

// The windows of a predicted drive and its best departure; where no departure keeps the rules, the halt that
// makes one keep them and comes to the goal earliest, of halts at twenty places for up to two days and at
// most a hundred of the departures. `rover` as of DriveInTime. Where it is cancelled nothing is found.
Departures departures_of(const Departure& departure, const sim::RoverModel& rover,
                         const sim::DrivePrediction& prediction, Progress& progress);

// What is told of a window: the whole minutes within it, else the whole seconds, else its very ends.
DepartureWindow to_the_minute(const DepartureWindow& window);

// What the drive that was found makes of a verdict.
void judge_departures(const Departures& departures, DriveVerdict& verdict);

// Both, where the problem asks when the drive may begin.
void add_departures(const PlanProblem& problem, const sim::DrivePrediction& prediction, DriveVerdict& verdict,
                    Progress& progress);

}  // namespace slipway::planner
