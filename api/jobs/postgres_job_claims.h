#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "api/jobs/job_store.h"
#include "api/jobs/postgres_connection.h"

// Who works on what: each call is one statement, which is one transaction.
namespace slipway::api {

// As JobStore::claim_some().
std::vector<ClaimedJob> claim_jobs(PostgresConnection& connection, std::string_view worker,
                                   const std::vector<std::string>& kinds, std::int64_t now, LeaseTerm term,
                                   int most);
// As JobStore::give_back().
int give_back_jobs(PostgresConnection& connection, const std::vector<Lease>& leases);

}  // namespace slipway::api
