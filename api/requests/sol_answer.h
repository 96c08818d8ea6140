#pragma once

#include <optional>
#include <string>
#include <vector>

#include "api/requests/answers.h"

namespace slipway::api {

// A place of the way, and why it matters.
struct PlaceOnWay {
  double at_m = 0.0;
  double x_m = 0.0, y_m = 0.0;
  std::string why;
};

// A sol: the route that fits into the day, and what a meeting asks about it.
struct SolAnswer {
  PlanAnswer plan;  // of which the first route is driven
  // Where slip is to be checked: before each stretch on which a halt is likely enough.
  std::vector<PlaceOnWay> checks;
  std::optional<PlaceOnWay> time_runs_out;  // at the slow pace; nothing where the rover is then at the goal
  std::optional<PlaceOnWay> worst;          // where most draws halt; nothing where none does
  std::optional<CheckAnswer> back_out;      // from there back to the start, as it came
  std::string no_way_back;                  // why there is a worst place and no `back_out`
};

}  // namespace slipway::api
