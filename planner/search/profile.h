#pragma once

#include <span>
#include <string_view>

#include "planner/problem/problem.h"

namespace slipway::planner {

// What a search is asked to minimise. Routes are always ranked by the request's own weights; the other
// profiles only make different proposals.
struct Profile {
  std::string_view name;
  std::string_view summary;
  Weights (*weights)(const Weights& asked);
};

std::span<const Profile> profiles();

}  // namespace slipway::planner
