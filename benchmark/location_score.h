#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gap/diagnosis/diagnosis.h"
#include "gap/diagnosis/model/window_variables.h"

namespace slipway::gap {

// What was hidden does this in a stretch of a drive, by the key.
struct HiddenTrace {
  std::string drive;
  WindowVariables at;
  // Squared, in deviations of the channel's noise, mean over wheels; nothing where it is not observed.
  std::vector<std::optional<double>> mean_square = std::vector<std::optional<double>>(channel_count());
};

// The channel in which the sum over stretches is largest; nothing where there is none above 0.
std::optional<Channel> main_channel(std::span<const HiddenTrace> truth);

// Whether the found effects act most in the channel of the truth; nothing where either is not said.
std::optional<bool> channel_right(std::span<const HiddenTrace> truth, const Diagnosis& diagnosis);

// Intersection over union, in stretches, with those that hold more than their share of what was hidden.
struct SliceOverlap {
  double value = 0.0;       // of the slice in which the found effects are said to act most, in its channel
  double attainable = 0.0;  // the most that a slice of one or two conditions has in that channel
};
// 0 in the effects' first channel where no slice is named; nothing where the diagnosis or the key says
// nothing of where they act.
std::optional<SliceOverlap> slice_overlap(std::span<const HiddenTrace> truth, const Diagnosis& diagnosis);

}  // namespace slipway::gap
