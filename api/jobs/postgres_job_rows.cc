#include "api/jobs/postgres_job_rows.h"

#include <fmt/format.h>

#include "api/jobs/job_admission.h"
#include "api/jobs/job_digest.h"

namespace slipway::api {
namespace {

// Of the whole, 1 where the part has no answer, its cost [s], the stage, the share of parts.
// Parts that end together queue up for this row, and one of them sees that it is the last.
constexpr std::string_view kCountEndedPart =
    "UPDATE slipway_jobs SET parts_ended = parts_ended + 1, parts_failed = parts_failed + {1}, "
    "parts_cpu_s = parts_cpu_s + {2}, version = version + 1, stage = format({3}, parts_ended + 1, parts), "
    "progress = {4}::float8 * (parts_ended + 1) / parts, "
    "state = CASE WHEN parts_ended + 1 = parts THEN 'accepted' ELSE state END "
    "WHERE id = {0} AND state = 'running' RETURNING (parts_ended = parts)::int::bigint AS is_last";

bool was_ended(PostgresConnection& connection, const Lease& lease, const std::string& digest) {
  // Changed too, so that the commit waits for what the first one may not have waited for.
  return connection
             .run(
                 "UPDATE slipway_jobs SET outcome_sha256 = outcome_sha256 WHERE id = $1 AND attempt = $2 AND "
                 "worker = $3 AND outcome_sha256 = $4",
                 held(lease).text(digest))
             .changed() == 1;
}

}  // namespace

PostgresValues held(const Lease& lease) {
  return PostgresValues().text(lease.id).number(lease.attempt).text(lease.worker);
}

Job job_of(const PostgresRows& rows, int row) {
  const auto state = job_state(rows.text(row, 2));
  if (!state) throw PostgresFailure("a job has a state that is none");
  Job job;
  job.id = rows.text(row, 0);
  job.kind = rows.text(row, 1);
  job.state = *state;
  job.stage = rows.text(row, 3);
  job.progress = rows.real(row, 4);
  job.version = rows.number(row, 5);
  job.attempt = static_cast<int>(rows.number(row, 6));
  job.created_ms = rows.number(row, 7);
  job.started_ms = rows.optional_number(row, 8);
  job.ended_ms = rows.optional_number(row, 9);
  job.deaths = static_cast<int>(rows.number(row, 10));
  job.last_death = rows.text(row, 11);
  job.urgency = static_cast<int>(rows.number(row, 12));
  job.owner = rows.text(row, 13);
  job.best_so_far = rows.text(row, 14);
  job.cpu_s = rows.real(row, 15);
  job.whole = rows.text(row, 16);
  job.part = static_cast<int>(rows.number(row, 17));
  job.parts = {static_cast<int>(rows.number(row, 18)), static_cast<int>(rows.number(row, 19)),
               static_cast<int>(rows.number(row, 20)), rows.real(row, 21)};
  return job;
}

std::vector<Job> jobs_of(const PostgresRows& rows) {
  std::vector<Job> jobs;
  for (int row = 0; row < rows.count(); ++row) jobs.push_back(job_of(rows, row));
  return jobs;
}

std::optional<Job> get_from(PostgresConnection& connection, std::string_view id) {
  const PostgresRows rows = connection.run(fmt::format("SELECT {} FROM slipway_jobs WHERE id = $1", kJobRow),
                                           PostgresValues().text(id));
  return rows.count() == 1 ? std::optional(job_of(rows, 0)) : std::nullopt;
}

bool end_job(PostgresConnection& connection, const Lease& lease, JobState state, const JobAnswer& outcome,
             std::int64_t now, bool& to_put_together) {
  const std::string digest = outcome_digest(lease.id, describe(state), outcome.bytes);
  for (std::size_t k = 0; k < outcome.series.size(); ++k) {
    const auto page = static_cast<std::int64_t>(k + 1);
    connection.run(
        "INSERT INTO slipway_series (job_id, page, bytes, sha256) SELECT id, $4, $5, $6 FROM slipway_jobs "
        "WHERE id = $1 AND attempt = $2 AND worker = $3 AND state = 'running'",
        held(lease)
            .number(page)
            .text(outcome.series[k])
            .text(series_digest(lease.id, page, outcome.series[k])));
  }
  // One statement, so that nobody waits for the whole's row longer than it takes.
  static const std::string kEnd = fmt::format(
      "WITH ended AS (UPDATE slipway_jobs SET state = $4, outcome = $5, outcome_sha256 = $6, ended_ms = $7, "
      "cpu_s = $8, version = version + 1, progress = CASE $4 WHEN 'successful' THEN 1.0 ELSE progress END "
      "WHERE {} RETURNING whole), counted AS ({}) "
      "SELECT (SELECT count(*) FROM ended), (SELECT is_last FROM counted)",
      kHeldRow,
      fmt::format(kCountEndedPart, "(SELECT whole FROM ended)", "CASE $4 WHEN 'successful' THEN 0 ELSE 1 END",
                  "$8", "$9", "$10"));
  const PostgresRows rows = connection.run(kEnd, held(lease)
                                                     .text(describe(state))
                                                     .text(outcome.bytes)
                                                     .text(digest)
                                                     .number(now)
                                                     .real(outcome.cpu_s)
                                                     .text(kStageOfParts)
                                                     .real(kShareOfParts));
  if (rows.number(0, 0) != 1) return was_ended(connection, lease, digest);
  to_put_together = rows.optional_number(0, 1).value_or(0) == 1;
  return true;
}

bool split_job(PostgresConnection& connection, const Lease& lease, const std::vector<std::string>& requests,
               std::int64_t now) {
  const auto count = static_cast<std::int64_t>(requests.size());
  const PostgresRows rows = connection.run(
      fmt::format("UPDATE slipway_jobs SET parts = $4, stage = $5, progress = 0, version = version + 1, "
                  "worker = NULL, lease_until_ms = NULL WHERE {} RETURNING {}",
                  kHeldRow, kJobRow),
      held(lease).number(count).text(stage_of_parts(0, static_cast<int>(count))));
  if (rows.count() != 1) {
    const std::optional<Job> job = get_from(connection, lease.id);
    return job && job->attempt == lease.attempt && job->parts.count > 0;
  }
  const Job whole = job_of(rows, 0);
  std::vector<std::string> ids, digests, texts;
  for (const std::string& request : requests) {
    const NewJob part = new_part(whole, request);
    ids.push_back(part.id);
    digests.push_back(request_digest(part.id, part.kind, request));
    texts.push_back(request);
  }
  connection.run(
      "INSERT INTO slipway_jobs (id, kind, state, created_ms, request, request_sha256, owner, urgency, "
      "whole, "
      "part) SELECT new.id, of_all.kind, 'accepted', $5, convert_to(new.request, 'UTF8'), new.sha256, "
      "of_all.owner, of_all.urgency, of_all.id, new.number - 1 "
      "FROM unnest($2::text[], $3::text[], $4::text[]) WITH ORDINALITY AS new (id, request, sha256, number), "
      "slipway_jobs AS of_all WHERE of_all.id = $1 ORDER BY new.number",
      PostgresValues().text(whole.id).list(ids).list(texts).list(digests).number(now));
  return true;
}

void dismiss_job(PostgresConnection& connection, std::string_view id, std::int64_t now) {
  constexpr std::string_view kDismiss =
      "UPDATE slipway_jobs SET state = 'dismissed', ended_ms = $2, version = version + 1, worker = NULL "
      "WHERE {} = $1 AND state IN ('accepted', 'running')";
  const std::optional<Job> job = get_from(connection, id);
  const PostgresValues values = PostgresValues().text(id).number(now);
  if (connection.run(fmt::format(kDismiss, "id"), values).changed() != 1) return;
  connection.run(fmt::format(kDismiss, "whole"), values);
  if (!job || job->whole.empty()) return;
  connection.run(fmt::format(kCountEndedPart, "$1", "1", "$2", "$3", "$4"),
                 PostgresValues().text(job->whole).real(0.0).text(kStageOfParts).real(kShareOfParts));
}

}  // namespace slipway::api
