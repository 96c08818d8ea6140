#pragma once

#include <optional>
#include <string>
#include <vector>

#include "api/requests/check_request.h"
#include "api/requests/diagnosis_request.h"
#include "api/requests/plan_request.h"
#include "api/requests/prediction_request.h"
#include "api/requests/watch_request.h"
#include "api/steps/steps_near.h"
#include "dem/elevation_source.h"
#include "gap/diagnosis/diagnosis.h"
#include "gap/diagnosis/drive_watch.h"
#include "gap/diagnosis/model/drive_campaign.h"
#include "planner/drive_so_far_evidence.h"
#include "planner/problem/dynamic_verification.h"
#include "planner/problem/route.h"
#include "planner/problem/verdict.h"

namespace slipway::api {

// What a drive under way taught of the ground.
struct LearntDrive {
  std::vector<planner::LearntStretch> stretches;
  int draws = 0;  // that are left
  double effective_draws = 0.0;
};

// The inputs of an answer, so that it can be repeated and checked. They do not depend on time or machine.
struct Provenance {
  std::string terrain_title;
  std::string terrain_version;      // see TerrainSite::version()
  std::string terrain_fingerprint;  // of the heights in the window that was read
  std::string crs_name;
  std::string body;
  double gravity_m_s2 = 0.0;
  std::string legend;              // the name of the one by which the map was read
  std::string soil_assumption;     // why the mapped classes are assumed to be these soils
  std::vector<std::string> soils;  // by the index in the stations
  std::string unknown_soil;        // assumed where no map names a soil
  std::uint64_t seed = 1;
  std::string unseen_relief = {};  // what cells of the map's size can't show; empty: of small ones
  // Where drives of the past weigh the draws: how many, and what is left of the draws.
  std::optional<int> past_drives = {};
  double measured_m = 0.0;  // over which slip of the past was measured, that the draws take into account
  std::optional<StepsNear> measured_near = {};  // slip that was measured near the way, or the best route
  std::optional<LearntDrive> learnt = {};
  std::shared_ptr<const sim::ReliefSpread> relief = {};  // that the draws have; empty: the map's own
};

struct PlanAnswer {
  PlanRequest request;
  Provenance provenance;
  planner::Plan plan;
};

struct PredictionAnswer {
  PredictionRequest request;
  Provenance provenance;
  sim::DrivePrediction prediction;
  std::optional<planner::DynamicVerification> dynamic;  // where the dynamic level was requested
  planner::DriveVerdict decision;
};

struct CheckAnswer {
  CheckRequest request;
  Provenance provenance;
  sim::DrivePrediction prediction;
  planner::DriveVerdict decision;
};

struct DiagnosisAnswer {
  DiagnosisRequest request;
  gap::DriveCampaign campaign;
  gap::Diagnosis diagnosis;
};

struct WatchAnswer {
  gap::DriveWatch watch;
};

// The ground at one point.
struct GroundAt {
  double x_m = 0.0;
  double y_m = 0.0;
  double height_m = 0.0;
  double slope_rad = 0.0;
  double aspect_rad = 0.0;            // of steepest descent, clockwise from north
  std::optional<double> roughness_m;  // RMS distance to the plane through the cells within the radius
  double roughness_radius_m = 0.0;
  std::optional<std::string> label;  // of the mapped class
  std::optional<std::string> soil;   // empty on unknown ground
};

}  // namespace slipway::api
