#pragma once

#include <utility>

#include "sim/prediction/drive_risk.h"
#include "sim/prediction/rule_catalogue.h"

namespace slipway::sim {

// A station of a path with the rover on it, on the mean soils.
struct Balanced {
  PathStation path;
  PreparedStation ready;
  StationState state;
};

// The way between two stations is halved up to three times, to some 6 cm.
inline constexpr int kMaxHalvings = 3;

// Whether a limit that both stations keep may be broken between them: one of them is near it, or comes as
// near as it if it changes on by as much as from the one to the other. What hangs on the soil is looked at
// once halfway; the ground's shape three times.
bool may_pass_a_limit(const StationRules& rules, const Balanced& from, const Balanced& to, int halvings);

// The station halfway from one to the next along their arc or turn in place, and the next one as it is
// reached from there.
std::pair<PathStation, PathStation> halved(const PathStation& from, const PathStation& to);

}  // namespace slipway::sim
