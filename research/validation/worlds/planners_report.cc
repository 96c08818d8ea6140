#include <fmt/format.h>

#include <map>
#include <optional>
#include <string>

#include "research/validation/report/statistics.h"
#include "research/validation/worlds/comparisons.h"
#include "research/validation/worlds/world_planners.h"

namespace slipway::validation {
namespace {

constexpr double kLevel = 0.9;
constexpr int kDraws = 4000;
constexpr std::uint64_t kSeed = 20;
constexpr double kSucceeds = 0.9;  // a NO-GO on a drive that is completed more often is over-cautious

// What one planner's best route came to in one world.
struct Trial {
  bool proposed = false;
  std::string decision;
  double success = 0.0, stops = 0.0, embedded = 0.0;  // shares of drives, and stops per drive
  double length_m = 0.0, hours = 0.0;
  double over_cautious = 0.0;  // 1 where it is
};

// By world, by planner.
using Trials = std::map<std::uint64_t, std::map<std::string, Trial>>;

Trials trials_of(const std::vector<WorldScore>& scores) {
  Trials trials;
  for (const WorldScore& s : scores) {
    if (s.truth != "world") continue;
    Trial& trial = trials[s.world][s.planner];
    if (trial.proposed) continue;  // a worse route
    trial.decision = s.decision;
    if (s.drives == 0) continue;
    const double drives = s.drives;
    trial.proposed = true;
    trial.success = s.completed / drives;
    trial.stops = s.stops / drives;
    trial.embedded = s.embedded / drives;
    trial.length_m = s.length_m;
    trial.hours = s.mean_duration_s / 3600.0;
  }
  for (auto& [world, by_planner] : trials) {
    const Trial& first = by_planner[std::string(world_planners()[0].name)];
    for (auto& [name, trial] : by_planner) {
      // Without a route of its own, the drive that could have been is the first planner's.
      const Trial& drive = trial.proposed ? trial : first;
      const bool refused = !trial.proposed || trial.decision == "no_go";
      trial.over_cautious = refused && drive.proposed && drive.success > kSucceeds ? 1.0 : 0.0;
    }
  }
  return trials;
}

struct Figure {
  const char* name;
  double Trial::*value;
  double scale;
  int digits;
  bool without_route;  // whether worlds count in which the planner proposed no route
};
constexpr Figure kFigures[] = {
    {"success %", &Trial::success, 100.0, 1, false},
    {"stops a drive", &Trial::stops, 1.0, 2, false},
    {"embedded %", &Trial::embedded, 100.0, 1, false},
    {"over-cautious %", &Trial::over_cautious, 100.0, 1, true},
    {"length m", &Trial::length_m, 1.0, 1, false},
    {"hours", &Trial::hours, 1.0, 2, false},
};

std::string with_interval(double value, const Interval& interval, int digits, bool sign) {
  return sign ? fmt::format("{:+.{}f} ({:+.{}f} to {:+.{}f})", value, digits, interval.low, digits,
                            interval.high, digits)
              : fmt::format("{:.{}f} ({:.{}f} to {:.{}f})", value, digits, interval.low, digits,
                            interval.high, digits);
}

std::string mean_in_words(const std::vector<double>& values, int digits, bool sign) {
  if (values.empty()) return "-";
  double mean = 0.0;
  for (const double value : values) mean += value / static_cast<double>(values.size());
  return with_interval(mean, mean_interval(values, kLevel, kDraws, kSeed), digits, sign);
}

void add_planner(const Trials& trials, const std::string& name, Report& report) {
  std::size_t proposed = 0, go = 0, no_go = 0;
  std::vector<std::vector<double>> values(std::size(kFigures));
  for (const auto& [world, by_planner] : trials) {
    const auto found = by_planner.find(name);
    if (found == by_planner.end()) continue;
    const Trial& trial = found->second;
    proposed += trial.proposed ? 1 : 0;
    go += trial.decision == "go" ? 1 : 0;
    no_go += trial.decision == "no_go" ? 1 : 0;
    for (std::size_t k = 0; k < std::size(kFigures); ++k)
      if (trial.proposed || kFigures[k].without_route)
        values[k].push_back(kFigures[k].scale * trial.*kFigures[k].value);
  }
  std::vector<std::string> row{name, fmt::format("{} of {}", proposed, trials.size()),
                               fmt::format("{} / {}", go, no_go)};
  for (std::size_t k = 0; k < std::size(kFigures); ++k)
    row.push_back(mean_in_words(values[k], kFigures[k].digits, false));
  report.rows.push_back(std::move(row));
}

struct Pair {
  Trial first, other;
};

// The worlds in which both proposed a route.
std::vector<Pair> pairs_of(const Trials& trials, const std::string& first, const std::string& other) {
  std::vector<Pair> pairs;
  for (const auto& [world, by_planner] : trials) {
    const auto a = by_planner.find(first), b = by_planner.find(other);
    if (a == by_planner.end() || b == by_planner.end()) continue;
    if (a->second.proposed && b->second.proposed) pairs.push_back({a->second, b->second});
  }
  return pairs;
}

void add_differences(const std::vector<Pair>& pairs, const std::string& name, Report& report) {
  std::vector<std::string> row{name, fmt::format("{} pairs", pairs.size()), "-"};
  for (const Figure& figure : kFigures) {
    std::vector<double> values;
    for (const Pair& pair : pairs)
      values.push_back(figure.scale * (pair.other.*figure.value - pair.first.*figure.value));
    row.push_back(mean_in_words(values, figure.digits, true));
  }
  report.rows.push_back(std::move(row));
}

// The ratio of two sums over worlds, with its interval; empty where the first planner's sum is 0.
std::optional<std::string> ratio_in_words(const std::vector<Pair>& pairs, double Trial::*value) {
  const auto ratio = [&](std::span<const std::size_t> drawn) {
    double first = 0.0, other = 0.0;
    for (const std::size_t k : drawn) {
      first += pairs[k].first.*value;
      other += pairs[k].other.*value;
    }
    return first > 0.0 ? other / first : 1.0;
  };
  std::vector<std::size_t> all;
  double sum = 0.0;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    all.push_back(k);
    sum += pairs[k].first.*value;
  }
  if (sum <= 0.0) return std::nullopt;
  return with_interval(ratio(all), bootstrap_interval(pairs.size(), ratio, kLevel, kDraws, kSeed), 2, false);
}

std::string aim_words(const std::vector<Pair>& pairs, const std::string& first, const std::string& other) {
  const auto embedded = ratio_in_words(pairs, &Trial::embedded),
             length = ratio_in_words(pairs, &Trial::length_m);
  if (!embedded || !length)
    return fmt::format("{} against {}: nothing was embedded on the way of the latter.", other, first);
  return fmt::format(
      "{} against {}, as ratios with 90 % intervals: embeddings {}, length {}. The aim for a planner that "
      "knows the risk is at most 0.5 at a length of less than 1.10.",
      other, first, *embedded, *length);
}

}  // namespace

