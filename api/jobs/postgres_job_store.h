#pragma once

#include <chrono>
#include <memory>
#include <string>

#include "api/jobs/job_store.h"

namespace slipway::api {

struct PostgresOptions {
  // Within which every call ends, however long the server holds a commit back: a lost synchronous standby
  // holds it back for ever.
  std::chrono::milliseconds deadline{5000};
};

// Jobs in a PostgreSQL database (15 or newer), for services and workers on any number of machines. What was
// acknowledged, ended or dismissed was committed as the server commits: to its disk and, where it has one, to
// a synchronous standby. Progress and claims are not waited for: after the loss of the server the job runs
// again. The bounds of an Admission may be passed by as many jobs as are accepted at the same moment.
//
// The address is in libpq's form, "postgresql://USER@HOST,HOST:PORT/DATABASE"; the tables are made where the
// search path leads.
Result<std::unique_ptr<JobStore>> open_postgres_job_store(const std::string& address,
                                                          const PostgresOptions& options = {});

}  // namespace slipway::api
