#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/pose.h"
#include "core/progress.h"
#include "core/result.h"
#include "sim/dynamic/drive_leg.h"
#include "sim/dynamic/drive_sample.h"
#include "sim/dynamic/drive_soils.h"
#include "sim/dynamic/dynamic_options.h"
#include "sim/dynamic/rut_map.h"
#include "sim/prediction/drive_prediction.h"
#include "sim/quasi_static/quasi_static.h"
#include "sim/rover/ground.h"
#include "sim/rover/rover_model.h"
#include "sim/soil/soil.h"
#include "sim/wheel/per_wheel.h"

namespace slipway::sim {

enum class DriveEnd {
  kFinished,
  kImmobilised,  // no progress for give_up_s, or on a whole leg: spins, stalls, slides back; or on its belly
  kTipped,       // tilt beyond kTippedRad
  kSunkToAxle,   // a wheel at the laws' own limit
  kSlid,         // does not rest at its start
};
// "finished", "immobilised", "tipped", "sunk_to_axle", "slid".
std::string_view describe(DriveEnd end);
constexpr double kTippedRad = 1.1;

enum class DriveEventKind { kLegEnds, kLiftOff, kTouchDown, kStall, kStallEnds, kJointStop };
std::string_view describe(DriveEventKind kind);

struct DriveEvent {
  DriveEventKind kind = DriveEventKind::kLegEnds;
  double time_s = 0.0;
  int wheel = -1;  // where it is about one
  int leg = -1;
};

// What a drive cost to compute.
struct IntegrationWork {
  long steps = 0, evaluations = 0, jacobians = 0, restarts = 0;
};

// A drive as simulated in motion. "Immobilised after 1.2 m" is an answer, not an error.
struct DynamicDrive {
  DriveEnd end = DriveEnd::kFinished;
  std::string reason;  // with the numbers; empty where finished
  double duration_s = 0.0;
  double progress_m = 0.0;   // as in the last sample
  double commanded_m = 0.0;  // of all legs
  double energy_j = 0.0;     // from the bus, of the drive motors
  Pose2 start, final;        // of B, settled and at the end; final yaw not wrapped
  Pose2 commanded;           // where the drive would have ended without slip
  Peak max_slip_ratio, max_tilt_rad, max_current_a,
      max_sinkage_m;  // over the integrator's steps; distances of progress, from 0
  std::vector<DriveEvent> events;
  RutMap ruts = RutMap();
  IntegrationWork work;
};

// Slip of a whole drive as ROAMS's Table 1 counts it: how far the final place is from the commanded one, per
// commanded metre.
double final_slip_ratio(const DynamicDrive& drive);

using DriveSink = std::function<void(const DriveSample&)>;

// Settles the rover at the start, then drives the legs in order, and gives every sample to the sink, first
// and last instant included. The same arguments give the same bits.
//
// Errors: no_data where a wheel has no ground (at the start, or where the drive leaves the ground: the detail
// says where), invalid_request for a start that the suspension can't follow or legs that say nothing, not_
// converged where the integrator gives up (with its reason as a sentence), cancelled.
Result<DynamicDrive> simulate_drive(const RoverModel& rover, double gravity_m_s2, const Ground& ground,
                                    const DriveSoils& soils, const Pose2& start,
                                    std::span<const DriveLeg> legs, const DynamicOptions& options,
                                    const DriveSink& sink, Progress& progress);

}  // namespace slipway::sim
