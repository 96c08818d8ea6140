#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "api/files/drive_outcomes.h"
#include "api/service.h"
#include "api/service_drives.h"
#include "core/progress.h"
#include "planner/predict_path.h"
#include "research/validation/mars/comparisons.h"

namespace slipway::validation {
namespace {

constexpr int kDraws = 100;
constexpr int kAllSols = 1'000'000;

// How one drive was judged by one reading of the map.
struct Scored {
  int sol = 0;
  bool stopped = false;
  double length_m = 0.0, mean_slip = 0.0;
  double as_of = 0.0, without = 0.0, with_all = 0.0, embedding = 0.0;  // probabilities of not being completed
  // As of its sol along the planned ground: the driven line, and of a stopped drive the ground beyond it.
  double planned = 0.0;
  double all_longer = 0.0;  // the same with every drive as much longer, stopped or not
};

// A way to ask: which of the terrain's legends, and the commanded limit of slip.
struct Asked {
  std::string legend;
  double max_slip = 0.4;
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
                                     const Asked& asked, std::optional<int> as_of_sol) {
  api::CheckRequest request;
  request.terrain = "gale";
  request.rover = "msl-class";
  request.path = path;
  request.drive.draws = kDraws;
  request.drive.as_of_sol = as_of_sol;
  request.drive.legend = asked.legend;
  request.drive.limits.max_slip_ratio = asked.max_slip;
  planner::watch_as_past_drives(request.drive.limits, request.drive.checks);
  NoProgress progress;
  auto answer = api::run_check(service, request, progress);
  if (!answer) return fail(answer.error());
  return std::move(answer->prediction);
}

// A stopped drive did not come as far as was planned: it goes on straight, in the direction from its first
// place to its last.
std::vector<planner::Waypoint> extended(std::vector<planner::Waypoint> path, double by_m) {
  const planner::Waypoint &first = path.front(), &last = path.back();
  const double across_m = std::hypot(last.x_m - first.x_m, last.y_m - first.y_m);
  const planner::Waypoint end{last.x_m + by_m * (last.x_m - first.x_m) / across_m,
                              last.y_m + by_m * (last.y_m - first.y_m) / across_m,
                              {}};
  path.push_back(end);
  return path;
}

// Of the stopped drives a report gives the planned length of one alone: 19 m on sol 978, of which 1.7 were
// driven. The others are taken to have had as much ground before them when they were stopped.
constexpr double kBeyond_m = 17.3;

std::string percent(double share) {
  return fmt::format("{:.0f} %", 100.0 * share);
}

// All drives of the table, in the order of their sols; what each prediction knows is cut before the drive's
// sol, left out, or all of the table.
Result<std::vector<Scored>> score_drives(const api::Service& service, const Asked& asked, bool as_of_alone) {
  const api::TerrainSite& site = *service.catalogue()->terrains.at("gale");
  std::vector<Scored> drives;
  std::vector<std::vector<planner::Waypoint>> paths;
  const auto each = [&](auto&& fill) -> Result<void> {
    for (std::size_t k = 0; k < drives.size(); ++k)
      if (const Result<void> done = fill(drives[k], paths[k]); !done) return done;
    return {};
  };
  // Beyond the end of a drive: what was planned of it, or as much as was planned on sol 978.
  const auto score_longer = [&](Scored& drive, const std::vector<planner::Waypoint>& path) -> Result<void> {
    drive.planned = drive.all_longer = drive.as_of;
    if (!drive.stopped && as_of_alone) return {};
    const auto answer = checked(service, extended(path, kBeyond_m), asked, drive.sol);
    if (!answer && !drive.stopped) return {};  // it leaves the map
    if (!answer) return fail(answer.error());
    drive.all_longer = 1.0 - answer->outcomes.completed.share;
    if (drive.stopped) drive.planned = drive.all_longer;
    return {};
  };
  const auto ask = [&](double Scored::*probability, auto&& as_of_sol) {
    return each([&](Scored& drive, const std::vector<planner::Waypoint>& path) -> Result<void> {
      const auto answer = checked(service, path, asked, as_of_sol(drive));
      if (!answer) return fail(answer.error());
      drive.*probability = 1.0 - answer->outcomes.completed.share;
      if (probability == &Scored::as_of) {
        drive.embedding = answer->outcomes.embedding.share;
        if (auto done = score_longer(drive, path); !done) return done;
      }
      drive.length_m = answer->length_m;
      drive.mean_slip = answer->mean_slip_ratio;
      return {};
    });
  };
  for (const api::PastDrive& past : site.outcomes().drives) {
    if (past.outcome != api::PastOutcome::kCompleted && past.outcome != api::PastOutcome::kSlipStop) continue;
    drives.push_back({.sol = past.sol, .stopped = past.outcome == api::PastOutcome::kSlipStop});
    paths.push_back(on_the_map(past, site.info().geometry.extent()));
  }
  using Sol = std::optional<int>;
  if (auto done = ask(&Scored::as_of, [](const Scored& drive) { return Sol(drive.sol); }); !done)
    return fail(done.error());
  if (as_of_alone) return drives;
  if (auto done = ask(&Scored::without, [](const Scored&) { return Sol(); }); !done)
    return fail(done.error());
  if (auto done = ask(&Scored::with_all, [](const Scored&) { return Sol(kAllSols); }); !done)
    return fail(done.error());
  return drives;
}

// The places of the three stops in the order of probability, the likeliest first.
std::string ranks_of_stops(const std::vector<Scored>& drives, double Scored::*probability) {
  std::vector<std::string> ranks;
  for (const Scored& a : drives) {
    if (!a.stopped) continue;
    const auto before = std::count_if(drives.begin(), drives.end(),
                                      [&](const Scored& b) { return b.*probability > a.*probability; });
    ranks.push_back(fmt::format("{}", before + 1));
  }
  return fmt::format("{}", fmt::join(ranks, ", "));
}

void add_scores(const std::string& how, const std::vector<Scored>& drives, bool as_of_alone, Report& report) {
  const auto add = [&](const char* mark, const char* what, double Scored::*probability) {
    const Score s = score(drives, probability);
    report.notes.push_back(fmt::format(
        "{}, {} ({}): AUC {:.2f}, Brier {:.3f}, log score {:.2f}, sum of probabilities {:.1f}, mean "
        "of the completed drives {}, ranks of the stops {}.",
        how, what, mark, s.auc, s.brier, s.log, s.sum, percent(s.of_completed),
        ranks_of_stops(drives, probability)));
  };
  add("its own outcome and later ones withheld", "as of each sol", &Scored::as_of);
  add("outcomes withheld, but that the stopped drives alone are lengthened",
      "as of each sol, planned ground beyond a stop included", &Scored::planned);
  if (as_of_alone) return;
  add("to compare with the line before: how much of it comes of lengthening stopped drives alone",
      "as of each sol, every drive lengthened by 17.3 m", &Scored::all_longer);
  add("nothing of them used", "without drives of the past", &Scored::without);
  add("fitted: each drive's own outcome is in it", "with all drives", &Scored::with_all);
}

void add_notes(const std::vector<Scored>& drives, Report& report) {
  const Score as_of = score(drives, &Scored::as_of);
  const double rate = 3.0 / static_cast<double>(drives.size());
  report.notes.push_back(fmt::format(
      "Baselines: the constant rate has AUC 0.50, Brier {:.3f} and log score 0.48; predicted mean slip alone "
      "has AUC {:.2f}, the steepest climb of 2 m 0.64, the steepest cell 0.44.",
      rate * (1.0 - rate), score(drives, &Scored::mean_slip).auc));
  report.notes.push_back(
      "Not blind: the second legend, the error of slip (0.5), the patches of 20 m, the rule that an "
      "alternative soil must carry the rover on the level, ten turns for an embedding and the pressure of "
      "msl_bedrock were chosen with these drives in view.");
  report.notes.push_back(
      "A stopped leg ends where the rover stopped, and the column of the sol scores that line alone. Planned "
      "ground "
      "goes on straight from there: on sol 978 to the 19 m that were planned, on sols 983 and 984, whose "
      "planned "
      "lengths no report gives, for as many metres more (17.3, assumed). Which drives are lengthened is "
      "known from "
      "their outcomes alone: an operator would ask for the whole planned drive of each. With three "
      "stops each pair moves an AUC by 0.03: differences under 0.2 mean little. The commanded slip limit is "
      "unknown; a check every 5 m is assumed.");
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
  Report report;
  report.title = "Which of Curiosity's drives its slip check stopped";
  report.source =
      "16 drives at Marias Pass, sols 960 to 997, three of them stopped by the check of slip: outcomes from "
      "published mission updates; each drive checked on the 1 m DEM, and scored by the probability that it "
      "is "
      "not completed";
  report.columns = {"sol",           "outcome",        "length m",       "mean slip",
                    "as of the sol", "planned ground", "no past drives", "all drives",
                    "embedding"};
  std::optional<std::vector<Scored>> shown;
  for (const api::Legend& legend : (*service)->catalogue()->terrains.at("gale")->description().legends) {
    for (const double max_slip : {0.4, 0.6, 0.7}) {
      const bool as_of_alone = max_slip > 0.4;
      const auto drives = score_drives(**service, {legend.name, max_slip}, as_of_alone);
      if (!drives) return fail(drives.error());
      add_scores(fmt::format("Legend {}, slip limit {:g}", legend.name, max_slip), *drives, as_of_alone,
                 report);
      if (!shown) shown = *drives;
    }
  }
  for (const Scored& drive : *shown) {
    report.rows.push_back({fmt::format("{}", drive.sol), drive.stopped ? "slip stop" : "completed",
                           fmt::format("{:.1f}", drive.length_m), fmt::format("{:.2f}", drive.mean_slip),
                           percent(drive.as_of), percent(drive.planned), percent(drive.without),
                           percent(drive.with_all), percent(drive.embedding)});
    report.cases.push_back(
        {fmt::format("sol {}", drive.sol), "stop", "1", drive.stopped ? 1.0 : 0.0, drive.as_of});
  }
  report.notes.push_back("The table is of the first legend at the limit of 0.4.");
  add_notes(*shown, report);
  return report;
}

}  // namespace slipway::validation
