#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "api/files/drive_outcomes.h"
#include "api/service.h"
#include "api/service_drives.h"
#include "core/progress.h"
#include "planner/predict_path.h"
#include "research/validation/mars/comparisons.h"

namespace slipway::validation {
namespace {

constexpr int kDraws = 200;

struct Hop {
  int sol = 0;  // at whose end the rover stood
  bool driven_line = false;
  std::vector<planner::Waypoint> path;
};

struct Predicted {
  sim::DrawnShare embedding;
  double stopped = 0.0;
  std::vector<bool> embeds;  // by the number of the draw
};

int sol_of(const api::Stop& stop) {
  for (const auto& [name, value] : stop.columns)
    if (name == "sol") return std::stoi(value);
  return 0;
}

// From each stop to the next: along the line that was driven where the table of drives has it from this stop,
// straight otherwise.
std::vector<Hop> hops_of(const api::TerrainSite& site) {
  std::vector<Hop> hops;
  const std::vector<api::Stop>& stops = site.stops();
  for (std::size_t k = 1; k < stops.size(); ++k) {
    Hop hop{sol_of(stops[k]),
            false,
            {{stops[k - 1].x_m, stops[k - 1].y_m, {}}, {stops[k].x_m, stops[k].y_m, {}}}};
    constexpr double kSamePlace_m = 2.0;
    for (const api::PastDrive& drive : site.outcomes().drives) {
      const auto apart_m = [](const planner::Waypoint& a, const planner::Waypoint& b) {
        return std::hypot(a.x_m - b.x_m, a.y_m - b.y_m);
      };
      if (drive.sol != hop.sol || apart_m(drive.path.front(), hop.path.front()) > kSamePlace_m ||
          apart_m(drive.path.back(), hop.path.back()) > kSamePlace_m)
        continue;
      hop.path = drive.path;
      hop.driven_line = true;
    }
    hops.push_back(std::move(hop));
  }
  return hops;
}

Result<Predicted> predicted(const api::Service& service, const Hop& hop, std::optional<int> as_of_sol) {
  api::CheckRequest request;
  request.terrain = "gale";
  request.rover = "msl-class";
  request.path = hop.path;
  request.drive.draws = kDraws;
  request.drive.as_of_sol = as_of_sol;
  planner::watch_as_past_drives(request.drive.limits, request.drive.checks);
  NoProgress progress;
  const auto answer = api::run_check(service, request, progress);
  if (!answer) return fail(answer.error());
  Predicted out{answer->prediction.outcomes.embedding, answer->prediction.outcomes.stop.share, {}};
  for (const sim::DrawFigures& draw : answer->prediction.drawn) out.embeds.push_back(draw.embedded);
  return out;
}

std::string percent(double share) {
  return fmt::format("{:.1f} %", 100.0 * share);
}

}  // namespace

Result<Report> curiosity_hops(const std::filesystem::path& data) {
  auto service = api::Service::open({.data = data});
  if (!service) return fail(service.error());
  Report report;
  report.title = "Curiosity between its 32 stops, never embedded";
  report.source =
      "the 32 stops of Curiosity at Marias Pass, sols 960 to 1073: each hop to the next stop checked as a "
      "drive, along "
      "the driven line where the table of drives has it, straight where not; the rover was embedded on none";
  report.columns = {"sol",
                    "line",
                    "length m",
                    "embedding, as of the sol",
                    "embedding, no past drives",
                    "stop, no past drives"};
  double never_as_of = 1.0, stops = 0.0, length_m = 0.0, worst = 0.0;
  std::vector<bool> embedded(kDraws, false);
  const std::vector<Hop> hops = hops_of(*(*service)->catalogue()->terrains.at("gale"));
  for (const Hop& hop : hops) {
    const auto as_of = predicted(**service, hop, hop.sol);
    if (!as_of) return fail(as_of.error());
    const auto without = predicted(**service, hop, std::nullopt);
    if (!without) return fail(without.error());
    double hop_m = 0.0;
    for (std::size_t k = 1; k < hop.path.size(); ++k)
      hop_m += std::hypot(hop.path[k].x_m - hop.path[k - 1].x_m, hop.path[k].y_m - hop.path[k - 1].y_m);
    for (std::size_t d = 0; d < embedded.size(); ++d) embedded[d] = embedded[d] || without->embeds[d];
    never_as_of *= 1.0 - as_of->embedding.share;
    stops += without->stopped;
    worst = std::max(worst, as_of->embedding.share);
    length_m += hop_m;
    report.rows.push_back({fmt::format("{}", hop.sol), hop.driven_line ? "driven" : "straight",
                           fmt::format("{:.1f}", hop_m), percent(as_of->embedding.share),
                           percent(without->embedding.share), percent(without->stopped)});
  }
  const auto lost = static_cast<double>(std::count(embedded.begin(), embedded.end(), true));
  const double never = 1.0 - lost / kDraws;
  report.notes.push_back(fmt::format(
      "Probability that the rover is embedded on none of {} hops over {:.0f} m: {} by the draws of {} "
      "grounds, each of "
      "which all hops drive (no drive counts as evidence); {} as the product over the hops, each as of its "
      "sol.",
      hops.size(), length_m, percent(never), kDraws, percent(never_as_of)));
  report.notes.push_back(
      fmt::format("Largest probability on one hop as of its sol: {}; expected number of hops with a "
                  "stop without past drives: {:.1f}. In truth three drives were stopped.",
                  percent(worst), stops));
  report.notes.push_back(
      "A straight line between two stops is not where the rover drove: the drivers went round what they saw. "
      "Legend and "
      "soils were chosen with the outcomes of sols 960 to 997 in view.");
  report.bands = {{"hops", static_cast<double>(hops.size()), 31, 31},
                  {"P(never embedded), no past drives", never, 0.8, 1.0},
                  {"P(never embedded), as of each sol", never_as_of, 0.8, 1.0}};
  report.cases.push_back({"all hops", "never embedded", "1", 1.0, never_as_of});
  return report;
}

}  // namespace slipway::validation
