#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "api/files/catalogue.h"
#include "core/result.h"
#include "steps/slip_step.h"
#include "steps/step_scores.h"

namespace slipway::api {

inline constexpr double kMarsGravity_m_s2 = 3.71;

struct StepComparisonRequest {
  std::string rover = "msl-class";
  std::string terrain;  // slope and soil are the map's; empty: those of the steps, on unknown ground
  std::string legend;   // of the terrain; empty: its first
  steps::StepLearning learning = steps::StepLearning::kNone;
  double gravity_m_s2 = kMarsGravity_m_s2;  // without a terrain
};

struct StepComparison {
  std::vector<steps::ScoredSol> sols;
  // For each step of the table in its order, its place in `sols`; empty where it lies off the terrain.
  struct Place {
    std::size_t sol = 0, step = 0;
  };
  std::vector<std::optional<Place>> places;
  steps::StepScores scores;
  std::vector<std::string> grounds;  // beliefs that were used
  std::size_t without_pitch = 0;     // steps without any slope, taken as level
  std::size_t off_map = 0;           // steps that are not on the terrain, left out
};

// Errors: invalid_request where the catalogue has no such rover.
Result<std::shared_ptr<const sim::RoverModel>> rover_that_made_steps(const Catalogue& catalogue,
                                                                     const std::string& name);

// The steps of one sol after another as the chain reads them. Without a terrain their slope and roll are
// their own; where none is known, level.
std::vector<std::vector<steps::ChainStep>> ways_of(std::span<const steps::SlipStep> steps);

// Forecasts every measured step and compares it with what was measured. Errors: invalid_request for a rover
// or a terrain that is not known, or on which no step lies, and those of reading it.
Result<StepComparison> compare_steps(const Catalogue& catalogue, const StepComparisonRequest& request,
                                     std::span<const steps::SlipStep> steps);

}  // namespace slipway::api
