#include "api/ground_evidence.h"

#include <cmath>

#include "planner/predict_path.h"

namespace slipway::api {
namespace {

// The longest run of corners that lie on the terrain with room for the rover around them.
std::vector<planner::Waypoint> on_the_map(const planner::PlanProblem& problem,
                                          const std::vector<planner::Waypoint>& path) {
  const double reach = 2.0 * problem.rover->body_width_m;
  std::vector<planner::Waypoint> longest, run;
  for (const planner::Waypoint& corner : path) {
    bool inside = true;
    for (const double dx : {-reach, 0.0, reach})
      for (const double dy : {-reach, 0.0, reach})
        inside = inside && problem.terrain->height_m(corner.x_m + dx, corner.y_m + dy).has_value();
    if (inside) run.push_back(corner);
    if (!inside || &corner == &path.back()) {
      if (run.size() > longest.size()) longest = run;
      run.clear();
    }
  }
  return longest;
}

bool counts(const PastDrive& drive, int as_of_sol) {
  return drive.sol < as_of_sol && drive.outcome != PastOutcome::kNoReport;
}

double effective(const std::vector<double>& weights, double power) {
  double sum = 0.0, squares = 0.0;
  for (const double weight : weights) {
    sum += std::pow(weight, power);
    squares += std::pow(weight, 2.0 * power);
  }
  return sum * sum / squares;
}

// Raises the weights to the largest power up to 1 that leaves kMinEffective of the draws effective, and
// scales them to a mean of 1. The effective number.
double flatten(std::vector<double>& weights) {
  const double wanted = kMinEffective * static_cast<double>(weights.size());
  double low = 0.0, high = 1.0;
  double power = 1.0;
  if (effective(weights, 1.0) < wanted) {
    constexpr int kHalvings = 40;
    for (int k = 0; k < kHalvings; ++k) {
      power = 0.5 * (low + high);
      (effective(weights, power) < wanted ? high : low) = power;
    }
    power = low;
  }
  double sum = 0.0;
  for (double& weight : weights) sum += weight = std::pow(weight, power);
  for (double& weight : weights) weight *= static_cast<double>(weights.size()) / sum;
  return effective(weights, 1.0);
}

}  // namespace

std::vector<planner::Waypoint> places_of(const DriveOutcomeTable& table, int as_of_sol) {
  std::vector<planner::Waypoint> places;
  for (const PastDrive& drive : table.drives)
    if (counts(drive, as_of_sol)) places.insert(places.end(), drive.path.begin(), drive.path.end());
  return places;
}

Result<GroundEvidence> weigh_draws(const planner::PlanProblem& problem, const DriveOutcomeTable& table,
                                   int as_of_sol, Progress& progress) {
  GroundEvidence evidence;
  std::vector<double> weights(static_cast<std::size_t>(problem.risk.draws), 1.0);
  for (const PastDrive& drive : table.drives) {
    if (!counts(drive, as_of_sol)) continue;
    const std::vector<planner::Waypoint> path = on_the_map(problem, drive.path);
    if (path.size() < 2) continue;
    const auto outcomes = planner::drawn_outcomes(problem, path, progress);
    if (!outcomes) {
      if (outcomes.error().code == ErrorCode::kCancelled) return fail(outcomes.error());
      continue;  // a wheel of this rover meets ground that is not known
    }
    const bool stopped = drive.outcome == PastOutcome::kSlipStop;
    for (std::size_t d = 0; d < weights.size(); ++d) {
      const bool stops = (*outcomes)[d].stopped || (*outcomes)[d].embedded;
      weights[d] *= stops == stopped ? 1.0 - kModelError : kModelError;
    }
    ++evidence.drives;
  }
  evidence.effective_draws = flatten(weights);
  evidence.weights = std::make_shared<const std::vector<double>>(std::move(weights));
  return evidence;
}

}  // namespace slipway::api
