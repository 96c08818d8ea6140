#include "planner/judge/displaced_starts.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "core/angle.h"
#include "core/parallel_for.h"
#include "core/random.h"
#include "planner/judge/drive_verdict.h"
#include "planner/judge/route_stations.h"
#include "planner/problem/terrain_ground.h"

namespace slipway::planner {
namespace {

constexpr unsigned kSizes = 6;

// The k-th number of van der Corput's sequence, in (0, 1) from k = 1 on [Halton 1960].
double radical_inverse(unsigned k, unsigned base) {
  double value = 0.0, digit = 1.0;
  for (; k > 0; k /= base) {
    digit /= base;
    value += digit * (k % base);
  }
  return value;
}

// Sizes of a normal error, with a root mean square of 1.
std::array<double, kSizes> sizes(unsigned base) {
  std::array<double, kSizes> all{};
  double squares = 0.0;
  for (unsigned k = 0; k < kSizes; ++k) {
    all[k] = normal_quantile(0.5 + 0.5 * radical_inverse(k + 1, base));
    squares += all[k] * all[k];
  }
  for (double& size : all) size /= std::sqrt(squares / kSizes);
  return all;
}

std::vector<DisplacedStart> starts_of(const StartError& error) {
  const auto ahead = sizes(2), left = sizes(3), turned = sizes(5);
  std::vector<DisplacedStart> starts(1);
  for (unsigned k = 0; k < kSizes; ++k)
    for (const double forward : {1.0, -1.0})
      for (const double side : {1.0, -1.0})
        starts.push_back({.ahead_m = forward * error.position_m * ahead[k],
                          .left_m = side * error.position_m * left[k],
                          .turned_rad = forward * side * error.heading_rad * turned[k]});
  return starts;
}

void drive_from(const PlanProblem& problem, const DriveSteps& commands, Progress& progress,
                DisplacedStart& start) {
  const std::vector<Motion> motions = command_motions(start.from(commands.start), commands.steps);
  const auto path = route_stations(motions, sim::max_station_spacing_m(*problem.rover));
  const auto drive = sim::predict_drive(*problem.rover, problem.gravity_m_s2,
                                        TerrainGround(problem.terrain, problem.soil_map), problem.beliefs,
                                        path, problem.limits, problem.risk, 1, progress, problem.conditions);
  if (!drive) {
    start.verdict = Verdict::kUnknown;
    start.broken = 1;
    start.rule = JudgedRule{.name = "ground", .verdict = Verdict::kUnknown};
    start.rule->words = drive.error().detail;
    return;
  }
  const DriveVerdict judged = judge_drive(problem, *drive, {.motions = &motions});
  start.verdict = judged.verdict;
  start.max_slip_ratio = drive->max_slip_ratio.value;
  start.broken = static_cast<std::size_t>(
      std::count_if(judged.rules.begin(), judged.rules.end(),
                    [](const JudgedRule& rule) { return rule.verdict != Verdict::kGo; }));
  std::optional<double> at_m = drive->max_slip_ratio.distance_m;
  if (judged.verdict != Verdict::kGo) {
    start.rule = judged.rules.front();
    at_m = start.rule->at_m;
  }
  if (at_m) start.at = station_at(*drive, *at_m).station.pose;
}

std::string words_of(const DisplacedStarts& starts) {
  const DisplacedStart& worst = starts.worst();
  const std::string from = fmt::format(
      "{:.2f} m {}, {:.2f} m to the {} and turned {:.1f} deg to the {}", std::abs(worst.ahead_m),
      worst.ahead_m < 0.0 ? "behind" : "ahead", std::abs(worst.left_m), worst.left_m < 0.0 ? "right" : "left",
      std::abs(deg_from_rad(worst.turned_rad)), worst.turned_rad < 0.0 ? "right" : "left");
  const std::string place =
      worst.at ? fmt::format(", at ({:.1f}, {:.1f})", worst.at->x_m, worst.at->y_m) : "";
  return fmt::format(
      "from {} of {} starts that are wrong by {:g} m and {:g} deg (1 sigma) the drive is a GO on the mean "
      "soils; "
      "worst is the one {}: {}{}",
      starts.count(Verdict::kGo), starts.starts.size(), starts.error.position_m,
      deg_from_rad(starts.error.heading_rad), from,
      worst.rule ? worst.rule->words
                 : fmt::format("a GO, with a slip of {:.2f} at most", worst.max_slip_ratio),
      place);
}

}  // namespace

std::shared_ptr<const DisplacedStarts> drive_from_displaced_starts(const PlanProblem& problem,
                                                                   const DriveSteps& commands,
                                                                   const StartError& error,
                                                                   Progress& progress) {
  PlanProblem on_means = problem;
  on_means.risk.draws = on_means.risk.max_draws = 0;
  auto displaced = std::make_shared<DisplacedStarts>();
  displaced->error = error;
  displaced->starts = starts_of(error);
  parallel_for(displaced->starts.size(), problem.threads,
               [&](std::size_t k) { drive_from(on_means, commands, progress, displaced->starts[k]); });
  if (progress.cancelled()) return nullptr;
  return displaced;
}

void judge_starts(const DisplacedStarts& starts, const sim::OutcomeBars& bars, DriveVerdict& verdict) {
  const auto all = static_cast<double>(starts.starts.size());
  JudgedRule rule{.name = "start"};
  rule.value = rule.low = rule.high = 1.0 - static_cast<double>(starts.count(Verdict::kGo)) / all;
  rule.go_below = 1.0 / all;
  rule.no_go_above = std::max(rule.go_below, bars.no_go_stop);
  // What is not known from a start is open, from however many of them.
  const double broken = static_cast<double>(starts.count(Verdict::kNoGo)) / all;
  if (rule.value > 0.0) rule.verdict = broken > rule.no_go_above ? Verdict::kNoGo : Verdict::kUnknown;
  rule.words = words_of(starts);
  const bool decides = severity(rule.verdict) > severity(verdict.verdict);
  verdict.reasons.insert(decides ? verdict.reasons.begin() : verdict.reasons.end(), rule.words);
  add_rule(std::move(rule), verdict);
}

}  // namespace slipway::planner
