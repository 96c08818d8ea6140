#pragma once

#include <string>
#include <utility>
#include <vector>

#include "research/benchmark/benchmark_score.h"

namespace slipway::gap {

// The result of a benchmark of the diagnosis.
struct Benchmark {
  std::string variant;  // of the diagnosis: "as it is", or the part that was left out
  std::vector<CaseScore> cases;
  std::vector<WithheldScore> withheld;
};

// The figures of all cases, then those of each fidelity and kind that occurs, under their names.
std::vector<std::pair<std::string, std::vector<CaseScore>>> benchmark_groups(const Benchmark& benchmark);

}  // namespace slipway::gap
