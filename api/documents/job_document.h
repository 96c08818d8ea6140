#pragma once

#include <optional>
#include <string>
#include <vector>

#include "api/jobs/job_runner.h"

namespace slipway::api::json {

// A job as it is served. `problem`: the problem document of a failed one; `queue`: of one that waits.
std::string write_job(const Job& job, const std::optional<std::string>& problem,
                      const std::optional<QueueEstimate>& queue);
std::string write_jobs(const std::vector<Job>& jobs);

}  // namespace slipway::api::json
