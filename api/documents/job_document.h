#pragma once

#include <optional>
#include <string>
#include <vector>

#include "api/jobs/job.h"

namespace slipway::api::json {

// A job as it is served. `problem`: the problem document of a failed one.
std::string write_job(const Job& job, const std::optional<std::string>& problem);
std::string write_jobs(const std::vector<Job>& jobs);

}  // namespace slipway::api::json
