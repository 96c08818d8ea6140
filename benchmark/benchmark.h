#pragma once

#include <string>
#include <utility>
#include <vector>

#include "benchmark/benchmark_score.h"

namespace slipway::gap {

// What a benchmark of the diagnosis came to.
struct Benchmark {
  std::string variant;  // of the diagnosis: "as it is", or what was taken out of it
  std::vector<CaseScore> cases;
  std::vector<WithheldScore> withheld;
};

// The cases of all, then of each fidelity and kind that there is, under their names.
std::vector<std::pair<std::string, std::vector<CaseScore>>> benchmark_groups(const Benchmark& benchmark);

}  // namespace slipway::gap
