#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dem/soil_map.h"
#include "dem/terrain.h"
#include "planner/problem/displaced_start.h"
#include "planner/problem/ranking.h"
#include "planner/problem/weights.h"
#include "sim/prediction/drive_prediction.h"
#include "sim/rover/rover_model.h"

namespace slipway::planner {

struct Departure;

using Polygon = std::vector<Eigen::Vector2d>;  // map metres, closed implicitly, at least three corners

// How the rover stands to its direction of travel.
struct Manner {
  bool backwards = false;
  double crab_rad =
      0.0;  // direction of travel from the body's x axis (its -x axis backwards), positive to the left

  // The body's heading that goes with a direction of travel, and back.
  double body_yaw(double travel_rad) const;
  double travel(double body_yaw_rad) const;
};

// A place to go, with a heading where it matters.
struct Waypoint {
  double x_m = 0.0;
  double y_m = 0.0;
  std::optional<double> yaw_rad;
};

// Everything a plan depends on. Built by the service from a request; nothing is read from outside.
struct PlanProblem {
  std::shared_ptr<const dem::Terrain> terrain;
  bool terrain_is_whole_map = true;  // otherwise a plan may ask for a wider one
  std::shared_ptr<const dem::SoilMap> soil_map;
  sim::SoilBeliefs beliefs;  // known: in the order of soil_map->soils()
  std::shared_ptr<const sim::RoverModel> rover;
  double gravity_m_s2 = 3.71;
  Waypoint start, goal;
  std::vector<Waypoint> waypoints;  // visited in order
  std::vector<Polygon> keep_out;
  std::vector<Polygon> keep_in;  // each an area that the rover's body must not leave
  sim::DriveLimits limits;
  sim::DriveConditions conditions;
  Weights weights;  // with the terms of the cost that they are of
  Ranking ranking;
  int routes = 3;
  int verify = 0;                     // how many of the best-ranked are driven in the dynamic simulation too
  std::vector<std::string> planners;  // names of the catalogue; empty: its default set
  sim::RiskOptions risk;
  // How many of risk.draws rank the candidates at first, where these are many; 0: all of them.
  int ranking_draws = 0;
  std::shared_ptr<const Departure> departure;  // where it is asked when the drive may begin
  std::optional<StartError> start_error;       // of a plan's start; empty: it is where it is said to be
  std::size_t threads = 0;                     // 0: as many as the machine has

  // Start, waypoints in their order, goal.
  std::vector<Waypoint> places() const;
  std::vector<double> leg_lengths_m() const;  // between these
  // The lower of the request's and the rover's limits.
  double max_tilt_rad() const;
};

constexpr int kMaxVerified = 3;  // routes of a plan that are driven in the dynamic simulation

}  // namespace slipway::planner
