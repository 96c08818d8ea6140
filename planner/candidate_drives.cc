#include "planner/candidate_drives.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "planner/judge/deciding_draws.h"
#include "planner/judge/rank.h"
#include "planner/judge/route_stations.h"
#include "planner/search/overlap.h"
#include "planner/search/tell_found.h"

namespace slipway::planner {
namespace {

constexpr std::size_t kMaxSimulated = 6;  // unless more routes are asked for
constexpr std::size_t kMaxMore = 6;       // where these are not enough
constexpr double kLineSpacing_m = 0.25;
// A candidate that shares more of its length than this with one that is simulated anyway adds nothing.
constexpr double kSameRoute = 0.9;

// The cheapest candidate of a planner; nothing where it has none.
std::optional<std::size_t> cheapest_of(const Proposal& proposal, const std::vector<std::size_t>& by_cost,
                                       std::string_view planner) {
  for (const std::size_t i : by_cost)
    if (proposal.candidates[i].planner == planner) return i;
  return std::nullopt;
}

bool is_copy(const Proposal& proposal, std::size_t i, const std::vector<std::size_t>& list) {
  return std::any_of(list.begin(), list.end(), [&](std::size_t other) {
    return other == i || proposal.differences.shared(i, other) > kSameRoute;
  });
}

bool are_same(const std::vector<Motion>& some, const std::vector<Motion>& others) {
  return std::equal(some.begin(), some.end(), others.begin(), others.end(),
                    [](const Motion& a, const Motion& b) {
                      return a.from == b.from && a.to == b.to && a.length_m == b.length_m &&
                             a.curvature_1_m == b.curvature_1_m && a.first_turn_rad == b.first_turn_rad &&
                             a.last_turn_rad == b.last_turn_rad;
                    });
}

}  // namespace

std::vector<std::size_t> shortlist(const Proposal& proposal, std::size_t wanted, bool with_spare) {
  const std::vector<std::size_t> order = proposal.by_cost();
  std::vector<std::size_t> list = proposal.different(wanted);
  const bool enough = list.size() == wanted;
  const std::size_t most = std::max(kMaxSimulated, wanted);
  const std::size_t spare = enough ? std::min(most, list.size() + 1) : most;
  for (const std::size_t i : order) {
    if ((enough && !with_spare) || list.size() >= spare) break;
    if (!is_copy(proposal, i, list)) list.push_back(i);
  }
  for (const std::string_view planner : {kStraightPlanner, kGridPlanner}) {
    const auto i = cheapest_of(proposal, order, planner);
    if (i && std::find(list.begin(), list.end(), *i) == list.end()) list.push_back(*i);
  }
  return list;
}

std::optional<std::size_t> next_candidate(const Proposal& proposal, const std::vector<std::size_t>& list) {
  if (list.size() >= kMaxSimulated + kMaxMore) return std::nullopt;
  for (const std::size_t i : proposal.by_cost())
    if (!is_copy(proposal, i, list)) return i;
  return std::nullopt;
}

bool CandidateDrives::enough() const {
  return differing(ranked(those_that_may_go())).size() >= static_cast<std::size_t>(problem_.routes);
}

void CandidateDrives::look(const Candidate& candidate, Progress& progress) {
  if (auto drive = simulated(candidate, progress)) looked_at_.push_back(*std::move(drive));
}

Result<void> CandidateDrives::drive(const Candidate& candidate, Progress& progress) {
  const auto looked_at = std::find_if(looked_at_.begin(), looked_at_.end(), [&](const Driven& d) {
    return are_same(d.motions, candidate.motions);
  });
  Result<Driven> found = Driven();
  if (looked_at == looked_at_.end()) {
    found = simulated(candidate, progress);
  } else {
    found = std::move(*looked_at);
    looked_at_.erase(looked_at);
  }
  if (progress.cancelled()) return fail(ErrorCode::kCancelled, "the plan was cancelled");
  if (!found) {
    // Mostly a wheel that the body's circle does not cover met a missing cell.
    unpredicted_.push_back(found.error());
    return {};
  }
  if (found->in_keep_out) {
    in_keep_out_.push_back(*found->in_keep_out);
    return {};
  }
  found->route.planner = candidate.planner;
  found->route.profile = candidate.profile;
  const DriveSteps& commands = found->route.commands;
  differences_.add(centreline(command_motions(commands.start, commands.steps), kLineSpacing_m));
  driven_.push_back(*std::move(found));
  return {};
}

Result<CandidateDrives::Driven> CandidateDrives::simulated(const Candidate& candidate, Progress& progress) {
  Driven drive;
  drive.motions = candidate.motions;
  drive.route.commands = route_commands(problem_, candidate.motions);
  const auto motions = command_motions(drive.route.commands.start, drive.route.commands.steps);
  drive.stations = route_stations(motions, sim::max_station_spacing_m(*problem_.rover));
  drive.length_m = drive.stations.back().distance_m;
  drive.in_keep_out = inside_keep_out(motions, drive.stations);
  if (drive.in_keep_out) return drive;
  sim::RiskOptions risk = risk_of(drive);
  if (problem_.ranking_draws > 0) risk.draws = std::min(risk.draws, problem_.ranking_draws);
  risk.max_draws = 0;
  Result<sim::DrivePrediction> prediction = predict(drive, risk, progress);
  if (!prediction) return fail(prediction.error());
  drive.route.prediction = std::move(*prediction);
  judge(problem_, drive.route);
  const auto is_better = [&](const Driven& other) {
    return !other.in_keep_out && ranks_before(other.route, drive.route);
  };
  if (std::none_of(driven_.begin(), driven_.end(), is_better) &&
      std::none_of(looked_at_.begin(), looked_at_.end(), is_better))
    tell_found(progress, motions, drive.route.cost, describe(drive.route.verdict()));
  return drive;
}

Result<std::vector<Route>> CandidateDrives::choose(Progress& progress) {
  const std::vector<std::size_t> may_go = those_that_may_go();
  if (auto decided = decide_first(may_go, progress); !decided) return fail(decided.error());
  const std::vector<std::size_t> chosen = differing(ranked(may_go));
  for (const std::size_t i : chosen) {
    Driven& drive = driven_[i];
    auto final = predict(drive, risk_of(drive), progress);
    if (progress.cancelled()) return fail(ErrorCode::kCancelled, "the plan was cancelled");
    if (!final) return fail(final.error());
    const bool has_more = final->draws >= drive.route.prediction.draws;
    drive.route.prediction = std::move(*final);
    if (has_more)
      judge(problem_, drive.route);
    else
      judge_outcome(problem_, drive.route);
  }
  std::vector<std::size_t> given;
  for (const std::size_t i : chosen)
    if (!is_no_go(driven_[i].route)) given.push_back(i);
  if (given.empty()) given = chosen;
  std::vector<Route> routes;
  for (const std::size_t i : ranked(given)) routes.push_back(driven_[i].route);
  return routes;
}

const Route* CandidateDrives::best_no_go() const {
  const Route* best = nullptr;
  for (const Driven& drive : driven_)
    if (is_no_go(drive.route) && (best == nullptr || ranks_before(drive.route, *best))) best = &drive.route;
  return best;
}

std::size_t CandidateDrives::no_go() const {
  return static_cast<std::size_t>(std::count_if(driven_.begin(), driven_.end(),
                                                [](const Driven& drive) { return is_no_go(drive.route); }));
}

// What is given out is tested itself, whatever the search has tested: every station, and all that the body
// sweeps between them.
std::optional<Pose2> CandidateDrives::inside_keep_out(const std::vector<Motion>& motions,
                                                      const std::vector<sim::PathStation>& stations) const {
  if (keep_out_.empty()) return std::nullopt;
  for (const sim::PathStation& station : stations)
    if (keep_out_.hits(station.pose)) return station.pose;
  return first_hit(keep_out_, motions);
}

sim::RiskOptions CandidateDrives::risk_of(const Driven& drive) const {
  return risk_of_drive(problem_.risk, drive.length_m, drive.stations.size());
}

int CandidateDrives::most_draws(const Driven& drive) const {
  const sim::RiskOptions risk = risk_of(drive);
  return std::max(risk.draws, risk.max_draws);
}

Result<sim::DrivePrediction> CandidateDrives::predict(Driven& drive, const sim::RiskOptions& risk,
                                                      Progress& progress) {
  return sim::predict_drive(*problem_.rover, problem_.gravity_m_s2, ground_, problem_.beliefs, drive.stations,
                            problem_.limits, risk, problem_.threads, progress, problem_.conditions,
                            &drive.draws);
}

// Goes on from the candidate's draws so far.
Result<void> CandidateDrives::draw(std::size_t i, int draws, Progress& progress) {
  Driven& drive = driven_[i];
  sim::RiskOptions risk = risk_of(drive);
  risk.draws = std::min(draws, most_draws(drive));
  risk.max_draws = 0;
  if (drive.route.prediction.draws >= risk.draws) return {};
  auto prediction = predict(drive, risk, progress);
  if (progress.cancelled()) return fail(ErrorCode::kCancelled, "the plan was cancelled");
  if (!prediction) return fail(prediction.error());
  drive.route.prediction = std::move(*prediction);
  judge(problem_, drive.route);
  return {};
}

std::vector<std::size_t> CandidateDrives::ranked(const std::vector<std::size_t>& of) const {
  std::vector<std::size_t> order = of;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return ranks_before(driven_[a].route, driven_[b].route);
  });
  return order;
}

