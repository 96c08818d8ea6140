#pragma once

#include <map>
#include <set>
#include <span>
#include <string>

#include "api/files/catalogue.h"
#include "core/result.h"
#include "research/benchmark/benchmark_score.h"
#include "research/cli/gap_benchmark_command.h"
#include "research/documents/drives_needed_report.h"

namespace slipway::server {

// How many drives the diagnosis needs of each of these campaigns whose hidden effects are all of the
// `library`; others are left out. The answers choose campaigns and end runs; neither a diagnosis nor a choice
// of drives sees them. A line for each run on standard error; interrupted, what is done is the answer.
// Errors: those of reading a campaign.
Result<gap::DrivesNeeded> drives_needed(const GapBenchmarkCommand& options, const api::Catalogue& catalogue,
                                        std::span<const std::string> names,
                                        const std::map<std::string, gap::HiddenAnswer>& answers,
                                        const std::set<std::string>& library);

}  // namespace slipway::server
