#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "api/files/drive_outcomes.h"
#include "api/service.h"
#include "core/progress.h"
#include "validation/mars/comparisons.h"

namespace slipway::validation {
namespace {

constexpr int kDraws = 100;
constexpr int kAllSols = 1'000'000;

struct Scored {
  int sol = 0;
  bool stopped = false;
  double length_m = 0.0, mean_slip = 0.0;
  double as_of = 0.0, without = 0.0, with_all = 0.0, embedding = 0.0;  // probabilities of not being completed
};

// How well probabilities go with outcomes. Log scores are natural and lower is better.
struct Score {
  double auc = 0.0, brier = 0.0, log = 0.0, sum = 0.0, of_completed = 0.0;
};

Score score(const std::vector<Scored>& drives, double Scored::*probability) {
  Score out;
  double pairs = 0.0, completed = 0.0;
  for (const Scored& a : drives) {
    const double p = a.*probability, outcome = a.stopped ? 1.0 : 0.0;
    const double bounded = std::clamp(p, 1e-3, 1.0 - 1e-3);
    out.brier += (p - outcome) * (p - outcome) / static_cast<double>(drives.size());
    out.log -= std::log(a.stopped ? bounded : 1.0 - bounded) / static_cast<double>(drives.size());
    out.sum += p;
    if (!a.stopped) {
      out.of_completed += p;
      completed += 1.0;
      continue;
    }
    for (const Scored& b : drives) {
      if (b.stopped) continue;
      pairs += 1.0;
      out.auc += p > b.*probability ? 1.0 : p == b.*probability ? 0.5 : 0.0;
    }
  }
  out.auc /= std::max(pairs, 1.0);
  out.of_completed /= std::max(completed, 1.0);
  return out;
}

// The part of a drive that lies on the terrain, with room for the rover.
std::vector<planner::Waypoint> on_the_map(const api::PastDrive& drive, const dem::Extent& map) {
  constexpr double kRoom_m = 4.0;
  std::vector<planner::Waypoint> path;
  for (const planner::Waypoint& corner : drive.path)
    if (corner.x_m > map.west_m + kRoom_m && corner.x_m < map.east_m - kRoom_m &&
        corner.y_m > map.south_m + kRoom_m && corner.y_m < map.north_m - kRoom_m)
      path.push_back(corner);
  return path;
}

Result<sim::DrivePrediction> checked(const api::Service& service, const std::vector<planner::Waypoint>& path,
                                     std::optional<int> as_of_sol) {
  api::CheckRequest request;
  request.terrain = "gale";
  request.rover = "msl-class";
  request.path = path;
  request.drive.draws = kDraws;
  request.drive.as_of_sol = as_of_sol;
  NoProgress progress;
  auto answer = service.check(request, progress);
  if (!answer) return fail(answer.error());
  return std::move(answer->prediction);
}

std::string percent(double share) {
  return fmt::format("{:.0f} %", 100.0 * share);
}

std::string words(const char* what, const Score& s) {
  return fmt::format(
      "{}: AUC {:.2f}, Brier {:.3f}, log score {:.2f}, sum of probabilities {:.1f}, mean of the "
      "completed drives {}.",
      what, s.auc, s.brier, s.log, s.sum, percent(s.of_completed));
}

void add_notes(const std::vector<Scored>& drives, Report& report) {
  const Score as_of = score(drives, &Scored::as_of);
  report.notes.push_back(words("As of each sol (its own outcome and later ones withheld)", as_of));
  report.notes.push_back(
      words("Without drives of the past (nothing fitted to them)", score(drives, &Scored::without)));
  report.notes.push_back(
      words("With all drives (fitted: each drive's own outcome is in it)", score(drives, &Scored::with_all)));
  const double rate = 3.0 / static_cast<double>(drives.size());
  report.notes.push_back(fmt::format(
      "Baselines: the constant rate has AUC 0.50 and Brier {:.3f}; predicted mean slip alone has AUC {:.2f}.",
      rate * (1.0 - rate), score(drives, &Scored::mean_slip).auc));
  report.notes.push_back(
      "The aim of an AUC of 0.8 and a Brier score below the constant rate's is missed: with one metre of DEM "
      "and "
      "unit codes nobody has explained, the model does not know where ripples lie, and a long completed "
      "drive over "
      "moderate slopes gets more probability than a short stopped one. The rule that an alternative soil "
      "must carry "
      "the rover on the level, ten turns for an embedding, and the pressure of msl_bedrock were set with "
      "these "
      "drives in view.");
  report.notes.push_back(
      "A stopped leg ends where the rover stopped, so that the ground beyond it is not scored. With three "
      "stops each "
      "pair moves an AUC by 0.03: differences under 0.2 mean little. The commanded slip limit is unknown; "
      "0.4 with a "
      "check every 5 m is assumed.");
  double largest = 0.0;
  for (const Scored& drive : drives) largest = std::max(largest, drive.embedding);
  report.notes.push_back(fmt::format(
      "No drive was embedded; the largest probability of embedding as of its sol is {}.", percent(largest)));
  report.bands = {{"drives scored", static_cast<double>(drives.size()), 16, 16},
                  {"Brier score as of each sol", as_of.brier, 0.0, 0.25},
                  {"AUC as of each sol", as_of.auc, 0.3, 1.0}};
}

}  // namespace

Result<Report> curiosity_outcomes(const std::filesystem::path& data) {
  auto service = api::Service::open({.data = data});
  if (!service) return fail(service.error());
  const api::TerrainSite& site = *(*service)->catalogue().terrains.at("gale");
  Report report;
  report.title = "Which of Curiosity's drives its slip check stopped";
  report.source =
      "16 drives at Marias Pass, sols 960 to 997, three of them stopped by the check of slip: outcomes from "
      "published "
      "mission updates; each drive checked on the 1 m DEM, and scored by the probability that it is not "
      "completed";
  report.columns = {"sol",           "outcome",        "length m",   "mean slip",
                    "as of the sol", "no past drives", "all drives", "embedding"};
  std::vector<Scored> drives;
  for (const api::PastDrive& past : site.outcomes().drives) {
    if (past.outcome != api::PastOutcome::kCompleted && past.outcome != api::PastOutcome::kSlipStop) continue;
    const auto path = on_the_map(past, site.info().geometry.extent());
    const auto as_of = checked(**service, path, past.sol);
    const auto without = checked(**service, path, std::nullopt);
    const auto with_all = checked(**service, path, kAllSols);
    for (const auto* each : {&as_of, &without, &with_all})
      if (!*each) return fail(each->error());
    Scored drive;
    drive.sol = past.sol;
    drive.stopped = past.outcome == api::PastOutcome::kSlipStop;
    drive.length_m = without->length_m;
    drive.mean_slip = without->mean_slip_ratio;
    drive.as_of = 1.0 - as_of->outcomes.completed.share;
    drive.without = 1.0 - without->outcomes.completed.share;
    drive.with_all = 1.0 - with_all->outcomes.completed.share;
    drive.embedding = as_of->outcomes.embedding.share;
    drives.push_back(drive);
    report.rows.push_back({fmt::format("{}", drive.sol), drive.stopped ? "slip stop" : "completed",
                           fmt::format("{:.1f}", drive.length_m), fmt::format("{:.2f}", drive.mean_slip),
                           percent(drive.as_of), percent(drive.without), percent(drive.with_all),
                           percent(drive.embedding)});
    report.cases.push_back(
        {fmt::format("sol {}", drive.sol), "stop", "1", drive.stopped ? 1.0 : 0.0, drive.as_of});
  }
  add_notes(drives, report);
  return report;
}

}  // namespace slipway::validation
