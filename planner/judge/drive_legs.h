#pragma once

#include <vector>

#include "core/pose.h"
#include "planner/problem/motion.h"
#include "planner/problem/problem.h"
#include "sim/dynamic/drive_leg.h"
#include "sim/rover/rover_model.h"

namespace slipway::planner {

// The motions as commands to the rover, at its cruise speed and turn rate. Motions are of the direction of
// travel; the manner says how the body stands to it. Turns without a drive between them are one leg, drives
// of one curvature without a turn between them too: the rover would not halt there.
std::vector<sim::DriveLeg> drive_legs(const std::vector<Motion>& motions, const sim::RoverModel& rover,
                                      const Manner& manner = {});

// Where the body stands when the first leg begins.
Pose2 drive_start(const std::vector<Motion>& motions, const Manner& manner = {});

}  // namespace slipway::planner
