#pragma once

#include <string>

#include "research/benchmark/benchmark_result.h"

namespace slipway::api::json {

// "gap-benchmark/1": figures by group with their 90 % intervals, each case, what was hidden against what was
// found. Seconds alone differ from run to run.
std::string benchmark_document(const gap::Benchmark& benchmark);

}  // namespace slipway::api::json
