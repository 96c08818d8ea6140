#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/progress.h"
#include "core/result.h"
#include "sim/rover/rover_model.h"
#include "sim/soil/soil.h"
#include "steps/estimate.h"
#include "steps/ground_chain.h"

namespace slipway::steps {

// A class of ground whose shares are fitted to some of the steps alone, with the belief of all ground as its
// prior.
struct GroundClassSteps {
  std::string name;
  std::string summary;
  std::vector<std::vector<ChainStep>> ways;
};

struct BeliefFitOptions {
  std::size_t candidates = 2500;              // soils that are drawn
  std::size_t on_units = 14, in_patches = 7;  // soils that are kept at most
  double patch_m = 13.0;                      // correlation length of patches
  std::size_t resamples = 40;                 // of whole sols, for intervals of the shares
  // The belief of all ground counts as this many steps on a class.
  double prior_steps = 10.0;
  std::uint64_t seed = 1;
  std::size_t threads = 0;
};

// Climbs at which soils are compared.
inline constexpr std::array kComparedClimbs_deg{-8.0, 0.0, 4.0, 8.0, 12.0, 16.0, 20.0};

struct FittedSoil {
  std::string name;
  sim::Soil soil;
  bool in_patches = false;
  Estimate share;
  double level_slip = 0.0, slip_at_8_deg = 0.0, level_sinkage_m = 0.0;
  std::array<double, kComparedClimbs_deg.size()> slips{};  // at these
};

struct FittedClass {
  std::string name, summary;
  std::vector<double> shares;  // by soil
  std::size_t steps = 0;
};

struct BeliefFit {
  std::vector<FittedSoil> soils;
  std::vector<FittedClass> classes;  // the first is all ground
  Estimate odometry_offset;          // how much odometry counts too much on ground without slip
  Estimate noise_least, noise_share;
  Estimate patch_m;
  double log_likelihood = 0.0;
  std::size_t steps = 0, ways = 0;
};

// Fits a belief of ground to measured steps: which of many soils of the wheel law, and how common each is, by
// expectation maximisation over a Markov chain along each way [Baum et al. 1970; Laird 1978 for the mixture
// whose support is fitted too]. The soils are drawn from wide ranges; those that sink by more than a quarter
// of the wheel's radius on the level, or outrun their wheels there, are left out. A soil that slips by more
// than a tenth on the level lies in patches. The offset, the noise and the patches' length have the intervals
// of the profile likelihood, the shares those of resampled ways.
//
// Errors: cancelled; kInvalidRequest where there are no steps.
Result<BeliefFit> fit_belief(const sim::RoverModel& rover, double gravity_m_s2,
                             std::span<const std::vector<ChainStep>> ways,
                             std::span<const GroundClassSteps> classes, const BeliefFitOptions& options,
                             Progress& progress);

// The fit as soils of a soil file: every kept soil, and a belief of each class that names them.
std::vector<sim::SoilDistribution> as_soils(const BeliefFit& fit, const BeliefFitOptions& options,
                                            const std::string& source);

}  // namespace slipway::steps
