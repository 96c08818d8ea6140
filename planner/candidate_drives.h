#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/progress.h"
#include "core/result.h"
#include "planner/judge/route_commands.h"
#include "planner/problem/keep_out.h"
#include "planner/problem/problem.h"
#include "planner/problem/route.h"
#include "planner/problem/terrain_ground.h"
#include "planner/search/propose.h"

namespace slipway::planner {

// Which candidates of a proposal are simulated: the straight line and the cheapest way of the grid in any
// case, those that differ, and where `with_spare` the cheapest others that are no copies of these.
std::vector<std::size_t> shortlist(const Proposal& proposal, std::size_t wanted, bool with_spare);

// The cheapest candidate that is not in the list and no copy of one there: what to simulate where those in
// the list are not enough. Nothing where there is none, or the list is long.
std::optional<std::size_t> next_candidate(const Proposal& proposal, const std::vector<std::size_t>& list);

// Simulates candidates as the commands that a rover takes, ranks them by what they cost on draws of the
// ground and chooses those that are given out. Keeps references to what it is made of.
class CandidateDrives {
 public:
  CandidateDrives(const PlanProblem& problem, const TerrainGround& ground, const KeepOut& keep_out)
      : problem_(problem), ground_(ground), keep_out_(keep_out), differences_(problem.rover->body_width_m) {}

  // Simulates a candidate before there is a choice and tells of it with its verdict; drive() takes it from
  // here. What it meets is drive()'s to say.
  void look(const Candidate& candidate, Progress& progress);

  // Simulates one candidate with the first draws. Errors: cancelled.
  Result<void> drive(const Candidate& candidate, Progress& progress);

  // Draws on until the first place is decided or tied, or the most draws are reached; chooses routes that
  // differ, as many as the problem asks for, and none that is a NO-GO beside one that is not; gives each the
  // draws that a check of its commands takes; and ranks them by all the draws there are. Errors: cancelled,
  // and those of sim::predict_drive().
  Result<std::vector<Route>> choose(Progress& progress);

  // Whether as many routes as the problem asks for could be given out so far.
  bool enough() const;
  // Why candidates are not driven.
  const std::vector<Error>& unpredicted() const { return unpredicted_; }
  const std::vector<Pose2>& in_keep_out() const { return in_keep_out_; }
  // The best of those that are NO-GO; nothing where none is.
  const Route* best_no_go() const;
  // How many are.
  std::size_t no_go() const;

 private:
  struct Driven {
    Route route;
    std::vector<sim::PathStation> stations;
    double length_m = 0.0;
    sim::DrawsSoFar draws = nullptr;
    std::optional<Pose2> in_keep_out = {};  // then it is not simulated
    std::vector<Motion> motions = {};       // of the candidate
  };

  // With the first draws. Tells of it where none that was simulated is better.
  Result<Driven> simulated(const Candidate& candidate, Progress& progress);
  std::optional<Pose2> inside_keep_out(const std::vector<Motion>& motions,
                                       const std::vector<sim::PathStation>& stations) const;
  // The options of the final prediction, which are those of a check.
  sim::RiskOptions risk_of(const Driven& drive) const;
  int most_draws(const Driven& drive) const;
  Result<sim::DrivePrediction> predict(Driven& drive, const sim::RiskOptions& risk, Progress& progress);
  Result<void> draw(std::size_t i, int draws, Progress& progress);
  std::vector<std::size_t> differing(const std::vector<std::size_t>& order) const;
  std::vector<std::size_t> ranked(const std::vector<std::size_t>& of) const;
  std::size_t leaders(const std::vector<std::size_t>& order) const;
  Result<void> decide_first(const std::vector<std::size_t>& of, Progress& progress);
  std::vector<std::size_t> those_that_may_go() const;

  const PlanProblem& problem_;
  const TerrainGround& ground_;
  const KeepOut& keep_out_;
  std::vector<Driven> driven_;
  std::vector<Driven> looked_at_;
  Differences differences_;  // of the driven
  std::vector<Error> unpredicted_;
  std::vector<Pose2> in_keep_out_;
};

}  // namespace slipway::planner
