#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/result.h"
#include "planner/problem/keep_out.h"
#include "planner/problem/problem.h"
#include "planner/search/planner_catalogue.h"
#include "sim/rover/ground.h"

namespace slipway::planner {

// Everything that is wrong with a problem before any search, together. The code is off_map or no_data where a
// place is, otherwise invalid_request.
std::optional<Error> faults_of(const PlanProblem& problem, std::span<const PlannerRow> planners,
                               const KeepOut& keep_out, const sim::Ground& ground);

// Places that follow each other and are one place: there is no way between them. The fault is the later one's
// ("/goal", "/waypoints/2") and names both.
std::vector<Fault> faults_of_legs(const Waypoint& start, const std::vector<Waypoint>& waypoints,
                                  const Waypoint& goal);

// One place: on the map, with elevation there and on a circle around it (0: there only). Appends to `faults`;
// returns what is wrong.
std::optional<ErrorCode> check_place(const PlanProblem& problem, const sim::Ground& ground,
                                     const Waypoint& place, double reach_m, const std::string& pointer,
                                     std::vector<Fault>& faults);

}  // namespace slipway::planner
