#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/pose.h"
#include "sim/dynamic/rut_map.h"
#include "sim/prediction/drive_prediction.h"

namespace slipway::sim {

enum class DriveEnd {
  kFinished,
  // The rover made no progress for give_up_s or on a whole leg (it spins, stalls or slides back), or its
  // belly touches the ground.
  kImmobilised,
  kTipped,      // the tilt exceeds kTippedRad
  kSunkToAxle,  // a wheel has sunk to the limit of the wheel-soil laws
  kSlid,        // the rover does not come to rest at its start
};
// "finished", "immobilised", "tipped", "sunk_to_axle", "slid".
std::string_view describe(DriveEnd end);
constexpr double kTippedRad = 1.1;

enum class DriveEventKind { kLegEnds, kLiftOff, kTouchDown, kStall, kStallEnds, kJointStop };
// "leg_ends", "lift_off", "touch_down", "stall", "stall_ends", "joint_stop".
std::string_view describe(DriveEventKind kind);

struct DriveEvent {
  DriveEventKind kind = DriveEventKind::kLegEnds;
  double time_s = 0.0;  // since the rover came to rest at the start
  int wheel = -1;       // index of the wheel that the event concerns; -1 for events of the whole rover
  int leg = -1;         // index of the leg on which it happened
};

// What a drive cost to compute.
struct IntegrationWork {
  long steps = 0, evaluations = 0, jacobians = 0, restarts = 0;
};

// A drive simulated at the dynamic fidelity level. "Immobilised after 1.2 m" is an answer, not an error.
struct DynamicDrive {
  DriveEnd end = DriveEnd::kFinished;
  std::string reason;  // a sentence with the numbers; empty where the drive finished
  double duration_s = 0.0;
  double progress_m = 0.0;   // as in the last sample
  double commanded_m = 0.0;  // length of all legs
  double energy_j = 0.0;     // that the drive motors took from the bus
  Pose2 start, final;        // of B after settling and at the end; the final yaw is not wrapped
  Pose2 commanded;           // where the drive would have ended without slip
  // Maxima over the integrator's steps; their distances are of progress along the legs.
  Peak max_slip_ratio, max_tilt_rad, max_current_a, max_sinkage_m;
  std::vector<DriveEvent> events;
  RutMap ruts = RutMap();
  IntegrationWork work;
};

// Slip of a whole drive as in Table 1 of the ROAMS paper: the distance between the final and the commanded
// position, per commanded metre; 0 where no length was commanded.
double final_slip_ratio(const DynamicDrive& drive);

}  // namespace slipway::sim
