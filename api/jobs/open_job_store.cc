#include "api/jobs/open_job_store.h"

#include <cstdlib>

#include "api/jobs/postgres_connection.h"
#include "api/jobs/postgres_job_store.h"

namespace slipway::api {

bool is_database(std::string_view place) {
  return place.starts_with("postgresql://") || place.starts_with("postgres://");
}

Result<std::unique_ptr<JobStore>> open_job_store(const std::string& place, StoreCheck how_far) {
  if (is_database(place)) return open_postgres_job_store(place);
  return open_sqlite_job_store(place, how_far);
}

Result<std::string> without_secrets(const std::string& place) {
  if (!is_database(place)) return place;
  try {
    const PostgresAddress address(place);
    if (!address.password().empty()) ::setenv("PGPASSWORD", address.password().c_str(), 1);
    return address.shown();
  } catch (const PostgresFailure& failure) {
    return fail(ErrorCode::kInvalidRequest, "the job store can't be opened so", {{"/jobs", failure.what()}});
  }
}

}  // namespace slipway::api
