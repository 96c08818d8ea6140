#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gap/diagnosis/diagnosis.h"
#include "gap/diagnosis/model/window_variables.h"

namespace slipway::gap {

// The action of the hidden effects in a stretch of a drive, by the key.
struct HiddenTrace {
  std::string drive;
  WindowVariables at;
  // The squared change in each channel in units of the noise's standard deviation, mean over wheels; empty
  // where the channel is not observed.
  std::vector<std::optional<double>> mean_square = std::vector<std::optional<double>>(channel_count());
};

// The channel in which the sum over stretches is largest; empty where no sum is above 0.
std::optional<Channel> main_channel(std::span<const HiddenTrace> truth);

// Whether the found effects act most in the channel of the truth; empty where one of the channels is not
// known.
std::optional<bool> channel_right(std::span<const HiddenTrace> truth, const Diagnosis& diagnosis);

// Intersection over union of a slice's stretches and the stretches in which the hidden effects act above
// their mean.
struct SliceOverlap {
  double value = 0.0;       // of the slice in which the diagnosis says that the found effects act most
  double attainable = 0.0;  // the maximum over all slices of one or two conditions in that channel
};
// The value is 0, in the effects' first channel, where no slice is named. Empty where the diagnosis or the
// key does not state where the effects act.
std::optional<SliceOverlap> slice_overlap(std::span<const HiddenTrace> truth, const Diagnosis& diagnosis);

}  // namespace slipway::gap
