#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/jobs/job_store.h"
#include "api/jobs/sqlite_connection.h"

// Single rows of the table of jobs, within a transaction of the caller's.
namespace slipway::api {

inline constexpr std::string_view kJobColumns =
    "id, kind, state, stage, progress, version, attempt, created_ms, started_ms, ended_ms, deaths, "
    "last_death, "
    "urgency, owner, (SELECT document FROM best_so_far WHERE job_id = jobs.id AND attempt = jobs.attempt), "
    "cpu_s, "
    "whole, part, parts, parts_ended, parts_failed, parts_cpu_s, request_sha256, outcome_sha256, "
    "(SELECT sha256 FROM ends WHERE job_id = jobs.id)";
// What a lease, bound as id and attempt, still holds; a job that waits for its parts is nobody's.
inline constexpr std::string_view kHeld =
    "id = ? AND attempt = ? AND state = 'running' AND lease_until_ms IS NOT NULL";

// Of a row of kJobColumns.
Job job_of(const SqliteStatement& row);
// Whether told_job() can read it.
bool is_whole(const SqliteStatement& row);
// The same as job_of(), for who is told of it: an ended job that is not as it ended is damage.
Job told_job(const SqliteStatement& row);
std::optional<Job> get_from(SqliteConnection& connection, std::string_view id);
std::optional<Job> told_from(SqliteConnection& connection, std::string_view id);

// What JobStore::claim_some() does with a job that may be claimed.
ClaimedJob claim_one(SqliteConnection& connection, const std::string& id, std::string_view worker,
                     std::int64_t now, std::int64_t lease_until);
// The parts that are claimed behind the first, `most` jobs in all.
std::vector<std::string> parts_beside(SqliteConnection& connection, const Job& first, int most);

// Takes down how the job has ended, so that told_job() notices what is altered afterwards.
void keep_end(SqliteConnection& connection, std::string_view id);

// False: the lease is lost.
bool end_job(SqliteConnection& connection, const JobEnd& end, std::int64_t now);
bool split_job(SqliteConnection& connection, const Lease& lease, const std::vector<std::string>& requests,
               std::int64_t now);
// What has not ended, with its parts; of a part its whole hears.
void dismiss_job(SqliteConnection& connection, std::string_view id, std::int64_t now);
// One more part of the job has ended; after the last one it is accepted again.
void count_ended_part(SqliteConnection& connection, std::string_view whole, bool well, double cpu_s);

// The ended jobs that are not to be kept go; how many.
int forget_jobs(SqliteConnection& connection, const Retention& kept, std::int64_t now);

}  // namespace slipway::api
