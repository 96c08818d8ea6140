#include "api/jobs/postgres_job_schema.h"

#include <fmt/format.h>

#include <array>

namespace slipway::api {
namespace {

constexpr std::int64_t kSchemaVersion = 1;

// Times are milliseconds since 1970 by the clocks of those who ask, as in every store. A page has room for
// new versions of its rows, and rows that change all the time are vacuumed often.
constexpr std::array kTables{
    R"(CREATE TABLE slipway_jobs (
  sequence bigint GENERATED ALWAYS AS IDENTITY PRIMARY KEY,
  id text NOT NULL UNIQUE,
  kind text NOT NULL,
  state text NOT NULL CHECK (state IN ('accepted', 'running', 'successful', 'failed', 'dismissed')),
  stage text NOT NULL DEFAULT '',
  progress double precision NOT NULL DEFAULT 0,
  version bigint NOT NULL DEFAULT 1,
  attempt bigint NOT NULL DEFAULT 0,
  created_ms bigint NOT NULL,
  started_ms bigint,
  ended_ms bigint,
  worker text,
  lease_until_ms bigint,
  request bytea NOT NULL,
  request_sha256 text NOT NULL,
  outcome bytea,
  outcome_sha256 text,
  deaths bigint NOT NULL DEFAULT 0,
  last_death text NOT NULL DEFAULT '',
  best_so_far text NOT NULL DEFAULT '',
  owner text NOT NULL DEFAULT '',
  idempotency_key text,
  urgency bigint NOT NULL,
  cpu_s double precision NOT NULL DEFAULT 0,
  whole text REFERENCES slipway_jobs (id) ON DELETE CASCADE,
  part bigint NOT NULL DEFAULT 0,
  parts bigint NOT NULL DEFAULT 0,
  parts_ended bigint NOT NULL DEFAULT 0,
  parts_failed bigint NOT NULL DEFAULT 0,
  parts_cpu_s double precision NOT NULL DEFAULT 0,
  end_sha256 text
) WITH (fillfactor = 70, autovacuum_vacuum_scale_factor = 0.02, autovacuum_vacuum_threshold = 200))",
    "CREATE UNIQUE INDEX slipway_jobs_keys ON slipway_jobs (owner, idempotency_key) "
    "WHERE idempotency_key IS NOT NULL",
    "CREATE INDEX slipway_jobs_waiting ON slipway_jobs (urgency, sequence) WHERE state = 'accepted'",
    "CREATE INDEX slipway_jobs_leased ON slipway_jobs (lease_until_ms) WHERE state = 'running'",
    "CREATE INDEX slipway_jobs_ended ON slipway_jobs (sequence) WHERE state NOT IN ('accepted', 'running')",
    "CREATE INDEX slipway_jobs_parts ON slipway_jobs (whole, part) WHERE whole IS NOT NULL",
    R"(CREATE TABLE slipway_series (
  job_id text NOT NULL REFERENCES slipway_jobs (id) ON DELETE CASCADE,
  page bigint NOT NULL,
  bytes bytea NOT NULL,
  sha256 text NOT NULL,
  PRIMARY KEY (job_id, page)
))",
    "CREATE TABLE slipway_schema (version bigint NOT NULL)"};

void make_tables(PostgresConnection& connection) {
  for (const char* const table : kTables) connection.run(table);
  connection.run("INSERT INTO slipway_schema (version) VALUES ($1)", PostgresValues().number(kSchemaVersion));
}

// How jobs ended, in digests. Beside the versions: a program that does not know it does without.
void make_room_for_ends(PostgresConnection& connection) {
  const PostgresRows found = connection.run(
      "SELECT attname::text FROM pg_attribute WHERE attrelid = to_regclass('slipway_jobs') AND "
      "attname = 'end_sha256' AND NOT attisdropped");
  if (found.count() == 0) connection.run("ALTER TABLE slipway_jobs ADD COLUMN end_sha256 text");
}

}  // namespace

void settle_schema(PostgresConnection& connection) {
  PostgresTransaction transaction(connection);
  connection.run("SELECT pg_advisory_xact_lock(hashtext('slipway_schema'))::text");
  if (connection.run("SELECT to_regclass('slipway_schema')::text").is_null(0, 0)) make_tables(connection);
  const PostgresRows found = connection.run("SELECT version FROM slipway_schema");
  if (found.count() != 1 || found.number(0, 0) > kSchemaVersion)
    throw PostgresFailure(fmt::format(
        "the database's tables of jobs are of a newer program (version {}, this one reads {}); use that "
        "program, or name another database with --jobs",
        found.count() == 1 ? found.number(0, 0) : 0, kSchemaVersion));
  make_room_for_ends(connection);
  transaction.commit();
}

}  // namespace slipway::api
