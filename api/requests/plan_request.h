#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "api/files/drive_rules.h"
#include "api/files/terrain_description.h"
#include "core/result.h"
#include "planner/problem/departure.h"
#include "planner/problem/drive_so_far.h"
#include "planner/problem/problem.h"
#include "sim/effects/effect_catalogue.h"
#include "sim/prediction/drive_prediction.h"
#include "sim/rover/wheel_failure.h"

namespace slipway::api {

struct ModelFolder;

// A corrected model that a request names by the job of the diagnosis that offers it.
struct RequestedModel {
  std::string diagnosis;            // the job's id
  std::vector<std::string> ground;  // soils of the terrain that are the model's, see with_model()
  std::shared_ptr<const ModelFolder> corrected;
};

// When a drive may begin, without what the terrain gives of the sky.
struct DepartureRequest : planner::Departure {
  std::vector<sky::SkySample> table;  // by rising times; empty: by formulas, on Mars
};

// The assumptions with which a drive is predicted, whether its path is planned or given. The defaults are
// those of the libraries below.
struct DriveAssumptions : DriveRules {
  sim::DriveConditions conditions;
  std::vector<sim::EffectSetting> effects;  // added to the rover's own; see sim::in_force
  sim::FailedWheels failed_wheels;
  std::optional<int> draws;  // as many; where it is empty, as many as the bars need
  std::uint64_t seed = 1;
  // Drives of the terrain's table before this sol count as evidence of the ground; none do where it is empty.
  std::optional<int> as_of_sol;
  std::optional<planner::DriveSoFar> drive_so_far;  // a drive under way counts as evidence of the ground too
  std::vector<sim::SoilDistribution> beliefs;  // stand in for the catalogue's soils of these names, or beside
  std::string unknown_soil;  // of the catalogue; what is believed of all unmapped ground where it is empty
  std::optional<double> confidence;    // in the legend; the legend's own where it is empty
  std::string legend;                  // of the terrain's legends; the first where it is empty
  std::optional<ReliefValues> relief;  // the relief is drawn too, with these over the terrain's own values
  // Length of the segments by which a drive is decided; where it is empty, a drive of a kilometre and more
  // has segments of kSegment_m, and no other has any.
  std::optional<double> segment_m;
  std::optional<double> speed_m_s;  // the rover's cruise speed where it is empty
  std::optional<DepartureRequest> departure;
  std::optional<RequestedModel> model;  // where it is empty, rover and soils are the catalogue's
};

// POST /v1/plans asks for routes from start to goal.
struct PlanRequest {
  std::string terrain;
  std::string rover;
  planner::Waypoint start, goal;
  std::optional<planner::StartError> start_error;
  std::vector<planner::Waypoint> waypoints;  // visited in order
  std::vector<planner::Polygon> keep_out;
  std::vector<planner::Polygon> keep_in;  // each an area that the rover's body must not leave
  planner::Weights weights;
  planner::Ranking ranking;
  int routes = planner::PlanProblem{}.routes;
  std::vector<std::string> planners;           // the catalogue's default set where it is empty
  int verify = planner::PlanProblem{}.verify;  // number of the best routes to simulate at the dynamic level
  DriveAssumptions drive;
};

// The outcome of reading a request: everything that could be read, and every fault. A request with faults
// serves only to find more of them.
template <class Request>
struct Reading {
  Request request;
  std::vector<Fault> faults;
};

// The maximum sizes of one request; the readers refuse larger ones.
struct RequestLimits {
  static constexpr std::size_t kBodyBytes = std::size_t{1} << 20U;
  static constexpr std::size_t kWaypoints = 50;
  static constexpr std::size_t kKeepOuts = 200;
  static constexpr std::size_t kKeepOutCorners = 500;
  static constexpr std::size_t kPathCorners = 2000;
  static constexpr double kPathLength_m = 20'000.0;
  static constexpr double kMinSpeed_m_s = 1e-4;  // slower drives take longer than any mission
  static constexpr double kMinSegment_m = 10.0;
  static constexpr int kRoutes = 8;
  static constexpr double kDepartureDays = 100.0;   // from the first to the last
  static constexpr std::size_t kSkyMoments = 4000;  // a body of a mebibyte holds them
  static constexpr int kDepartures = 500;           // that are tried
  static constexpr double kStartError_m = 20.0, kStartError_deg = 45.0;
  static constexpr int kDraws = 2000;
  static constexpr int kMaxSol = 1'000'000;
};

}  // namespace slipway::api
