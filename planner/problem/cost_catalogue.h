#pragma once

#include <span>
#include <string_view>

#include "core/field.h"
#include "planner/problem/problem.h"
#include "planner/problem/route.h"

namespace slipway::planner {

// A term of a route's cost. What a route is ranked by is the sum over rows of weight times value; the search
// inside OMPL sees the same sum through the table rung, piece by piece.
struct CostTerm {
  std::string_view name;
  std::string_view summary;
  Field weight;           // its key in a request's weights, range and initial value
  std::string_view unit;  // of value(): "h", "100 Wh", ...
  double Weights::*in_weights;
  // Of a whole simulated route.
  double (*value)(const sim::DrivePrediction& prediction);
};

std::span<const CostTerm> cost_catalogue();

}  // namespace slipway::planner
