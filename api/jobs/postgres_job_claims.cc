#include "api/jobs/postgres_job_claims.h"

#include <fmt/format.h>

#include <algorithm>

#include "api/jobs/job_admission.h"
#include "api/jobs/job_digest.h"
#include "api/jobs/postgres_job_rows.h"

namespace slipway::api {
namespace {

// The first that waits and the first that is late are found by an index of their own each. LIMIT holds within
// each, as they are materialised. {0} bounds the kinds.
constexpr std::string_view kFirst =
    "waiting AS MATERIALIZED (SELECT sequence, urgency, whole, deaths, false AS is_late FROM slipway_jobs "
    "WHERE state = 'accepted' AND ended_ms IS NULL {0} ORDER BY urgency, sequence LIMIT 1 FOR UPDATE SKIP "
    "LOCKED), "
    "late AS MATERIALIZED (SELECT sequence, urgency, whole, deaths, true AS is_late FROM slipway_jobs "
    "WHERE state = 'running' AND lease_until_ms < $5 AND ended_ms IS NULL {0} ORDER BY urgency, sequence "
    "LIMIT 1 "
    "FOR UPDATE SKIP LOCKED), "
    "first AS MATERIALIZED (SELECT * FROM (TABLE waiting UNION ALL TABLE late) AS either "
    "ORDER BY urgency, sequence LIMIT 1)";

// The parts behind it. Those of one job were inserted together, so that they are near each other in the
// sequence: who looks no farther passes over few rows of others. Bounds that are subqueries are looked up
// before the index is, which then is entered at the right place. {0} is the reach, {1} the share at once.
constexpr std::string_view kBeside =
    ", beside AS MATERIALIZED (SELECT sequence FROM slipway_jobs WHERE state = 'accepted' AND "
    "urgency = (SELECT urgency FROM first) AND sequence > (SELECT sequence FROM first) AND "
    "sequence < (SELECT sequence FROM first) + {0} AND "
    "whole = (SELECT whole FROM first WHERE NOT is_late AND deaths = 0) AND deaths = 0 "
    "ORDER BY urgency, sequence LIMIT greatest(0, least($6::bigint, (SELECT (parts - parts_ended) / {1} "
    "FROM slipway_jobs WHERE id = (SELECT whole FROM first))) - 1) FOR UPDATE SKIP LOCKED)";

constexpr std::string_view kClaim =
    "UPDATE slipway_jobs SET deaths = deaths + CASE state WHEN 'running' THEN 1 ELSE 0 END, "
    "last_death = CASE state WHEN 'running' THEN $2 ELSE last_death END, state = 'running', "
    "best_so_far = '', started_ms = $1, attempt = attempt + 1, version = version + 1, worker = $3, "
    "lease_until_ms = $4 FROM ({0}) AS chosen (its_sequence) WHERE sequence = its_sequence "
    "RETURNING {1}, request, request_sha256";

std::string claim_statement(bool of_some_kinds, bool several) {
  constexpr int kReachPerJob = 4;
  std::string sql =
      "WITH " +
      fmt::format(kFirst, of_some_kinds ? fmt::format("AND kind = ANY(${}::text[])", several ? 7 : 6) : "");
  if (several) sql += fmt::format(kBeside, fmt::format("{} * $6::bigint", kReachPerJob), kShareAtOnce);
  return sql + " " +
         fmt::format(kClaim,
                     several ? "SELECT sequence FROM first UNION ALL SELECT sequence FROM beside"
                             : "SELECT sequence FROM first",
                     kJobRow);
}

}  // namespace

std::vector<ClaimedJob> claim_jobs(PostgresConnection& connection, std::string_view worker,
                                   const std::vector<std::string>& kinds, std::int64_t now, LeaseTerm term,
                                   int most) {
  PostgresValues values;
  values.number(now).text(kLeaseEnded).text(worker).number(term.until).number(term.now);
  if (most > 1) values.number(most);
  if (!kinds.empty()) values.list(kinds);
  const PostgresRows rows = connection.run(claim_statement(!kinds.empty(), most > 1), values);
  std::vector<ClaimedJob> all;
  for (int row = 0; row < rows.count(); ++row) {
    ClaimedJob& claimed = all.emplace_back();
    claimed.job = job_of(rows, row);
    claimed.request = rows.text(row, kJobRowColumns);
    claimed.worker = worker;
    claimed.damaged = rows.text(row, kJobRowColumns + 1) !=
                      request_digest(claimed.job.id, claimed.job.kind, claimed.request);
  }
  // An update returns its rows in no order.
  std::sort(all.begin(), all.end(),
            [](const ClaimedJob& a, const ClaimedJob& b) { return a.job.part < b.job.part; });
  return all;
}

int give_back_jobs(PostgresConnection& connection, const std::vector<Lease>& leases) {
  std::vector<std::string> ids, attempts, workers;
  for (const Lease& lease : leases) {
    ids.push_back(lease.id);
    attempts.push_back(fmt::format("{}", lease.attempt));
    workers.push_back(lease.worker);
  }
  return connection
      .run(
          "UPDATE slipway_jobs AS job SET state = 'accepted', version = version + 1, worker = NULL "
          "FROM unnest($1::text[], $2::bigint[], $3::text[]) AS held (id, attempt, worker) "
          "WHERE job.id = held.id AND job.attempt = held.attempt AND job.worker = held.worker AND "
          "job.state = 'running'",
          PostgresValues().list(ids).list(attempts).list(workers))
      .changed();
}

}  // namespace slipway::api