// The routes that are given out of an order.
std::vector<std::size_t> CandidateDrives::differing(const std::vector<std::size_t>& order) const {
  std::vector<double> costs;
  for (const std::size_t i : order) {
    const Route& route = driven_[i].route;
    if (route.verdict() == Verdict::kNoGo) break;
    costs.push_back(route.cost);
  }
  const std::size_t leaders = std::max<std::size_t>(1, as_good_as_best(costs));
  return select_routes(differences_, order, leaders, static_cast<std::size_t>(problem_.routes));
}

// Twice as many draws for the first two until these tell which is first; who is first and who is second may
// change by it.
Result<void> CandidateDrives::decide_first(const std::vector<std::size_t>& of, Progress& progress) {
  for (;;) {
    const std::vector<std::size_t> order = ranked(of);
    if (order.size() < 2) return {};
    const std::size_t first = order[0], second = order[1];
    const Route &a = driven_[first].route, &b = driven_[second].route;
    if (order_of(a, b, problem_.ranking) != RankOrder::kUndecided) return {};
    const int most = std::min(most_draws(driven_[first]), most_draws(driven_[second]));
    const int least = std::min(a.prediction.draws, b.prediction.draws);
    if (least >= most) return {};
    const int more = std::min(most, 2 * std::max(a.prediction.draws, b.prediction.draws));
    for (const std::size_t i : {first, second})
      if (auto drawn = draw(i, more, progress); !drawn) return drawn;
  }
}

// All but the NO-GO; all where they all are.
std::vector<std::size_t> CandidateDrives::those_that_may_go() const {
  std::vector<std::size_t> all(driven_.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  std::vector<std::size_t> rest;
  std::copy_if(all.begin(), all.end(), std::back_inserter(rest),
               [&](std::size_t i) { return !is_no_go(driven_[i].route); });
  return rest.empty() ? all : rest;
}

}  // namespace slipway::planner
