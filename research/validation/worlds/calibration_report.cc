#include <fmt/format.h>

#include <map>
#include <set>
#include <string>

#include "research/validation/report/calibration.h"
#include "research/validation/report/statistics.h"
#include "research/validation/worlds/comparisons.h"

namespace slipway::validation {
namespace {

constexpr double kLevel = 0.9;
constexpr int kDraws = 4000;
constexpr std::uint64_t kSeed = 21;

// Numbers of drives in one world.
struct Counts {
  double drives = 0.0, within = 0.0, below = 0.0;
  std::size_t routes = 0;
};

struct TruthRow {
  const char* truth;
  const char* words;
  double lowest, highest;  // the aim, in percent; none where both are 0
};
constexpr TruthRow kRows[] = {
    {"belief", "draws of the belief itself", 87.0, 93.0},
    {"other", "soils half a class off, spreads halved or doubled", 80.0, 97.0},
    {"world", "the world's patches of soil", 0.0, 0.0},
};

std::vector<WorldScore> executed_on(const std::vector<WorldScore>& scores, const std::string& truth) {
  std::vector<WorldScore> kept;
  for (const WorldScore& s : scores)
    if (s.truth == truth && s.drives > 0) kept.push_back(s);
  return kept;
}

std::vector<Counts> counts_by_world(const std::vector<WorldScore>& scores) {
  std::map<std::uint64_t, Counts> worlds;
  for (const WorldScore& s : scores) {
    Counts& counts = worlds[s.world];
    counts.drives += s.drives;
    counts.within += s.within;
    counts.below += s.below;
    ++counts.routes;
  }
  std::vector<Counts> list;
  for (const auto& [world, counts] : worlds) list.push_back(counts);
  return list;
}

// A row of the table, and the share that is covered in percent.
double add_coverage(const TruthRow& row, const std::vector<WorldScore>& scores, Report& report) {
  const std::vector<Counts> worlds = counts_by_world(executed_on(scores, row.truth));
  Counts all;
  for (const Counts& w : worlds) {
    all.drives += w.drives;
    all.within += w.within;
    all.below += w.below;
    all.routes += w.routes;
  }
  if (all.drives <= 0.0) return 0.0;
  const auto covered = [&](std::span<const std::size_t> drawn) {
    double within = 0.0, drives = 0.0;
    for (const std::size_t k : drawn) {
      within += worlds[k].within;
      drives += worlds[k].drives;
    }
    return 100.0 * within / drives;
  };
  const double share = 100.0 * all.within / all.drives;
  const Interval interval = bootstrap_interval(worlds.size(), covered, kLevel, kDraws, kSeed);
  const bool aimed = row.highest > 0.0;
  report.rows.push_back({row.words, fmt::format("{}", worlds.size()), fmt::format("{}", all.routes),
                         fmt::format("{:.0f}", all.drives),
                         fmt::format("{:.1f} ({:.1f} to {:.1f})", share, interval.low, interval.high),
                         fmt::format("{:.1f}", 100.0 * all.below / all.drives),
                         fmt::format("{:.1f}", 100.0 * (all.drives - all.within - all.below) / all.drives),
                         aimed ? fmt::format("{:.0f} to {:.0f}: {}", row.lowest, row.highest,
                                             share >= row.lowest && share <= row.highest ? "met" : "MISSED")
                               : "none"});
  return share;
}

struct Event {
  const char* name;
  double WorldScore::*predicted;
  int WorldScore::*count;
};
constexpr Event kEvents[] = {{"stop", &WorldScore::stop, &WorldScore::stopped},
                             {"embedding", &WorldScore::embedding, &WorldScore::embedded}};
constexpr double kEdges[] = {0.0, 0.01, 0.05, 0.1, 0.2, 0.4, 0.6, 0.8, 0.9, 1.0};

Calibration calibrated(const Event& event, const std::vector<WorldScore>& scores) {
  std::vector<PredictedShare> shares;
  for (const WorldScore& s : scores)
    shares.push_back(
        {s.*event.predicted, static_cast<double>(s.*event.count), static_cast<double>(s.drives)});
  return calibration_of(shares, kEdges);
}

void add_bins(const Event& event, const Calibration& on_belief, const Calibration& on_worlds,
              Report& report) {
  for (const ReliabilityBin& bin : on_belief.bins) {
    for (const ReliabilityBin& other : on_worlds.bins) {
      if (other.lowest != bin.lowest) continue;
      report.rows.push_back({event.name, fmt::format("{:g} to {:g}", 100.0 * bin.lowest, 100.0 * bin.highest),
                             fmt::format("{}", bin.predictions), fmt::format("{:.1f}", 100.0 * bin.predicted),
                             fmt::format("{:.1f}", 100.0 * bin.came_about),
                             fmt::format("{:.1f}", 100.0 * other.came_about)});
    }
  }
}

std::string score_words(const Event& event, const char* truth, const Calibration& c) {
  return fmt::format(
      "Probability of {} on {}: {:.1f} % of the drives; Brier {:.4f} (the share of all drives as every "
      "prediction: {:.4f}), expected calibration error {:.3f}.",
      event.name, truth, 100.0 * c.share, c.brier, c.constant_brier, c.expected_error);
}

// The bins of which more came about than the highest probability in them.
std::string bin_misses(const Event& event, const Calibration& c) {
  std::string misses;
  for (const ReliabilityBin& bin : c.bins)
    if (bin.came_about > bin.highest)
      misses += fmt::format("{}{:.1f} % where {:g} to {:g} % was said", misses.empty() ? "" : ", ",
                            100.0 * bin.came_about, 100.0 * bin.lowest, 100.0 * bin.highest);
  return fmt::format("Misses on the world's patches, {}: {}.", event.name, misses.empty() ? "none" : misses);
}

}  // namespace

Report slip_report(const std::vector<WorldScore>& scores) {
  Report report;
  report.title = "The 90 % interval of a route's mean slip, in worlds whose truth is known";
  report.source =
      "routes of all planners in the seeded worlds, predicted with 272 draws and executed on others; "
      "coverage "
      "with 90 % intervals (bootstrap over worlds). Blind: no interval is corrected by an execution";
  report.columns = {"executed on", "worlds", "routes", "drives", "covered %", "below %", "above %", "aim %"};
  std::map<std::string, double> covered;
  for (const TruthRow& row : kRows) covered[row.truth] = add_coverage(row, scores, report);
  report.notes.emplace_back(
      "The interval is from the 5th to the 95th percentile of the draws' own means of slip over the way, of "
      "a "
      "drive that is immobilised over the way to there. Drives of one world share its ground and its routes "
      "share places, so that worlds are resampled and not drives.");
  report.notes.emplace_back(
      "On the world's patches hidden ground changes every 16 m, while the belief takes one soil for a unit "
      "of "
      "some 100 m, so that a drive meets more of the ten classes than its draws do.");
  report.bands = {{"coverage on draws of the belief, %", covered["belief"], 80.0, 97.0}};
  return report;
}

Report reliability_report(const std::vector<WorldScore>& scores) {
  const std::vector<WorldScore> belief = executed_on(scores, "belief"), worlds = executed_on(scores, "world");
  Report report;
  report.title = "Predicted and executed shares of stops and embeddings, in worlds whose truth is known";
  report.source = fmt::format(
      "{} routes of all planners in the seeded worlds, each executed on draws of the belief with other keys "
      "than the prediction's, and on the world's patches of soil. Blind: nothing is fitted to executions",
      belief.size());
  report.columns = {"event",
                    "predicted %",
                    "routes",
                    "predicted, mean %",
                    "executed on the belief %",
                    "executed on patches %"};
  if (belief.empty() || worlds.empty()) return report;
  std::vector<api::Chart> charts;
  for (const Event& event : kEvents) {
    const Calibration on_belief = calibrated(event, belief), on_worlds = calibrated(event, worlds);
    add_bins(event, on_belief, on_worlds, report);
    report.notes.push_back(score_words(event, "draws of the belief", on_belief));
    report.notes.push_back(score_words(event, "the world's patches", on_worlds));
    report.notes.push_back(bin_misses(event, on_worlds));
    report.bands.push_back(
        {fmt::format("expected calibration error of {} on draws of the belief", event.name),
         on_belief.expected_error, 0.0, 0.1});
    charts.push_back(reliability_chart(fmt::format("{}, on draws of the belief", event.name), on_belief));
    charts.push_back(reliability_chart(fmt::format("{}, on patches", event.name), on_worlds));
  }
  report.plot = api::draw_charts(report.title, charts);
  return report;
}

Result<Report> worlds_slip(const std::filesystem::path& data) {
  return read_world_scores(data / "validation" / "worlds_scores.csv").map(slip_report);
}

Result<Report> worlds_reliability(const std::filesystem::path& data) {
  return read_world_scores(data / "validation" / "worlds_scores.csv").map(reliability_report);
}

}  // namespace slipway::validation
