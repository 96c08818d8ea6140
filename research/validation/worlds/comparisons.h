#pragma once

#include <filesystem>
#include <vector>

#include "core/result.h"
#include "research/validation/report/report.h"
#include "research/validation/worlds/world_study.h"

namespace slipway::validation {

// Reports on the scores of seeded worlds that ship (data/validation/worlds_scores.csv). Errors:
// unreadable_data.
Result<Report> worlds(const std::filesystem::path& data);
Result<Report> worlds_slip(const std::filesystem::path& data);
Result<Report> worlds_reliability(const std::filesystem::path& data);

// The same on any scores: how planners compare, on the soils of the worlds; whether the 90 % interval of a
// route's mean slip holds it; whether probabilities of stops and embeddings come about.
Report planners_report(const std::vector<WorldScore>& scores);
Report slip_report(const std::vector<WorldScore>& scores);
Report reliability_report(const std::vector<WorldScore>& scores);

}  // namespace slipway::validation
