#pragma once

#include <optional>
#include <vector>

#include "core/progress.h"
#include "planner/problem/problem.h"
#include "sim/quasi_static/slip_table.h"

namespace slipway::planner {

// The slip table of one of the soils that a kind of ground may have.
struct LikelyTable {
  sim::SlipTable slip;
  double weight = 1.0;
};

// Slip tables of one kind of ground: for the mean soil, and for one that is one standard deviation weaker.
struct GroundTable {
  sim::SlipTable mean;
  sim::SlipTable weak;
  double correlation_length_m = 5.0;
  // The soils that it may have, see sim::likely_soils: of ground with alternatives, and of all ground where
  // routes are ranked by CVaR. Empty elsewhere: mean and weak then say enough of a mean.
  std::vector<LikelyTable> likely = {};
};

// Tables per soil of the beliefs, and for unknown ground. Built once per problem, in parallel; of no use
// where it was cancelled.
struct GroundTables {
  std::vector<std::optional<GroundTable>>
      known;  // in the beliefs' order; nothing for a soil that lies nowhere
  std::optional<GroundTable> unknown;
};

GroundTables build_ground_tables(const PlanProblem& problem, const Progress& progress = NoProgress{});

// One standard deviation from the mean towards weakness, in equal parts less stiffness, cohesion and friction
// and more shear before the thrust is there.
sim::Soil weak_soil(const sim::SoilDistribution& belief);

}  // namespace slipway::planner
