#pragma once

#include <span>
#include <string_view>

#include "core/field.h"
#include "sim/prediction/drive_prediction.h"

namespace slipway::planner {

// What a drive, or any stretch of one, adds up to. A predicted drive has these figures as a whole; the search
// has them of a metre on each slope of each soil and of a turn in place. A cost is made of nothing else, so
// what is searched and what is ranked is one sum.
struct DriveFigures {
  double length_m = 0.0;
  double turned_rad = 0.0;  // in place, without sign
  double duration_s = 0.0;
  double energy_j = 0.0;          // of the drive motors
  double slip_length_m = 0.0;     // the slip ratio summed over the length
  double unknown_length_m = 0.0;  // driven with any wheel on unknown ground
  double expected_stops = 0.0;    // for a sol each
  // Of a whole drive the probability that it ends embedded, and that a limit is broken; of a stretch what it
  // adds to that (to first order); of one draw 0 or 1.
  double embedding = 0.0;
  double risk = 0.0;
};

// On the mean soils, with what the draws say of stops, embeddings and limits.
DriveFigures figures_of(const sim::DrivePrediction& prediction);
// In one draw. The part of the way that it does not come to counts as on the mean soils, so that no drive is
// cheap because it ended early.
DriveFigures figures_of(const sim::DrivePrediction& prediction, const sim::DrawFigures& draw);

// A term of a route's cost. Routes are searched and ranked by the sum over rows of weight times value.
struct CostTerm {
  std::string_view name;
  std::string_view summary;
  Field weight;           // its key in a request's weights, range and initial value
  std::string_view unit;  // of value(): "h", "100 Wh", ...
  // Linear in the figures: the values of a drive's stretches add up to the drive's.
  double (*value)(const DriveFigures& figures);
};

std::span<const CostTerm> cost_catalogue();

}  // namespace slipway::planner
