#pragma once

#include <string>
#include <string_view>

#include "api/jobs/job_store.h"
#include "api/model_reference.h"
#include "core/result.h"

namespace slipway::api {

// A request as it is to be recorded: where it continues an earlier job of its kind, "continues": JOB, with
// the drives of that job's request before its own and everything else as it was there, so that neither a
// restart nor the job's being forgotten changes the answer. Others stay as they came, byte by byte. Errors:
// those of the request; invalid_request with every fault of "continues" and of the rest, drives counted as in
// the request; storage.
Result<std::string> continued_request(std::string_view request, std::string_view kind, JobStore& jobs,
                                      const RequestFaults& faults_of);

}  // namespace slipway::api
