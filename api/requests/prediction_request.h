#pragma once

#include <string>
#include <vector>

#include "api/requests/plan_request.h"

namespace slipway::api {

// The fidelity level at which a drive is predicted.
enum class FidelityLevel {
  kQuasiStatic,
  kDynamic,  // in addition to the quasi-static level
};

// POST /v1/predictions asks what the wheels do on this path.
struct PredictionRequest {
  std::string terrain;
  std::string rover;
  std::vector<planner::Waypoint> path;  // corners, joined by turns in place and straight drives
  planner::Manner manner;
  std::vector<planner::Polygon> keep_out;  // a drive that enters one is a NO-GO
  std::vector<planner::Polygon> keep_in;   // as is one that leaves one of these
  FidelityLevel level = FidelityLevel::kQuasiStatic;
  DriveAssumptions drive;
};

}  // namespace slipway::api
