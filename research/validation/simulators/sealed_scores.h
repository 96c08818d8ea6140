#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/result.h"
#include "research/benchmark/benchmark_figures.h"

namespace slipway::validation {

// A line that slipway gap-benchmark --csv wrote.
struct SealedScore {
  std::string set, variant;
  gap::CaseScore score;
};
// Columns that earlier versions did not write may be absent. Errors: unreadable_data.
Result<std::vector<SealedScore>> read_sealed_scores(const std::filesystem::path& file);

std::string rate_words(const gap::Rate& rate);  // "20 of 26 (0.62 to 0.89)"

}  // namespace slipway::validation
