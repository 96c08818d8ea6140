#include "api/service_sol.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "api/service_drives.h"
#include "core/utc.h"
#include "planner/judge/route_stations.h"
#include "planner/problem/departure.h"
#include "planner/search/stage_progress.h"

namespace slipway::api {
namespace {

constexpr double kPlanned = 0.85;        // of the work
constexpr double kLikelyEnough = 0.005;  // a halt on a stretch
constexpr double kLeast_m = 1e-6;        // that is still a drive

PlaceOnWay place_at(const sim::DrivePrediction& drive, double at_m, std::string why) {
  const sim::PathStation& station = planner::station_at(drive, at_m).station;
  return {station.distance_m, station.pose.x_m, station.pose.y_m, std::move(why)};
}

double halting(const sim::StretchRisk& stretch) {
  return stretch.expected_stops + stretch.embedding;
}

std::vector<PlaceOnWay> checks_of(const sim::DrivePrediction& drive) {
  std::vector<PlaceOnWay> checks;
  for (const sim::StretchRisk& stretch : drive.outcomes.stretches)
    if (halting(stretch) > kLikelyEnough)
      checks.push_back(
          place_at(drive, stretch.from_m,
                   fmt::format("a halt or an embedding in {:.1f} % of the draws from here to {:.0f} m",
                               100.0 * halting(stretch), stretch.to_m)));
  return checks;
}

// Of the stretch on which most draws halt or are embedded the station where most do; the station of the
// greatest risk, where that is more.
std::optional<PlaceOnWay> worst_of(const sim::DrivePrediction& drive) {
  const auto& stretches = drive.outcomes.stretches;
  const auto worst = std::max_element(
      stretches.begin(), stretches.end(),
      [](const sim::StretchRisk& a, const sim::StretchRisk& b) { return halting(a) < halting(b); });
  const double halts = worst == stretches.end() ? 0.0 : halting(*worst);
  if (drive.worst_place.value > halts)
    return place_at(
        drive, drive.worst_place.distance_m,
        fmt::format("{:.1f} % of the draws break a limit or are immobilised here, the most on the way",
                    100.0 * drive.worst_place.value));
  if (!(halts > 0.0)) return std::nullopt;
  double at_m = worst->from_m, most = 0.0;
  for (const sim::StationPrediction& station : drive.stations) {
    const double distance_m = station.station.distance_m;
    if (distance_m < worst->from_m || distance_m > worst->to_m || station.stops + station.embedding <= most)
      continue;
    most = station.stops + station.embedding;
    at_m = distance_m;
  }
  return place_at(
      drive, at_m,
      fmt::format("{:.1f} % of the draws halt or are embedded between {:.0f} and {:.0f} m, the most "
                  "on the way",
                  100.0 * halts, worst->from_m, worst->to_m));
}

// Where a drive that leaves at the best moment, or the nearest, is at the slow pace when its time is over.
std::optional<PlaceOnWay> place_when_time_is_over(const planner::Departures& departures,
                                                  const planner::DepartureRules& rules,
                                                  const sim::DrivePrediction& drive) {
  if (!rules.arrive_by) return std::nullopt;
  const planner::TimedDrive& timed = departures.drive;
  if (timed.stations.empty() || timed.arrives_late_ms <= *rules.arrive_by) return std::nullopt;
  const planner::TimedStation* last = &timed.stations.front();
  for (const planner::TimedStation& at : timed.stations)
    if (at.late_ms <= *rules.arrive_by) last = &at;
  if (last == &timed.stations.back()) return std::nullopt;  // the sky is not known for as long
  return place_at(drive, last->distance_m,
                  fmt::format("here the rover is at the slow pace at {}", utc_words(*rules.arrive_by)));
}

// The day of a way that begins where a drive is at the slow pace, with what is then left in the battery. It
// is held against the same rules but for the arrival: that is the goal's, and who turns back doesn't come
// there. Nothing where the sky's table ends before.
std::optional<DepartureRequest> day_from(const DepartureRequest& day, const planner::TimedDrive& drive,
                                         double at_m) {
  const auto station =
      std::find_if(drive.stations.begin(), drive.stations.end(),
                   [&](const planner::TimedStation& each) { return each.distance_m >= at_m - 1e-9; });
  if (station == drive.stations.end()) return std::nullopt;
  DepartureRequest later = day;
  later.rules.arrive_by.reset();
  later.from_ms = later.to_ms = station->late_ms;
  later.charge = std::clamp(station->charge_low, 0.0, 1.0);
  return later;
}

// The commands of a route up to a place, driven backwards from there to the start: the last first, each with
// its curve and turn the other way.
std::vector<planner::DriveStep> commands_back(const std::vector<planner::DriveStep>& commands,
                                              double from_m) {
  std::vector<planner::DriveStep> back;
  double left_m = from_m;
  for (const planner::DriveStep& step : commands) {
    if (step.drive_m > 0.0 && left_m < kLeast_m) break;
    const double drive_m = std::min(step.drive_m, left_m);
    left_m -= drive_m;
    back.push_back({drive_m, -step.radius_m, -step.turn_rad});
  }
  // A turn at the place itself is of what comes after it.
  while (!back.empty() && back.back().drive_m == 0.0) back.pop_back();
  std::reverse(back.begin(), back.end());
  return back;
}

CheckRequest back_from(const PlanRequest& plan, const planner::Route& route, const PlaceOnWay& from) {
  CheckRequest check;
  check.terrain = plan.terrain;
  check.rover = plan.rover;
  check.keep_out = plan.keep_out;
  check.keep_in = plan.keep_in;
  check.drive = plan.drive;
  check.drive.departure.reset();
  check.manner.backwards = true;
  const Pose2& pose = planner::station_at(route.prediction, from.at_m).station.pose;
  check.path = {{pose.x_m, pose.y_m, pose.yaw_rad}};
  check.commands = commands_back(route.commands.steps, from.at_m);
  return check;
}

}  // namespace

Result<PlanRequest> read_sol(const Service& service, std::string_view json) {
  auto request = read_plan(service, json);
  if (request && !request->drive.departure)
    return fail(ErrorCode::kInvalidRequest, "a sol is planned for a day",
                {{"/departure", "is missing: say from when to when the drive may begin"}});
  return request;
}

Result<SolAnswer> run_sol(const Service& service, const PlanRequest& request, Progress& progress) {
  planner::StageProgress planning(progress, "planning", 0.0, kPlanned);
  auto plan = run_plan(service, request, planning);
  if (!plan) return fail(plan.error());
  SolAnswer answer;
  answer.plan = std::move(*plan);
  if (answer.plan.plan.routes.empty()) return answer;
  const planner::Route& route = answer.plan.plan.routes.front();
  const sim::DrivePrediction& drive = route.prediction;
  if (drive.stations.empty()) return answer;
  answer.checks = checks_of(drive);
  answer.worst = worst_of(drive);
  if (route.decision.departures)
    answer.time_runs_out =
        place_when_time_is_over(*route.decision.departures, request.drive.departure->rules, drive);
  if (!answer.worst) return answer;
  CheckRequest back = back_from(request, route, *answer.worst);
  if (route.decision.departures) {
    back.drive.departure =
        day_from(*request.drive.departure, route.decision.departures->drive, answer.worst->at_m);
    if (!back.drive.departure) answer.no_way_back = "the table of the sky ends before the rover is there";
  }
  if (back.commands.empty()) answer.no_way_back = "the worst place is at the start";
  if (!answer.no_way_back.empty()) return answer;
  planner::StageProgress backing(progress, "backing out of the worst place", kPlanned, 1.0);
  auto back_out = run_check(service, back, backing);
  if (progress.cancelled() || (!back_out && back_out.error().code == ErrorCode::kCancelled))
    return fail(ErrorCode::kCancelled, "the sol was cancelled");
  if (back_out)
    answer.back_out = std::move(*back_out);
  else
    answer.no_way_back = back_out.error().detail;
  return answer;
}

}  // namespace slipway::api
