#pragma once

#include <string>
#include <vector>

#include "api/requests/plan_request.h"

namespace slipway::api {

// How closely a drive is looked at.
enum class FidelityLevel {
  kQuasiStatic,
  kDynamic,  // besides the quasi-static one
};

// POST /v1/predictions: what do the wheels do on this path?
struct PredictionRequest {
  std::string terrain;
  std::string rover;
  std::vector<planner::Waypoint> path;  // corners, joined by turns in place and straight drives
  planner::Manner manner;
  FidelityLevel level = FidelityLevel::kQuasiStatic;
  DriveAssumptions drive;
};

}  // namespace slipway::api
