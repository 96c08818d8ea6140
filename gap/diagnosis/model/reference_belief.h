#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/pose.h"
#include "gap/diagnosis/model/channel.h"
#include "gap/diagnosis/model/noise_model.h"
#include "gap/diagnosis/model/smooth_difference.h"
#include "sim/rover/drive_command.h"

namespace slipway::gap {

// A window of a reference, and what is left over there: by channel and wheel (-1: of the rover).
struct SeenWindow {
  std::string terrain;
  Pose2 middle;
  sim::DriveCommand command;
  std::map<std::pair<Channel, int>, double> left_over;
};

// What reference drives told, for a campaign that asks what has changed since: a normal belief of its
// nuisances, of what the model leaves over beside them, and of the drives' scatter. Of the difference's
// coefficients b given nuisances x, b = coefficients + slope (x - mean) / deviation + root z with z normal of
// deviation 1: what re-tuning would explain, the difference need not.
struct ReferenceBelief {
  std::string campaign, fingerprint;
  std::size_t drives = 0, windows = 0;
  std::vector<std::string> implausible;  // notes of its readings (reading_plausibility.h)

  std::vector<std::string> names;  // of all nuisances of the campaign that asks, in Hypothesis' order
  Eigen::VectorXd mean;            // x
  Eigen::MatrixXd precision;       // of (x - mean) over the nuisances' deviations

  SmoothScale scale;
  SmoothRange range;  // that the reference met: what lies beyond it, it can't have told
  Eigen::VectorXd coefficients;
  Eigen::MatrixXd slope;  // coefficients x nuisances
  Eigen::MatrixXd root;   // coefficients x causes
  NoiseScales noise;
  std::vector<SeenWindow> seen;
  Footing footing = Footing::kSuspension;  // that the reference's attitudes have shown
};

// Index of a name that is there.
std::size_t place_in(std::span<const std::string> names, const std::string& name);

}  // namespace slipway::gap
