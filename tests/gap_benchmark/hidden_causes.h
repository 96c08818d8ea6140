#pragma once

#include <span>
#include <string>
#include <string_view>

#include "hidden_truth.h"
#include "random_stream.h"

namespace slipway::gap_benchmark {

// The library's sixteen, by the names of its catalogue.
std::span<const std::string_view> library_effects();
// Causes that are in no library.
std::span<const std::string_view> foreign_causes();
bool is_known_cause(std::string_view name);
// Causes that are terms of the arc's stresses: other wheel laws don't have them.
bool is_of_arc_law(std::string_view name);

// Puts a cause of `size` times its usual size into the truth, and its name and parameters into the answer. A
// soft patch gets its place later.
void hide(std::string_view name, double size, RandomStream& random, HiddenTruth& truth,
          EffectAnswers& answer);

}  // namespace slipway::gap_benchmark
