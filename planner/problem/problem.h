#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dem/soil_map.h"
#include "dem/terrain.h"
#include "sim/prediction/drive_prediction.h"
#include "sim/rover/rover_model.h"

namespace slipway::planner {

using Polygon = std::vector<Eigen::Vector2d>;  // map metres, closed implicitly, at least three corners

// What a route costs, per row of the cost catalogue: weight times the term's value.
struct Weights {
  double duration = 1.0;  // per hour
  double energy = 1.0;    // per 100 Wh
  double slip = 4.0;      // per 100 m driven at 100 % slip
  double unknown = 2.0;   // per 100 m on unknown ground
  double risk = 20.0;     // per unit of probability that a limit is broken
};

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
  std::shared_ptr<const dem::SoilMap> soil_map;
  sim::SoilBeliefs beliefs;  // known: in the order of soil_map->soils()
  std::shared_ptr<const sim::RoverModel> rover;
  double gravity_m_s2 = 3.71;
  Waypoint start, goal;
  std::vector<Waypoint> waypoints;  // visited in order
  std::vector<Polygon> keep_out;
  sim::DriveLimits limits;
  sim::DriveConditions conditions;
  Weights weights;
  int routes = 3;
  int verify = 0;                     // of the best-ranked ones in the dynamic rung
  std::vector<std::string> planners;  // names of the catalogue; empty: its default set
  std::uint64_t seed = 1;
  sim::RiskOptions risk;
  std::size_t threads = 0;  // 0: as many as the machine has
};

constexpr int kMostVerified = 3;  // routes of a plan in the dynamic rung

}  // namespace slipway::planner
