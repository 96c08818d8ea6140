#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "sim/soil/soil.h"
#include "steps/plane_slips.h"

namespace slipway::steps {

// How a measured slip scatters about the slip of the soil: Student's t with four degrees of freedom and the
// scale least + share |slip|. It holds the error of visual odometry, stones, and what changes within a step.
// The defaults were chosen on Curiosity's sols 45 to 449 by the log score of sols 450 to 997.
struct StepNoise {
  double least = 0.017;
  double share = 0.15;

  double density(double deviation, double slip) const;
  double below(double deviation, double slip) const;  // the distribution function
};

// One step as the chain reads it.
struct ChainStep {
  double pitch_rad = 0.0;  // climbing is positive
  double roll_rad = 0.0;
  double length_m = 1.0;   // by odometry
  double slip = 0.0;       // measured
  std::size_t ground = 0;  // which of the chain's grounds it lies on
};

// One soil that the ground may be, on one rover.
struct ChainSoil {
  std::string name;
  bool in_patches = false;  // it lies in patches; otherwise it fills units of ground
  PlaneSlips slips;
};

// A kind of ground: what share of it each of the chain's soils has.
struct ChainGround {
  std::string name;
  Eigen::ArrayXd shares;  // by soil, adding up to 1
};

// The ground along a way as a Markov chain over soils: where a rover leaves a unit or a patch, the soil is
// drawn anew from the ground that it enters. It is DrawnGround along a line: cells of a jittered lattice of
// spacing L are left after pi L / 4 on average, the mean chord of a square cell [Kendall & Moran 1963].
struct GroundChain {
  std::vector<ChainSoil> soils;
  std::vector<ChainGround> grounds;
  Eigen::ArrayXd chord_m;  // mean length of a soil's stretches
  StepNoise noise;

  // The soils of beliefs, each soil once; a belief without alternatives is a soil of its own. The rover's
  // tables of slips are made here.
  GroundChain(const sim::RoverModel& rover, double gravity_m_s2,
              std::span<const sim::SoilDistribution* const> beliefs);
  GroundChain(std::vector<ChainSoil> chain_soils, std::vector<ChainGround> chain_grounds, double patch_m);

  // How often a soil follows where one is left, from its shares of the ground.
  Eigen::ArrayXd entry_weights(const Eigen::ArrayXd& shares) const;
  Eigen::ArrayXd shares_of_entries(const Eigen::ArrayXd& weights) const;

  Eigen::ArrayXd predicted_slips(const ChainStep& step) const;              // by soil
  Eigen::ArrayXXd predicted_slips(std::span<const ChainStep> steps) const;  // soil x step
  // Of the measured slips where soils have these, soil x step.
  Eigen::ArrayXXd likelihoods(std::span<const ChainStep> steps, const Eigen::ArrayXXd& slips) const;
};

// What the steps of one way say.
struct ChainPass {
  Eigen::ArrayXXd before;    // soil x step: probabilities before the step's slip is known
  Eigen::ArrayXXd entries;   // soil x ground: expected number of stretches that begin
  Eigen::ArrayXXd smoothed;  // soil x step: probabilities after all steps
  Eigen::ArrayXd last;       // probabilities at the end
  double log_likelihood = 0.0;
};

// The forward and backward recursions [Rabiner 1989] over steps that follow each other. `likelihoods` is soil
// x step, `start` the probabilities at the first step, `shares` those of the soils by ground. What is entered
// where a soil is left within a step goes by share and by how often it is left, so that the shares stay where
// nothing is measured.
ChainPass follow(const GroundChain& chain, std::span<const ChainStep> steps,
                 const Eigen::ArrayXXd& likelihoods, const Eigen::ArrayXd& start,
                 const std::vector<Eigen::ArrayXd>& shares);

// The length over which soils that are not in patches hold; see sim::kUnitLength_m.
double mean_chord_m(double lattice_m);

}  // namespace slipway::steps
