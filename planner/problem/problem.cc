#include "planner/problem/problem.h"

#include <cmath>

#include "core/angle.h"

namespace slipway::planner {

double Manner::body_yaw(double travel_rad) const {
  return wrapped_rad(travel_rad - crab_rad + (backwards ? M_PI : 0.0));
}

double Manner::travel(double body_yaw_rad) const {
  return wrapped_rad(body_yaw_rad + crab_rad - (backwards ? M_PI : 0.0));
}

}  // namespace slipway::planner
