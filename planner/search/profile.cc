#include "planner/search/profile.h"

#include <algorithm>
#include <array>

namespace slipway::planner {
namespace {

// What a profile puts first never weighs less than was asked for, and the rest never more: a request that
// already weighs slip by 50 gets no "least slip" search with 10. A little slip and risk stay in the shortest,
// so that a way over hopeless ground is not it.
constexpr std::array<ProfileWeight, 7> kShortest{{{"duration", 1.0, 1.0},
                                                  {"energy", 0.0},
                                                  {"slip", 0.1},
                                                  {"unknown", 0.0},
                                                  {"stops", 0.1},
                                                  {"embedding", 0.1},
                                                  {"risk", 0.1}}};
constexpr std::array<ProfileWeight, 3> kMinSlip{
    {{.term = "duration", .share_of_asked = 1.0, .max = 0.2}, {"energy", 0.2}, {"slip", 1.0, 10.0}}};
constexpr std::array<ProfileWeight, 6> kMinRisk{{{.term = "duration", .share_of_asked = 1.0, .max = 0.3},
                                                 {"energy", 0.3},
                                                 {"unknown", 1.0, 8.0},
                                                 {"stops", 1.0, 20.0},
                                                 {"embedding", 1.0, 1000.0},
                                                 {"risk", 1.0, 5.0}}};

}  // namespace

Weights Profile::weights(const Weights& asked) const {
  Weights weights = asked;
  for (const ProfileWeight& row : changed)
    weights.set(row.term, std::clamp(row.share_of_asked * asked.of(row.term), row.min, row.max));
  return weights;
}

std::span<const Profile> profiles(const Ranking& ranking) {
  static constexpr std::array<Profile, 5> kProfiles{{
      {"balanced", "the request's own weights", {}},
      {"shortest", "duration, with a tenth of the weight on slip and all risks", kShortest, true},
      {"least_slip", "slip before all else", kMinSlip, true},
      {"least_risk", "stops, embedding, risk and unknown ground before all else", kMinRisk},
      {"expected", "the request's own weights, in the mean of what each metre may cost", {}, true},
  }};
  const std::span<const Profile> all = kProfiles;
  return ranking.by == RankBy::kCvar ? all : all.first(all.size() - 1);
}

}  // namespace slipway::planner
