#pragma once

#include <optional>

#include "planner/problem/cost_catalogue.h"
#include "planner/problem/problem.h"
#include "planner/search/ground_tables.h"

namespace slipway::planner {

// A metre driven on a slope of one kind of ground.
//
//   duration   1 / (cruise speed (1 - slip))
//   energy     of the table
//   slip       slip ratio
//   unknown    1 on unknown ground
//   stops      where slip is over its limit one each check of the slip, which is every (1 - slip)
//              slip_check_every_m of way; where the rover is immobilised one each station of a prediction
//   embedding  once per correlation length, where a wheel sinks deeper than embedding_sinkage_share of its
//              radius, or the checks are so far apart that wheels at a slip over embedding_slip_ratio dig in
//   risk       once per correlation length, where slip is over its limit
//
// in the probability that each of these is so: the same events as sim::OutcomeFollower's, to first order.
struct Metre {
  DriveFigures figures;
  // How near it comes to the limits of slip, current, sinkage and tilt, as a share of the nearest; on the
  // mean soil, on unknown ground on its weak one.
  double share_of_limits = 0.0;
};

// On the mean soil, unknown ground on its weak one. The logarithms of slip and sinkage are taken as normal
// with the spread between the mean and the weak soil's. Nothing where the mean soil's rover does not move.
std::optional<Metre> expected_metre(const PlanProblem& problem, const GroundTable& table, bool unknown,
                                    double pitch_rad, double roll_rad);

// What a metre costs in the mean of the dearest `tail` share of the soils that the ground may have
// (GroundTable::likely, which must not be empty). Where one of them holds the rover, the metre is not driven
// and counts as on the mean soil, as in figures_of() of a draw.
double tail_cost_of_metre(const PlanProblem& problem, const GroundTable& table, bool unknown,
                          double pitch_rad, double roll_rad, const Weights& weights, double tail);

}  // namespace slipway::planner
