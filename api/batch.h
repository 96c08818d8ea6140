#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "api/jobs/job_runner.h"
#include "api/requests/batch_request.h"
#include "core/progress.h"
#include "core/result.h"

namespace slipway::api {

class Service;

// Many requests of one kind as one job, each a part of it.

// Errors: invalid_request with the faults of all requests, each under /requests/NUMBER.
Result<BatchRequest> read_batch(const Service& service, std::string_view body);
Result<BatchAnswer> run_batch(const Service& service, const BatchRequest& request, Progress& progress);
// The answers, one a line.
std::string batch_lines(const BatchAnswer& answer);

std::vector<std::string> batch_parts(const Service& service, const BatchRequest& request,
                                     std::string_view recorded);
Result<JobAnswer> batch_part(const Service& service, std::string_view part, Progress& progress);
Result<BatchAnswer> put_batch_together(const Service& service, const BatchRequest& request,
                                       const PartAnswer& parts, Progress& progress);

}  // namespace slipway::api
