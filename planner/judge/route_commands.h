#pragma once

#include <vector>

#include "planner/problem/drive_step.h"
#include "planner/problem/motion.h"
#include "planner/problem/problem.h"

namespace slipway::planner {

// A route's motions as commands that a rover takes: drives and arcs to a centimetre, radii too, turns in
// place to a tenth of a degree, and finer only before a drive so long that its end would be missed by over 3
// cm. Each command is chosen from the pose that those before it reach, so that what is rounded does not add
// up: the end is within 5 cm of the goal and, where the problem asks for a heading, within 0.2 deg of it.
// Turns of less than half a degree and drives of less than 20 cm are left to their neighbours where these can
// take them. The start has the heading that the problem asks for, or the one in which the first drive leaves.
//
// There must be a motion. command_motions() of the commands is the route that is meant: it is drawn,
// simulated, tested and commanded.
DriveSteps route_commands(const PlanProblem& problem, const std::vector<Motion>& motions);

}  // namespace slipway::planner
