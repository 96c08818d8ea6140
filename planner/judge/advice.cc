#include "planner/judge/advice.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "planner/judge/deciding_draws.h"
#include "planner/judge/drive_verdict.h"
#include "planner/judge/verdict_words.h"
#include "planner/problem/displaced_start.h"
#include "planner/problem/terrain_ground.h"
#include "planner/timing/departures.h"

namespace slipway::planner {
namespace {

constexpr double kMinDrive_m = 4.0;
constexpr int kMaxTries = 2;
// The share of the lower bar of halts that a beginning may use up: its interval is narrower only with more
// draws.
constexpr double kShareOfBar = 0.5;

// How far the drive goes before something that may keep it from a GO.
double promising_m(const PlanProblem& problem, const sim::DrivePrediction& drive,
                   const DriveVerdict& verdict) {
  double least = drive.stations.empty() ? 0.0 : drive.stations.back().station.distance_m;
  for (const JudgedRule& rule : verdict.rules)
    if (rule.verdict != Verdict::kGo && rule.at_m) least = std::min(least, *rule.at_m - 1.0);
  double halted = 0.0;
  for (const sim::StationPrediction& at : drive.stations) {
    halted += at.stops;
    if (at.embedding > 0.0 || halted > kShareOfBar * problem.risk.bars.max_stop)
      return std::min(least, at.station.distance_m - 1.0);
  }
  return least;
}

Advice advice_at(Advice::Kind kind, double at_m, const Pose2& place) {
  Advice advice{.kind = kind};
  advice.to_m = at_m;
  advice.x_m = place.x_m;
  advice.y_m = place.y_m;
  return advice;
}

// From some start it is no GO. Neither a beginning nor what is measured on the way is looked at from there.
bool hangs_on_start(const DriveVerdict& verdict) {
  return verdict.starts && verdict.starts->count(Verdict::kGo) < verdict.starts->starts.size();
}

// What an operator can change for a rule of the day or the start; empty for a rule of the ground.
std::string_view change_for(const JudgedRule& rule) {
  struct Change {
    std::string_view rule, words;
  };
  static constexpr std::array<Change, 8> kChanges{
      {{"charge", "more charge"},
       {"arrival", "a later arrival"},
       {"sun", "another time of day"},
       {"earth", "another time of day"},
       {"light_left", "another time of day"},
       {"motor_cold", "another time of day"},
       {"motor_hot", "another time of day"},
       {"start", "knowing better where the rover stands and how it is turned, before it drives"}}};
  const auto* const found = std::find_if(kChanges.begin(), kChanges.end(),
                                         [&](const Change& each) { return each.rule == rule.name; });
  if (found == kChanges.end()) return {};
  return rule.verdict == Verdict::kUnknown && rule.name != "start" ? "a longer table of the sky"
                                                                   : found->words;
}

std::vector<sim::PathStation> beginning(const std::vector<sim::PathStation>& path, double length_m) {
  const auto end = std::find_if(path.begin(), path.end(), [&](const sim::PathStation& station) {
    return station.distance_m > length_m;
  });
  return {path.begin(), end};
}

}  // namespace

std::optional<Advice> shorter_drive(const PlanProblem& problem, const std::vector<sim::PathStation>& path,
                                    const sim::DrivePrediction& drive, const DriveVerdict& verdict,
                                    Progress& progress) {
  if (verdict.verdict == Verdict::kGo || drive.draws == 0) return std::nullopt;
  if (hangs_on_start(verdict)) return std::nullopt;
  double length_m = promising_m(problem, drive, verdict);
  for (int tried = 0; tried < kMaxTries && length_m >= kMinDrive_m; ++tried, length_m *= 0.5) {
    const std::vector<sim::PathStation> shorter = beginning(path, length_m);
    if (shorter.empty() || shorter.back().distance_m < kMinDrive_m) return std::nullopt;
    const auto predicted = sim::predict_drive(
        *problem.rover, problem.gravity_m_s2, TerrainGround(problem.terrain, problem.soil_map),
        problem.beliefs, shorter, problem.limits,
        risk_of_drive(problem.risk, shorter.back().distance_m, shorter.size()), problem.threads, progress,
        problem.conditions);
    if (!predicted) return std::nullopt;
    DriveVerdict judged = judge_drive(problem, *predicted);
    if (judged.verdict == Verdict::kGo) add_departures(problem, *predicted, judged, progress);
    if (judged.verdict != Verdict::kGo) continue;
    const sim::PathStation& end = shorter.back();
    Advice advice = advice_at(Advice::Kind::kShorterDrive, end.distance_m, end.pose);
    advice.words = fmt::format(
        "end the drive at {:.1f} m, at ({:.1f}, {:.1f}): to there it is a GO, with a halt "
        "in {} of {} draws",
        advice.to_m, advice.x_m, advice.y_m, percent(predicted->outcomes.stop.share), predicted->draws);
    if (judged.departures && judged.departures->halt) advice.words += "; " + judged.reasons.front();
    return advice;
  }
  return std::nullopt;
}

std::optional<Advice> scout_drive(const PlanProblem& problem, const sim::DrivePrediction& drive,
                                  const DriveVerdict& verdict) {
  constexpr double kLeastHope = 0.1;
  const sim::OutcomeBars& bars = problem.risk.bars;
  if (verdict.verdict != Verdict::kUnknown || !drive.scout || hangs_on_start(verdict)) return std::nullopt;
  if (verdict.departures && !verdict.departures->is_kept()) return std::nullopt;  // no slip mends the day
  const sim::ScoutDrive& scout = *drive.scout;
  if (scout.go < kLeastHope || scout.embedding >= bars.max_embedding ||
      scout.expected_stops >= bars.no_go_stop)
    return std::nullopt;
  Advice advice = advice_at(Advice::Kind::kScoutDrive, scout.from_m, scout.from);
  advice.words = fmt::format(
      "drive {:.0f} m onto the ground at {:.0f} m, at ({:.1f}, {:.1f}), and measure the "
      "slip there: that makes it a GO with a probability of {}",
      scout.to_m - scout.from_m, scout.from_m, advice.x_m, advice.y_m, percent(scout.go));
  return advice;
}

std::optional<Advice> other_route(const std::vector<Route>& routes) {
  if (routes.empty() || routes.front().verdict() == Verdict::kGo) return std::nullopt;
  const auto go = std::find_if(routes.begin(), routes.end(),
                               [](const Route& route) { return route.verdict() == Verdict::kGo; });
  if (go == routes.end()) return std::nullopt;
  Advice advice{.kind = Advice::Kind::kOtherRoute};
  advice.route = go->rank;
  advice.words = fmt::format("take route {}, which is a GO: it costs {:.2f} where this one costs {:.2f}",
                             go->rank, go->cost, routes.front().cost);
  return advice;
}

void advise(std::initializer_list<std::optional<Advice>> found, int draws, DriveVerdict& verdict) {
  for (const std::optional<Advice>& advice : found)
    if (advice) verdict.advice.push_back(*advice);
  if (verdict.verdict == Verdict::kGo || (!verdict.advice.empty() && !hangs_on_start(verdict))) return;
  bool hangs_on_ground = false, hangs_on_draws = true;  // of what the ground's rules say
  std::vector<std::string> changes;
  for (const JudgedRule& rule : verdict.rules) {
    if (rule.verdict == Verdict::kGo) continue;
    const std::string change(change_for(rule));
    if (change.empty()) {
      hangs_on_ground = true;
      hangs_on_draws &= rule.verdict == Verdict::kUnknown && rule.over_draws && draws < kMostDraws;
    } else if (std::find(changes.begin(), changes.end(), change) == changes.end()) {
      changes.push_back(change);
    }
  }
  if (hangs_on_ground)
    changes.insert(changes.begin(),
                   (hangs_on_draws ? fmt::format("more draws of the ground than {}, or ", draws) : "") +
                       "another way or another goal (no shorter drive and no scout drive does)");
  verdict.otherwise = fmt::format("{}", fmt::join(changes, ", and "));
}

}  // namespace slipway::planner
