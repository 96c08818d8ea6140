#pragma once

#include <span>
#include <string>

#include "research/validation/comparison_catalogue.h"

namespace slipway::validation {

struct Outcome {
  const Comparison* comparison = nullptr;
  Report report;
};

// Reports as one JSON document of format "research/validation/1": for every comparison its source, what peers
// reach, its cases (measured, predicted, error), its stated bands and its notes.
std::string document_of(std::span<const Outcome> outcomes);

}  // namespace slipway::validation
