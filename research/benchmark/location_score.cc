#include "research/benchmark/location_score.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "gap/diagnosis/describe/slices.h"

namespace slipway::gap {
namespace {

// The margins by which a stretch may lie outside a slice, whose ends are other windows' readings, in the
// order of the window's variables. They are the readings' errors, and the error of the mean ground under
// three stations.
constexpr std::array<double, kWindowVariables> kSlack{0.1, 0.1, 0.005, 1e-4, 1e-4, 0.1, 1e-4, 0.5};

double square_of(const HiddenTrace& trace, Channel channel) {
  return trace.mean_square[static_cast<std::size_t>(channel)].value_or(0.0);
}

bool lies_in(const HiddenTrace& trace, const Regime& slice) {
  return std::all_of(slice.conditions.begin(), slice.conditions.end(), [&](const Condition& condition) {
    const double value = variable_of(trace.at, condition.variable);
    const double slack = kSlack[static_cast<std::size_t>(condition.variable)];
    return value >= condition.from - slack && value <= condition.to + slack;
  });
}

double overlap_of(const std::vector<bool>& a, const std::vector<bool>& b) {
  std::size_t both = 0, either = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    both += a[i] && b[i] ? 1 : 0;
    either += a[i] || b[i] ? 1 : 0;
  }
  return either == 0 ? 0.0 : static_cast<double>(both) / static_cast<double>(either);
}

}  // namespace

std::optional<Channel> main_channel(std::span<const HiddenTrace> truth) {
  std::optional<Channel> main;
  double most = 0.0;
  for (std::size_t c = 0; c < channel_count(); ++c) {
    double sum = 0.0;
    for (const HiddenTrace& trace : truth) sum += square_of(trace, static_cast<Channel>(c));
    if (sum <= most) continue;
    most = sum;
    main = static_cast<Channel>(c);
  }
  return main;
}

std::optional<bool> channel_right(std::span<const HiddenTrace> truth, const Diagnosis& d) {
  const std::optional<Channel> main = main_channel(truth);
  if (!main || d.channels_of_effects.empty()) return std::nullopt;
  return d.channels_of_effects.front().channel == *main;
}

std::optional<SliceOverlap> slice_overlap(std::span<const HiddenTrace> truth, const Diagnosis& d) {
  if (truth.empty() || d.channels_of_effects.empty()) return std::nullopt;
  const bool named = !d.regimes_of_effect.empty();
  const Channel channel = named ? d.regimes_of_effect.front().channel : d.channels_of_effects.front().channel;
  double mean = 0.0;
  for (const HiddenTrace& trace : truth)
    mean += square_of(trace, channel) / static_cast<double>(truth.size());
  std::vector<bool> more, inside;
  std::vector<WindowVariables> variables;
  for (const HiddenTrace& trace : truth) {
    more.push_back(square_of(trace, channel) > mean);
    inside.push_back(named && lies_in(trace, d.regimes_of_effect.front()));
    variables.push_back(trace.at);
  }
  SliceOverlap overlap{overlap_of(inside, more), 0.0};
  for (const Slice& slice : slices_of(variables)) {
    inside.assign(truth.size(), false);
    for (const std::size_t window : slice.windows) inside[window] = true;
    overlap.attainable = std::max(overlap.attainable, overlap_of(inside, more));
  }
  // Ends that are other windows' readings may do better than those of the key's own.
  overlap.attainable = std::max(overlap.attainable, overlap.value);
  return overlap;
}

}  // namespace slipway::gap
