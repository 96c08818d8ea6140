#include "api/jobs/postgres_job_rows.h"

#include <fmt/format.h>

#include <set>

#include "api/jobs/artefact_row.h"
#include "api/jobs/job_admission.h"
#include "api/jobs/job_digest.h"

namespace slipway::api {
namespace {

// Of jobs, how many parts have ended: the table of {0} says of which `whole` how many (`parts`), how many
// without an answer (`failed`), and their cost (`cpu_s` [s]); then the stage, and the share of parts.
// Workers queue up for the whole's row, and one of them sees that its part is the last.
constexpr std::string_view kCountEndedParts =
    "UPDATE slipway_jobs AS job SET parts_ended = job.parts_ended + ended.parts, "
    "parts_failed = job.parts_failed + ended.failed, parts_cpu_s = job.parts_cpu_s + ended.cpu_s, "
    "version = job.version + 1, stage = format({1}, job.parts_ended + ended.parts, job.parts), "
    "progress = {2}::float8 * (job.parts_ended + ended.parts) / job.parts, "
    "state = CASE WHEN job.parts_ended + ended.parts = job.parts THEN 'accepted' ELSE job.state END "
    "FROM ({0}) AS ended WHERE job.id = ended.whole AND job.state = 'running' "
    "RETURNING (job.parts_ended = job.parts)::int::bigint AS is_last";

bool was_ended(PostgresConnection& connection, const Lease& lease, const std::string& digest) {
  // Changed too, so that the commit waits for what the first one may not have waited for.
  return connection
             .run(
                 "UPDATE slipway_jobs SET outcome_sha256 = outcome_sha256 WHERE id = $1 AND attempt = $2 AND "
                 "worker = $3 AND outcome_sha256 = $4",
                 held(lease).text(digest))
             .changed() == 1;
}

void insert_series(PostgresConnection& connection, const Lease& lease,
                   const std::vector<std::string>& series) {
  for (std::size_t k = 0; k < series.size(); ++k) {
    const auto page = static_cast<std::int64_t>(k + 1);
    connection.run(
        fmt::format("INSERT INTO slipway_series (job_id, page, bytes, sha256) SELECT id, $4, $5, $6 "
                    "FROM slipway_jobs WHERE {}",
                    kHeldRow),
        held(lease).number(page).text(series[k]).text(series_digest(lease.id, page, series[k])));
  }
}

// A job without a digest has not ended, or did so in an older program.
bool is_as_it_ended(const PostgresRows& rows, int row, const Job& job) {
  const std::string kept = rows.text(row, kJobRowColumns - 1);
  return kept.empty() || (has_ended(job.state) && kept == end_digest(job, rows.text(row, kJobRowColumns - 3),
                                                                     rows.text(row, kJobRowColumns - 2)));
}

// end_digest() of a row that ends with the state {0} at the time {1} with an outcome of the digest {2}.
constexpr std::string_view kEndDigest =
    "encode(sha256(convert_to((SELECT string_agg(octet_length(convert_to(part, 'UTF8'))::text || ':' || "
    "part, '' ORDER BY number) FROM unnest(ARRAY[job.id, job.kind, job.owner, {0}, job.attempt::text, "
    "job.created_ms::text, coalesce(job.started_ms::text, ''), {1}, coalesce(job.whole, ''), "
    "job.part::text, job.request_sha256, coalesce({2}, '')]::text[]) WITH ORDINALITY "
    "AS parts (part, number)), 'UTF8')), 'hex')";

}  // namespace

PostgresValues held(const Lease& lease) {
  return PostgresValues().text(lease.id).number(lease.attempt).text(lease.worker);
}

bool is_whole(const PostgresRows& rows, int row) {
  return job_state(rows.text(row, 2)).has_value() && is_as_it_ended(rows, row, job_of(rows, row));
}

Job told_job(const PostgresRows& rows, int row) {
  Job job = job_of(rows, row);
  if (is_as_it_ended(rows, row, job)) return job;
  throw PostgresDamage(altered_end(job.id));
}

Job job_of(const PostgresRows& rows, int row) {
  const auto state = job_state(rows.text(row, 2));
  if (!state)
    throw PostgresDamage(
        fmt::format("what is stored of job {} has the state \"{}\", which is none: ask again "
                    "for what it was asked",
                    rows.text(row, 0), rows.text(row, 2)));
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

std::vector<Job> told_jobs(const PostgresRows& rows) {
  std::vector<Job> jobs;
  for (int row = 0; row < rows.count(); ++row) jobs.push_back(told_job(rows, row));
  return jobs;
}

std::optional<Job> told_from(PostgresConnection& connection, std::string_view id) {
  const PostgresRows rows = connection.run(fmt::format("SELECT {} FROM slipway_jobs WHERE id = $1", kJobRow),
                                           PostgresValues().text(id));
  return rows.count() == 1 ? std::optional(told_job(rows, 0)) : std::nullopt;
}

std::optional<Job> get_from(PostgresConnection& connection, std::string_view id) {
  const PostgresRows rows = connection.run(fmt::format("SELECT {} FROM slipway_jobs WHERE id = $1", kJobRow),
                                           PostgresValues().text(id));
  return rows.count() == 1 ? std::optional(job_of(rows, 0)) : std::nullopt;
}

std::vector<bool> end_jobs(PostgresConnection& connection, const std::vector<JobEnd>& ends, std::int64_t now,
                           bool& to_put_together) {
  std::vector<std::string> ids, attempts, workers, states, digests, costs;
  std::vector<std::string_view> outcomes;
  for (const auto& [lease, state, outcome] : ends) {
    insert_series(connection, lease, outcome.series);
    ids.push_back(lease.id);
    attempts.push_back(fmt::format("{}", lease.attempt));
    workers.push_back(lease.worker);
    states.emplace_back(describe(state));
    outcomes.emplace_back(outcome.bytes);
    digests.push_back(outcome_digest(lease.id, describe(state), outcome.bytes));
    costs.push_back(fmt::format("{}", outcome.cpu_s));
  }
  // One statement, so that nobody waits for a whole's row longer than it takes.
  static const std::string kEnd = fmt::format(
      "WITH ended AS (UPDATE slipway_jobs AS job SET state = new.state, outcome = new.outcome, "
      "outcome_sha256 = new.sha256, ended_ms = $8::bigint, cpu_s = new.cpu_s, version = version + 1, "
      "end_sha256 = {1}, "
      "progress = CASE new.state WHEN 'successful' THEN 1.0 ELSE progress END "
      "FROM unnest($1::text[], $2::bigint[], $3::text[], $4::text[], $5::bytea[], $6::text[], $7::float8[]) "
      "AS new (id, attempt, worker, state, outcome, sha256, cpu_s) WHERE job.id = new.id AND "
      "job.attempt = new.attempt AND job.worker = new.worker AND job.state = 'running' "
      "RETURNING job.id, job.whole, job.state, job.cpu_s), "
      "counted AS ({0}) SELECT id, (SELECT max(is_last) FROM counted) FROM ended",
      fmt::format(kCountEndedParts,
                  "SELECT whole, count(*) AS parts, count(*) FILTER (WHERE state <> 'successful') AS failed, "
                  "sum(cpu_s) AS cpu_s FROM ended WHERE whole IS NOT NULL GROUP BY whole",
                  "$9", "$10"),
      fmt::format(kEndDigest, "new.state", "$8::bigint::text", "new.sha256"));
  const PostgresRows rows = connection.run(kEnd, PostgresValues()
                                                     .list(ids)
                                                     .list(attempts)
                                                     .list(workers)
                                                     .list(states)
                                                     .bytes_list(outcomes)
                                                     .list(digests)
                                                     .list(costs)
                                                     .number(now)
                                                     .text(kStageOfParts)
                                                     .real(kShareOfParts));
  std::set<std::string> now_ended;
  for (int row = 0; row < rows.count(); ++row) now_ended.insert(rows.text(row, 0));
  to_put_together = rows.count() > 0 && rows.optional_number(0, 1).value_or(0) == 1;
  std::vector<bool> kept;
  for (std::size_t k = 0; k < ends.size(); ++k)
    kept.push_back(now_ended.contains(ids[k]) || was_ended(connection, ends[k].lease, digests[k]));
  return kept;
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
      "UPDATE slipway_jobs AS job SET state = 'dismissed', ended_ms = $2::bigint, version = version + 1, "
      "worker = NULL, end_sha256 = {1} WHERE {0} = $1 AND state IN ('accepted', 'running')";
  const std::string digest = fmt::format(kEndDigest, "'dismissed'", "$2::bigint::text", "job.outcome_sha256");
  const std::optional<Job> job = told_from(connection, id);
  const PostgresValues values = PostgresValues().text(id).number(now);
  if (connection.run(fmt::format(kDismiss, "id", digest), values).changed() != 1) return;
  connection.run(fmt::format(kDismiss, "whole", digest), values);
  if (!job || job->whole.empty()) return;
  connection.run(
      fmt::format(kCountEndedParts, "SELECT $1 AS whole, 1 AS parts, 1 AS failed, 0.0 AS cpu_s", "$2", "$3"),
      PostgresValues().text(job->whole).text(kStageOfParts).real(kShareOfParts));
}

int forget_jobs(PostgresConnection& connection, const Retention& kept, std::int64_t now) {
  // Those of a row's pages count wherever they are.
  const auto own = [](std::string_view job) {
    return fmt::format(
        "octet_length({0}.request) + coalesce(octet_length({0}.outcome), 0) + "
        "coalesce((SELECT sum(CASE WHEN octet_length(bytes) = {1} AND substring(bytes FROM 1 FOR {2}) = "
        "$5::bytea THEN convert_from(substring(bytes FROM {3}), 'UTF8')::bigint ELSE octet_length(bytes) "
        "END) "
        "FROM slipway_series WHERE job_id = {0}.id), 0)",
        job, kArtefactRowBytes, kArtefactMark.size(), kArtefactMark.size() + kArtefactNameDigits + 1);
  };
  return connection
      .run(fmt::format("DELETE FROM slipway_jobs WHERE sequence IN (SELECT sequence FROM ("
                       "SELECT sequence, number, bytes, sum(CASE WHEN gap > $6 THEN $7 ELSE gap END) OVER "
                       "latest AS age FROM ("
                       "SELECT sequence, ended_ms, row_number() OVER newest AS number, "
                       "sum({} + CASE parts WHEN 0 THEN 0 ELSE (SELECT sum({}) FROM slipway_jobs AS of_it "
                       "WHERE of_it.whole = slipway_jobs.id) END) OVER newest AS bytes, "
                       "greatest(0, lag(ended_ms, 1, $3) OVER latest - ended_ms) AS gap "
                       "FROM slipway_jobs WHERE state NOT IN ('accepted', 'running') AND whole IS NULL "
                       "WINDOW newest AS (ORDER BY sequence DESC), "
                       "latest AS (ORDER BY ended_ms DESC, sequence)) AS by_gap "
                       "WINDOW latest AS (ORDER BY ended_ms DESC, sequence)) AS ended "
                       "WHERE number > $1 OR bytes > $2 OR age > $4)",
                       own("slipway_jobs"), own("of_it")),
           PostgresValues()
               .number(static_cast<std::int64_t>(kept.most))
               .number(kept.most_bytes)
               .number(now)
               .number(kept.most_age_ms)
               .text(kArtefactMark)
               .number(Retention::kLongestPause_ms)
               .number(kept.counted_pause_ms()))
      .changed();
}

}  // namespace slipway::api
