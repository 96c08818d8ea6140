#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/progress.h"
#include "planner/search/block_map.h"
#include "planner/search/propose.h"

namespace slipway::planner {

// What a search over any distance proposes.
struct FarProposal {
  Proposal proposal;
  // The finest cells around the candidates: of these cells are the proposal's grid ways.
  std::unique_ptr<TraverseMap> map;
  std::vector<std::string> no_way;  // why there is none, where there is none
};

// As propose_routes(), over any distance: for each profile and leg the blocks of the cheapest ways (see
// Corridor) are searched in the terrain's finest cells by GridSearch, wider where its way comes to the
// corridor's edge, and the way is pulled straight and smoothed; planners that the problem names, other than
// "grid", go from place to place on that way. Then in rounds with bands around the routes so far made dear.
// A search holds kMaxCorridorCells at the most, at some 40 bytes each.
FarProposal propose_far_routes(const PlanProblem& problem, std::span<const PlannerRow> planners,
                               const KeepOut& keep_out, const GroundTables& tables, Progress& progress);

constexpr std::size_t kMaxCorridorCells = 8'000'000;

}  // namespace slipway::planner