Report planners_report(const std::vector<WorldScore>& scores) {
  const Trials trials = trials_of(scores);
  const std::string first(world_planners()[0].name);
  int drives = 0;
  for (const WorldScore& s : scores) drives = std::max(drives, s.drives);
  Report report;
  report.title = "Planners in worlds whose truth is known";
  report.source = fmt::format(
      "{} seeded worlds of 96 x 96 m (validation/worlds): fractal ground, craters with walls of 10 to 20 "
      "deg, "
      "ten classes of soil, a third of the area hidden from the map. Each planner's best route is executed "
      "on "
      "{} draws of the ground that no planner saw; slip is checked every 20 m. Means over worlds with 90 % "
      "intervals (bootstrap over worlds). Blind: nothing is fitted to executions",
      trials.size(), drives);
  report.columns = {"planner", "proposed", "GO / NO-GO"};
  for (const Figure& figure : kFigures) report.columns.emplace_back(figure.name);
  for (const WorldPlanner& planner : world_planners()) add_planner(trials, std::string(planner.name), report);
  for (const WorldPlanner& planner : world_planners().subspan(1)) {
    const std::string other(planner.name);
    const std::vector<Pair> pairs = pairs_of(trials, first, other);
    if (pairs.empty()) continue;
    add_differences(pairs, fmt::format("{} less {}", other, first), report);
    report.notes.push_back(aim_words(pairs, first, other));
  }
  for (const WorldPlanner& planner : world_planners())
    report.notes.push_back(fmt::format("{}: {}.", planner.name, planner.summary));
  report.notes.emplace_back(
      "Success is a drive without a stop and without an embedding; a drive goes on after a stop. "
      "Over-cautious "
      "is a planner that proposes no route, or whose route gets a NO-GO, although more than 90 % of the "
      "executions succeed (of its route; where it has none, of the first planner's).");
  report.notes.emplace_back(
      "Ground, soils and outcome are by the model that plans, so that this judges decisions and not physics. "
      "The planners' beliefs about the classes are right; about hidden ground they take one soil for each "
      "unit "
      "of some 100 m, and it changes every 16 m. The page counts data/validation/worlds_scores.csv, which "
      "slipway worlds --csv made.");
  report.bands = {{"worlds", static_cast<double>(trials.size()), 20.0, 1e6}};
  return report;
}

Result<Report> worlds(const std::filesystem::path& data) {
  return read_world_scores(data / "validation" / "worlds_scores.csv").map(planners_report);
}

}  // namespace slipway::validation
