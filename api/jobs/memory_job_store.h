#pragma once

#include <memory>

#include "api/jobs/job_store.h"

namespace slipway::api {

// Jobs in this process's memory: for tests, and for a service whose jobs may end with it.
std::unique_ptr<JobStore> make_memory_job_store();

}  // namespace slipway::api
