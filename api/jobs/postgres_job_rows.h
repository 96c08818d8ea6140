#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/jobs/job_store.h"
#include "api/jobs/postgres_connection.h"

// Single rows of the table of jobs, within a transaction of the caller's.
namespace slipway::api {

inline constexpr std::string_view kJobRow =
    "id, kind, state, stage, progress, version, attempt, created_ms, started_ms, ended_ms, deaths, "
    "last_death, "
    "urgency, owner, best_so_far, cpu_s, whole, part, parts, parts_ended, parts_failed, parts_cpu_s, "
    "request_sha256, outcome_sha256, end_sha256";
inline constexpr int kJobRowColumns = 25;
// What a lease still holds; $1 to $3 are its. A job that waits for its parts is nobody's.
inline constexpr std::string_view kHeldRow = "id = $1 AND attempt = $2 AND worker = $3 AND state = 'running'";
PostgresValues held(const Lease& lease);

// Of a row of kJobRow. One of a state that there is none of was damaged.
Job job_of(const PostgresRows& rows, int row);
// The same for who is told of it: an ended job that is not as it ended is damage.
Job told_job(const PostgresRows& rows, int row);
// Whether told_job() can read it.
bool is_whole(const PostgresRows& rows, int row);
std::vector<Job> told_jobs(const PostgresRows& rows);
std::optional<Job> get_from(PostgresConnection& connection, std::string_view id);
std::optional<Job> told_from(PostgresConnection& connection, std::string_view id);

// Of each, false: its lease is lost. True also where this lease has ended the job with this outcome before,
// of which the answer was lost. `to_put_together`: a job's last part was among them.
std::vector<bool> end_jobs(PostgresConnection& connection, const std::vector<JobEnd>& ends, std::int64_t now,
                           bool& to_put_together);
// False: the lease is lost. True also where it was divided before.
bool split_job(PostgresConnection& connection, const Lease& lease, const std::vector<std::string>& requests,
               std::int64_t now);
// What has not ended, with its parts; of a part its whole hears.
void dismiss_job(PostgresConnection& connection, std::string_view id, std::int64_t now);

// The ended jobs that are not to be kept go; how many.
int forget_jobs(PostgresConnection& connection, const Retention& kept, std::int64_t now);

}  // namespace slipway::api
