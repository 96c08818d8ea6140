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
#include "sim/drive_leg.h"
#include "sim/drive_prediction.h"
#include "sim/ground.h"
#include "sim/per_wheel.h"
#include "sim/quasi_static.h"
#include "sim/rover_model.h"
#include "sim/rut_map.h"
#include "sim/soil.h"

namespace slipway::sim {

// The soils of a drive, in the order of Ground::soil_at's index, and the one for where it is unknown.
struct DriveSoils {
  std::vector<Soil> known;
  Soil unknown;

  const Soil& of(std::optional<std::size_t> soil) const { return soil ? known[*soil] : unknown; }
};

// The beliefs' mean soils.
DriveSoils mean_soils(const SoilBeliefs& beliefs);

struct DynamicOptions {
  double relative_tolerance = 1e-3;  // of CVODE, per step; absolute ones in proportion (rover_dynamics.h)
  Feedback feedback = Feedback::kNone;
  double sample_interval_s = 1.0;
  // Points under each wheel, along its travel, at which the ground is looked at: 1 is what the other rungs
  // do.
  int contact_points = 3;
  bool keep_ruts = false;  // all of them, for a deformed terrain; otherwise those near the rover
  // Immobilised: in this time, or on a whole leg, less than kLeastProgress of what was commanded; not judged
  // on less than half a wheel's radius of commanded way.
  double give_up_s = 60.0;
  std::optional<double> motor_temp_c = {};
};
constexpr double kLeastProgress = 0.02;

// The rover at an instant, true values.
struct DriveSample {
  double time_s = 0.0;
  Eigen::Vector3d p_MB = Eigen::Vector3d::Zero();
  Attitude attitude;                                         // yaw is not wrapped
  Eigen::Vector3d velocity_B = Eigen::Vector3d::Zero();      // of B's origin, m/s
  Eigen::Vector3d angular_rate_B = Eigen::Vector3d::Zero();  // what a gyroscope on the body feels, rad/s
  Eigen::Vector3d specific_force_B =
      Eigen::Vector3d::Zero();                      // what an accelerometer at B's origin feels, m/s^2
  std::array<double, 2> rocker_rad{}, bogie_rad{};  // left, right; 0 where there are none
  PerWheel<WheelState> wheels;  // sinkage and slip as in WheelState; loads along the ground's normal
  PerWheel<double> steer_rad;
  PerWheel<double> told_rate_rad_s;  // at the wheel
  PerWheel<double> turned_rad;       // of each wheel since the start: what an encoder counts
  PerWheel<double> voltage_v;        // at the drive motors
  double slip_ratio = 0.0;           // of the rover at that instant: 1 - speed / commanded speed
  double progress_m = 0.0;           // of B along the legs' lines since the start; turning in place adds none
  int leg = 0;
  bool driving = false;  // between the halts
};

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
