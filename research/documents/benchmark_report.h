#pragma once

#include <span>
#include <string>

#include "research/benchmark/benchmark_result.h"

namespace slipway::api {

// Figures with their intervals against the targets, over all and by fidelity and kind of campaign; each case;
// what was hidden against what was found. Markdown.
std::string benchmark_report(const gap::Benchmark& benchmark);

// One line for each case under a header line, for tables over several benchmarks. The first columns are the
// `set` of campaigns and the variant.
std::string benchmark_csv(const gap::Benchmark& benchmark, const std::string& set);

// The same of the marginal probabilities, one line for each case and effect of the library.
std::string marginals_csv(const gap::Benchmark& benchmark, const std::string& set);

// The same of the diagnoses with an effect withheld.
std::string withheld_csv(const gap::Benchmark& benchmark, const std::string& set);

}  // namespace slipway::api
