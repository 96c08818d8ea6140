#pragma once

#include <span>
#include <string>

#include "gap/benchmark_score.h"

namespace slipway::api {

// What a benchmark of the diagnosis came to.
struct Benchmark {
  std::string variant;  // of the diagnosis: "as it is", or what was taken out of it
  std::vector<gap::CaseScore> cases;
  std::vector<gap::WithheldScore> withheld;
};

// Figures with their intervals against the targets, over all and by fidelity and kind of campaign; each case;
// what was hidden against what was found. Markdown.
std::string benchmark_report(const Benchmark& benchmark);

// One line for each case under a header line, for tables over several benchmarks. The first columns are the
// `set` of campaigns and the variant.
std::string benchmark_csv(const Benchmark& benchmark, const std::string& set);

// The same of the diagnoses with an effect withheld.
std::string withheld_csv(const Benchmark& benchmark, const std::string& set);

// The cases of all, then of each fidelity and kind that there is, under their names.
std::vector<std::pair<std::string, std::vector<gap::CaseScore>>> benchmark_groups(const Benchmark& benchmark);

}  // namespace slipway::api
