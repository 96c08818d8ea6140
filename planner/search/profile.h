#pragma once

#include <span>
#include <string_view>

#include "planner/problem/ranking.h"
#include "planner/problem/weights.h"

namespace slipway::planner {

// A weight of the request as a search takes it: a share of what was asked for, but at least or at most some
// weight.
struct ProfileWeight {
  std::string_view term;  // of the cost catalogue
  double share_of_asked = 0.0;
  double min = 0.0;
  double max = 1e9;
};

// What a search is asked to minimise. Routes are always ranked by the request's own weights; the other
// profiles only make different proposals. A term that a profile doesn't name keeps the request's weight.
struct Profile {
  std::string_view name;
  std::string_view summary;
  std::span<const ProfileWeight> changed;
  // What a metre costs is its mean, whatever routes are ranked by.
  bool by_mean = false;

  Weights weights(const Weights& asked) const;
};

// Those that are searched under a ranking. Ranked by CVaR, the request's own objective is the CVaR of every
// metre, and there is one row more, which proposes what a ranking by the mean would.
std::span<const Profile> profiles(const Ranking& ranking = {});

}  // namespace slipway::planner
