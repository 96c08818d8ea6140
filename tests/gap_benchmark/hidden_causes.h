#pragma once

#include <span>
#include <string>
#include <string_view>

#include "hidden_truth.h"
#include "random_stream.h"

namespace slipway::gap_benchmark {

// The library's sixteen effects by the names of its catalogue.
std::span<const std::string_view> library_effects();
// Causes that are outside every library: those that sets of causes draw from, and what the world does to a
// vehicle, which the set "outside" has besides.
std::span<const std::string_view> foreign_causes();
std::span<const std::string_view> world_causes();
bool is_known_cause(std::string_view name);
// Causes that are terms of the contact arc's stresses, which other wheel laws do not have.
bool is_of_arc_law(std::string_view name);

// Puts a cause of `size` times its usual size into the truth, and its name and parameters into the answer. A
// soft patch gets its place later.
void hide(std::string_view name, double size, RandomStream& random, HiddenTruth& truth,
          EffectAnswers& answer);

}  // namespace slipway::gap_benchmark
