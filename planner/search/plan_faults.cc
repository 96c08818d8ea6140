#include "planner/search/plan_faults.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/angle.h"
#include "planner/search/planner_catalogue.h"
#include "sim/rover/stance.h"

namespace slipway::planner {
namespace {

constexpr int kMaxRoutes = 10;
constexpr std::size_t kMaxWaypoints = 50;
constexpr std::size_t kMaxSoils = 254;  // a search's cell keeps its soil in a byte

std::string names_of(std::span<const PlannerRow> planners) {
  std::string names;
  for (const PlannerRow& row : planners) names += fmt::format("{}{}", names.empty() ? "" : ", ", row.name);
  return names;
}

void check_polygons(std::string_view pointer, const std::vector<Polygon>& polygons,
                    std::vector<Fault>& faults) {
  for (std::size_t i = 0; i < polygons.size(); ++i) {
    const Polygon& polygon = polygons[i];
    if (polygon.size() < 3) {
      faults.push_back({fmt::format("{}/{}", pointer, i),
                        fmt::format("a polygon of {} corners, must have at least 3", polygon.size())});
    } else if (std::any_of(polygon.begin(), polygon.end(),
                           [](const Eigen::Vector2d& p) { return !p.allFinite(); })) {
      faults.push_back({fmt::format("{}/{}", pointer, i), "a corner is not finite"});
    }
  }
}

void check_settings(const PlanProblem& problem, std::span<const PlannerRow> planners,
                    std::vector<Fault>& faults) {
  if (problem.routes < 1 || problem.routes > kMaxRoutes)
    faults.push_back({"/routes", fmt::format("routes = {}, must be in [1, {}]", problem.routes, kMaxRoutes)});
  if (problem.verify < 0 || problem.verify > kMaxVerified)
    faults.push_back(
        {"/verify", fmt::format("verify = {}, must be in [0, {}]", problem.verify, kMaxVerified)});
  if (problem.waypoints.size() > kMaxWaypoints) {
    faults.push_back({"/waypoints", fmt::format("{} waypoints, must be at most {}", problem.waypoints.size(),
                                                kMaxWaypoints)});
  }
  if (problem.beliefs.known.size() > kMaxSoils) {
    faults.push_back(
        {"/soil_map", fmt::format("{} soils, must be at most {}", problem.beliefs.known.size(), kMaxSoils)});
  }
  for (std::size_t i = 0; i < problem.planners.size(); ++i) {
    if (planner_named(problem.planners[i], planners) == nullptr) {
      faults.push_back(
          {fmt::format("/planners/{}", i), fmt::format("planner \"{}\" is not known; known are {}",
                                                       problem.planners[i], names_of(planners))});
    }
  }
  for (std::size_t row = 0; row < problem.weights.terms().size(); ++row) {
    const Field& field = problem.weights.terms()[row].weight;
    const double weight = problem.weights[row];
    if (weight >= field.lowest && weight <= field.highest) continue;
    faults.push_back(
        {fmt::format("/weights/{}", field.name),
         fmt::format("{} = {:g}, must be in [{:g}, {:g}]", field.name, weight, field.lowest, field.highest)});
  }
  if (!(problem.ranking.tail > 0.0 && problem.ranking.tail <= 1.0))
    faults.push_back(
        {"/ranking/tail", fmt::format("tail = {:g}, must be over 0 and at most 1", problem.ranking.tail)});
  check_polygons("/keep_out", problem.keep_out, faults);
  check_polygons("/keep_in", problem.keep_in, faults);
}

// Headings at which the rover would stand there: the one that is given, or enough to find one that is
// allowed.
std::vector<double> headings_of(const Waypoint& place) {
  if (place.yaw_rad) return {*place.yaw_rad};
  std::vector<double> headings(8);
  for (std::size_t k = 0; k < headings.size(); ++k) headings[k] = rad_from_deg(45.0 * static_cast<double>(k));
  return headings;
}

void check_standing(const PlanProblem& problem, const KeepOut& keep_out, const sim::Ground& ground,
                    const Waypoint& place, const std::string& pointer, std::vector<Fault>& faults) {
  const double limit = problem.max_tilt_rad();
  double least_tilt = std::numeric_limits<double>::infinity();
  bool outside = false;
  for (const double heading : headings_of(place)) {
    const Pose2 pose{place.x_m, place.y_m, heading};
    outside |= !keep_out.hits(pose);
    const std::optional<sim::Stance> stance = sim::settle(*problem.rover, ground, pose);
    if (stance) least_tilt = std::min(least_tilt, stance->attitude.tilt_rad());
  }
  if (!outside) {
    faults.push_back({pointer, fmt::format("the rover's body at ({:.2f}, {:.2f}) is {}", place.x_m, place.y_m,
                                           problem.keep_in.empty() ? "inside a keep-out"
                                           : problem.keep_out.empty()
                                               ? "not wholly inside a keep-in"
                                               : "inside a keep-out or not wholly inside a keep-in")});
  }
  if (!std::isfinite(least_tilt)) {
    faults.push_back(
        {pointer, fmt::format("the suspension finds no stance at ({:.2f}, {:.2f})", place.x_m, place.y_m)});
  } else if (least_tilt > limit) {
    faults.push_back(
        {pointer, fmt::format("tilt = {:.1f} deg at ({:.2f}, {:.2f}), must be at most {:.1f} deg",
                              deg_from_rad(least_tilt), place.x_m, place.y_m, deg_from_rad(limit))});
  }
}

}  // namespace

std::vector<Fault> faults_of_legs(const Waypoint& start, const std::vector<Waypoint>& waypoints,
                                  const Waypoint& goal) {
  constexpr double kSamePlace_m = 0.1;
  std::vector<std::pair<std::string, Waypoint>> places{{"/start", start}};
  for (std::size_t i = 0; i < waypoints.size(); ++i)
    places.emplace_back(fmt::format("/waypoints/{}", i), waypoints[i]);
  places.emplace_back("/goal", goal);
  std::vector<Fault> faults;
  for (std::size_t i = 1; i < places.size(); ++i) {
    const auto& [before, from] = places[i - 1];
    const auto& [pointer, to] = places[i];
    if (std::hypot(to.x_m - from.x_m, to.y_m - from.y_m) >= kSamePlace_m) continue;
    faults.push_back(
        {pointer, fmt::format("{} at ({:.2f}, {:.2f}) is where {} is, at ({:.2f}, {:.2f}): there "
                              "is no way to plan between them",
                              pointer, to.x_m, to.y_m, before, from.x_m, from.y_m)});
  }
  return faults;
}

std::optional<ErrorCode> check_place(const PlanProblem& problem, const sim::Ground& ground,
                                     const Waypoint& place, double reach_m, const std::string& pointer,
                                     std::vector<Fault>& faults) {
  const dem::Extent extent = problem.terrain->geometry().extent();
  if (!extent.contains(place.x_m, place.y_m)) {
    faults.push_back(
        {pointer,
         fmt::format("({:.2f}, {:.2f}) is off the map, which spans ({:.2f}, {:.2f}) to ({:.2f}, {:.2f})",
                     place.x_m, place.y_m, extent.west_m, extent.south_m, extent.east_m, extent.north_m)});
    return ErrorCode::kOffMap;
  }
  const auto has_ground = [&](double angle_rad) {
    return ground.at(place.x_m + reach_m * std::cos(angle_rad), place.y_m + reach_m * std::sin(angle_rad))
        .has_value();
  };
  bool all = ground.at(place.x_m, place.y_m).has_value();
  for (int k = 0; k < 16 && all; ++k) all = has_ground(rad_from_deg(22.5 * k));
  if (all) return std::nullopt;
  faults.push_back({pointer, fmt::format("elevation is missing within {:.2f} m of ({:.2f}, {:.2f})", reach_m,
                                         place.x_m, place.y_m)});
  return ErrorCode::kNoData;
}

std::optional<Error> faults_of(const PlanProblem& problem, std::span<const PlannerRow> planners,
                               const KeepOut& keep_out, const sim::Ground& ground) {
  std::vector<Fault> faults;
  std::vector<ErrorCode> codes;
  // The circle that the body describes when it turns there.
  const double reach = 0.5 * std::hypot(problem.rover->body_length_m, problem.rover->body_width_m);
  const auto check = [&](const Waypoint& place, const std::string& pointer) {
    const std::optional<ErrorCode> wrong = check_place(problem, ground, place, reach, pointer, faults);
    if (wrong) {
      codes.push_back(*wrong);
    } else {
      check_standing(problem, keep_out, ground, place, pointer, faults);
    }
  };
  check_settings(problem, planners, faults);
  check(problem.start, "/start");
  check(problem.goal, "/goal");
  for (std::size_t i = 0; i < problem.waypoints.size(); ++i)
    check(problem.waypoints[i], fmt::format("/waypoints/{}", i));
  for (Fault& fault : faults_of_legs(problem.start, problem.waypoints, problem.goal))
    faults.push_back(std::move(fault));
  if (faults.empty()) return std::nullopt;
  ErrorCode code = ErrorCode::kInvalidRequest;
  for (const ErrorCode candidate : {ErrorCode::kNoData, ErrorCode::kOffMap})
    if (std::find(codes.begin(), codes.end(), candidate) != codes.end()) code = candidate;
  return Error{code, fmt::format("the plan cannot start: {}", faults.front().message), std::move(faults)};
}

}  // namespace slipway::planner
