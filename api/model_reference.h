#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "api/jobs/job_store.h"
#include "core/result.h"

namespace slipway::api {

// What is wrong with a request; nothing where it can be answered.
using RequestFaults = std::function<std::optional<Error>(std::string_view request)>;

// A request as it is to be recorded: where it names a model, "model": {"diagnosis": JOB, "ground": [...]},
// with the model itself in it, which neither a restart nor the job's being forgotten then takes away. Others
// stay as they came, byte by byte. Errors: those of the request; invalid_request with every fault of the
// model and of the rest, each with its place; storage.
Result<std::string> recordable_request(std::string_view request, JobStore& jobs,
                                       const RequestFaults& faults_of);

}  // namespace slipway::api
