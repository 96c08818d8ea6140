#pragma once

#include <vector>

#include "api/files/catalogue.h"
#include "planner/problem/problem.h"

namespace slipway::bench {

struct Site {
  planner::PlanProblem problem;
  std::vector<api::Stop> stops;
};

// The bundled terrain with the service's beliefs, for the rover that the command line plans for.
Site gale();

}  // namespace slipway::bench
