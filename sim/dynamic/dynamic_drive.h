#pragma once

#include <functional>
#include <span>

#include "core/pose.h"
#include "core/progress.h"
#include "core/result.h"
#include "sim/dynamic/drive_leg.h"
#include "sim/dynamic/drive_result.h"
#include "sim/dynamic/drive_sample.h"
#include "sim/dynamic/drive_soils.h"
#include "sim/dynamic/dynamic_options.h"
#include "sim/rover/ground.h"
#include "sim/rover/rover_model.h"

namespace slipway::sim {

using DriveSink = std::function<void(const DriveSample&)>;

// Lets the rover settle at the start, then drives the legs in order, and gives every sample to the sink, the
// first and the last instant included. The same arguments give the same bits.
//
// Errors: no_data where a wheel has no ground at the start or on the way (the detail says where);
// invalid_request for legs or options out of range (see faults_of) and for a start on which the suspension
// cannot stand; not_converged where the integrator gives up (with its reason as a sentence); cancelled.
Result<DynamicDrive> simulate_drive(const RoverModel& rover, double gravity_m_s2, const Ground& ground,
                                    const DriveSoils& soils, const Pose2& start,
                                    std::span<const DriveLeg> legs, const DynamicOptions& options,
                                    const DriveSink& sink, Progress& progress);

}  // namespace slipway::sim
