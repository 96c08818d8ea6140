#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "api/jobs/job_store.h"
#include "api/jobs/sqlite_job_store.h"

namespace slipway::api {

// Whether --jobs names a database server: "postgresql://..." or "postgres://...".
bool is_database(std::string_view place);

// The store at the place that --jobs names: such a database, an SQLite file, or this process's memory where
// it is empty. How far it is looked through is for files.
Result<std::unique_ptr<JobStore>> open_job_store(const std::string& place,
                                                 StoreCheck how_far = StoreCheck::kWhole);

// The place as it may be shown, logged and given to other processes: without a password. Where it had one,
// that goes into this process's environment, where libpq looks for it and processes that are started inherit
// it. Errors: invalid_request at /jobs.
Result<std::string> without_secrets(const std::string& place);

}  // namespace slipway::api
