#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/progress.h"
#include "core/result.h"
#include "sim/rover/rover_model.h"

namespace slipway::validation {

struct WorldStudyOptions {
  std::uint64_t seed = 1;  // of the first world; the next have the numbers that follow
  int worlds = 40;
  int drives = 100;            // executions of each route on each kind of truth
  int planning_draws = 64;     // of the ground, by which a planner compares its candidates
  int prediction_draws = 272;  // by which each route is predicted and decided
  int routes = 2;              // of each planner
  std::size_t threads = 0;     // 0: as many as the machine has
};

// What the ground of executions is, against what planners believe.
//   world   the soils of the world's patches; hidden ones are drawn patch by patch, not unit by unit
//   belief  draws of the belief itself, with other keys than the planners'
//   other   soils and spreads that the belief does not have (see other_soils)
inline constexpr const char* kTruths[] = {"world", "belief", "other"};

// A planner's route as predicted and as executed; one row of the scores. Where a planner proposed no route,
// `route` is 0 and the rest is empty.
struct WorldScore {
  std::uint64_t world = 0;
  std::string planner;
  int route = 0;      // its rank
  std::string truth;  // of kTruths
  // Predicted, with the draws that all planners share.
  std::string decision;  // "go", "no_go", "unknown"
  double length_m = 0.0, duration_s = 0.0;
  double stop = 0.0, embedding = 0.0, expected_stops = 0.0;  // probabilities, and a mean number
  double slip_p05 = 0.0, slip_p95 = 0.0;                     // of the mean slip over the way
  // Executed: numbers of drives, and means over them.
  int drives = 0, completed = 0, stopped = 0, embedded = 0, stops = 0;
  int within = 0, below = 0;  // drives whose mean slip is in the interval, and below it
  double mean_slip = 0.0, mean_duration_s = 0.0;
};

// Plans, predicts and executes on each world, several worlds at once. Tells after each world how many are
// done. The scores are in the order of worlds, planners, routes and truths, and do not depend on the number
// of threads. Errors: those of plans and predictions; cancelled.
Result<std::vector<WorldScore>> study_worlds(const WorldStudyOptions& options,
                                             const std::shared_ptr<const sim::RoverModel>& rover,
                                             const std::function<void(int done)>& tell,
                                             const Progress& progress);

// The scores as CSV, and back. Errors of reading: unreadable_data.
std::string csv_of(const std::vector<WorldScore>& scores);
Result<std::vector<WorldScore>> read_world_scores(const std::filesystem::path& csv);

}  // namespace slipway::validation
