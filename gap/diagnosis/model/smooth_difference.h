#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "gap/diagnosis/model/window_model.h"

namespace slipway::gap {

// A smooth difference between model and drives, per channel (and wheel): a sum of functions of what a window
// met - slope along and across, by which loads shift between the wheels, predicted slip, speed and direction,
// curvature, turning, temperature - each with a coefficient.

// One unit of a coefficient, by channel, in the channel's unit; the same for all campaigns of a comparison.
struct SmoothScale {
  std::vector<double> unit;  // by channel
};

// By the size of what the campaign predicts: a share of a current, a fixed part of the other channels.
SmoothScale smooth_scale(const WindowModel& model, std::span<const double> expected);

// Observations x coefficients; `expected`: predicted of every observation. The number and the meaning of the
// columns depend on the rover's wheels alone.
Eigen::MatrixXd smooth_columns(const WindowModel& model, std::span<const double> expected,
                               const SmoothScale& scale);

// The least and the greatest of what the windows of a campaign met, by circumstance: slopes along and across
// and slip of drives forward and of drives backward, the motors' temperature, slopes and sense of turns in
// place, speed and curvature. What no window met is 0.
constexpr std::size_t kRanged = 13;
struct SmoothRange {
  std::array<double, kRanged> lowest{}, highest{};
  std::array<bool, kRanged> seen{};
};
SmoothRange smooth_range(const WindowModel& model, std::span<const double> expected);

// What a reference of this range can't have told: columns that are 0 for every window within it and grow
// beyond either end of each circumstance, in pieces, for each channel and wheel; only those that are not 0
// everywhere. Where it has no drive backward, or no turn in place, all of those lie beyond it. Their
// coefficients are believed to be 0 with a deviation of 1.
Eigen::MatrixXd columns_beyond(const WindowModel& model, std::span<const double> expected,
                               const SmoothScale& scale, const SmoothRange& range);

// The group of each column, below kSmoothGroups times the number of channels: columns of one group are
// believed to be of one size. Those of a channel are in two: what gentle drives show, and what grows faster
// than slope and slip (their squares, cubes and products), of whose size gentle drives say next to nothing.
constexpr std::size_t kSmoothGroups = 2;
std::vector<std::size_t> smooth_groups(const sim::RoverModel& rover);

}  // namespace slipway::gap
