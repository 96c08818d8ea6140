#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/pose.h"
#include "sim/dynamic/dynamic_drive.h"
#include "sim/prediction/rule_catalogue.h"
#include "sim/rover/rover_model.h"

namespace slipway::planner {

// How far the dynamic simulation is from the quasi-static one at equal distances along the way.
struct LevelDifference {
  double mean = 0.0;      // dynamic less quasi-static, over the compared way
  double mean_abs = 0.0;  // the same without sign
  sim::Peak largest;      // without sign
};

// The greatest distance between the rover and the line of its route, with its place.
struct OffRoute {
  double distance_m = 0.0;
  double at_m = 0.0;            // progress along the legs
  double x_m = 0.0, y_m = 0.0;  // of B
};

// Further off its route than half the body's width and this, the rover is on ground of which the route says
// nothing: the verification ends there.
constexpr double kMaxBesideBody_m = 1.0;
double max_off_route_m(const sim::RoverModel& rover);

// A route as it was driven in the dynamic simulation, on the beliefs' mean soils, with its pose fed back.
struct DynamicVerification {
  std::optional<sim::DriveEnd> end;  // nothing: not simulated to an end, `reason` says why
  // The drive was stopped because it was further than max_off_route_m() from the route; then `end` is
  // nothing. It says neither that the route can be driven nor that it can't.
  bool left_the_route = false;
  OffRoute max_distance_from_route;
  std::string reason;       // empty where finished
  double distance_m = 0.0;  // where it ended: progress along the legs, 0 where it slid back
  Pose2 pose;               // of B there; yaw wrapped
  double commanded_m = 0.0;
  double duration_s = 0.0;
  std::optional<double> energy_j;  // from the bus, of the drive motors; nothing where there is no end
  // Slip is the mean over the time that a station's spacing takes: the first grip after each halt, of which a
  // balance knows nothing, does not count as slip on the way. There is no clearance: the dynamic simulation
  // only shows where the belly touches.
  sim::DriveExtremes extremes;
  std::vector<sim::BrokenLimit> broken_limits;
  // Of the rover's slip (over the same time), its deepest wheel and its largest current; driven parts only,
  // as far as both simulations got.
  double compared_m = 0.0;
  LevelDifference slip_ratio, sinkage_m, current_a;
  std::vector<std::string> wheel_names;  // in the order of every sample's wheels
  std::vector<sim::DriveSample>
      samples;  // evenly thinned, at most kMaxVerificationSamples, the last included
  std::vector<sim::DriveEvent> events;
  sim::IntegrationWork work;

  // Says that the route can't be driven so.
  bool refutes() const { return (end && *end != sim::DriveEnd::kFinished) || !broken_limits.empty(); }
};

constexpr std::size_t kMaxVerificationSamples = 400;

// "immobilised"; "left_the_route", or "no_answer", where there is no end.
std::string_view end_in_words(const DynamicVerification& verification);

}  // namespace slipway::planner
