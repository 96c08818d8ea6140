#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "planner/search/pose_sampler.h"
#include "planner/search/propose.h"

namespace slipway::planner {

// One objective that is searched.
struct Guide {
  std::string profile;
  MotionCost cost;
  std::vector<float> penalty;  // what Proposer::penalties() says
};

struct NamedPlanner {
  std::string name;
  std::unique_ptr<LegPlanner> planner;
};

// A way in the making.
struct Way {
  Pose2 at = {};
  std::vector<Motion> motions = {};
  bool found = true;

  // Empty where the leg can't be driven.
  void add(const std::vector<Motion>& leg);
};

// What searches of near and of far routes have in common: each profile is searched, then in rounds what the
// request asks for, with the bands around the routes so far made dear, until enough routes differ or the
// rounds are used up.
class Proposer {
 public:
  // `map`: that of the guides' costs.
  Proposer(const PlanProblem& problem, const TraverseMap& map, const GroundTables& tables,
           Progress& progress);
  virtual ~Proposer() = default;

 protected:
  static constexpr int kMaxRounds = 4;

  // All searches, into proposal_.
  void propose();

  // Keeps what is found under the guides; round 0 is that of the profiles.
  virtual void search(std::vector<Guide>& guides, int round) = 0;
  virtual bool found_any() const { return !proposal_.candidates.empty(); }
  // How much more a metre costs, by its place: in the bands `factor` times what it does in the first round.
  virtual std::vector<float> penalties(double factor) const = 0;

  // The profiles under the request's ranking: what round 0 searches.
  std::vector<Guide> guides_of_profiles() const;
  bool enough() const { return proposal_.different(wanted()).size() >= wanted(); }
  // Places along the routes that differ so far, without those near the places that all routes share.
  std::vector<Eigen::Vector2d> places_of_bands(double spacing_m, double reach_m) const;
  // As a candidate, where its cost under the request's own objective is finite.
  void keep(const MotionCost& asked, Candidate found);
  // A route without its cost. Where nothing holds the start's heading, it is set down as it leaves.
  Candidate route(std::vector<Motion> motions, std::string_view planner, std::string_view profile) const;
  // The straight way, which is a candidate where the request names no planners.
  Candidate straight_line() const;
  // Where the first leg begins.
  Pose2 first_pose(const TraverseMap& map, const PoseSampler& sampler) const;

  const PlanProblem& problem_;
  const TraverseMap& map_;
  const GroundTables& tables_;
  Progress& progress_;
  const std::function<bool()> cancelled_;
  const std::vector<Waypoint> places_;
  const MotionCost asked_;
  std::vector<NamedPlanner> planners_;
  Proposal proposal_;
  bool tells_unjudged_ = true;  // of the best candidate so far; a judged one is not followed by others

 private:
  std::size_t wanted() const { return static_cast<std::size_t>(problem_.routes); }
};

}  // namespace slipway::planner
