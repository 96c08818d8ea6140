#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/pose.h"
#include "core/progress.h"
#include "core/result.h"
#include "dem/soil_map.h"
#include "dem/terrain.h"
#include "planner/dynamic_verification.h"
#include "sim/drive_prediction.h"
#include "sim/rover_model.h"
#include "sim/soil.h"

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

// One term of a route's cost.
struct CostShare {
  std::string name;    // of the cost catalogue
  double value = 0.0;  // in the term's unit
  std::string unit;
  double weight = 0.0;
  double cost = 0.0;  // weight * value
};

enum class Verdict {
  kGo,       // within every limit, on known ground, risk within the accepted one
  kCaution,  // within every limit under the mean soils, but on unknown ground, at more than the accepted
             // risk, or with no answer from a rung that was asked
  kNoGo,     // a limit is broken or the rover immobilised under the mean soils, in any rung it was driven in
};

// "go", "caution", "no_go".
std::string_view describe(Verdict verdict);

constexpr double kAcceptedRisk = 0.05;
constexpr int kMostVerified = 3;  // routes of a plan in the dynamic rung

struct Route {
  int rank = 0;         // 1 is best
  std::string planner;  // that proposed it
  std::string profile;  // what the search was asked to minimise ("balanced", "shortest", ...)
  sim::DrivePrediction prediction;
  std::optional<DynamicVerification> dynamic;  // where it was verified
  double cost = 0.0;
  std::vector<CostShare> shares;  // add up to cost
  Verdict verdict = Verdict::kGo;
  std::vector<std::string> reasons;  // why it is ranked so and judged so, in words and numbers
};

struct Plan {
  std::vector<Route> routes;               // by rank
  std::vector<std::string> fewer_because;  // why there are fewer than asked for; empty otherwise
  int candidates = 0;                      // proposed by OMPL before selection
};

// Two routes differ when neither shares more than this much of its length with the other within a rover's
// width.
constexpr double kLargestOverlap = 0.6;

// Proposes with OMPL, simulates, ranks, verifies the best in the dynamic rung and ranks again. "No route" is
// a Plan without routes whose fewer_because says why. Errors: off_map, no_data (start, goal or a waypoint;
// faults "/start", "/goal", "/waypoints/1"), invalid_request (start, goal or waypoint inside a keep-out or
// steeper than the limits allow; unknown planner), cancelled.
Result<Plan> make_plan(const PlanProblem& problem, Progress& progress);

// The same prediction for a path that is given, corners joined by turns in place and straight drives. Errors:
// off_map, no_data with the corner or place ("/path/3").
Result<sim::DrivePrediction> predict_path(const PlanProblem& problem, const std::vector<Waypoint>& corners,
                                          Progress& progress, const Manner& manner = {});

// The same path, of which predict_path() gave `prediction`, driven in the dynamic rung. Errors: cancelled.
Result<DynamicVerification> verify_path(const PlanProblem& problem, const std::vector<Waypoint>& corners,
                                        const sim::DrivePrediction& prediction, Progress& progress,
                                        const Manner& manner = {});

}  // namespace slipway::planner
