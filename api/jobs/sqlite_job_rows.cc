#include "api/jobs/sqlite_job_rows.h"

#include <fmt/format.h>

#include "api/jobs/artefact_row.h"
#include "api/jobs/job_admission.h"
#include "api/jobs/job_digest.h"

namespace slipway::api {

namespace {

constexpr int kRequestDigestColumn = 22, kOutcomeDigestColumn = 23, kEndDigestColumn = 24;

// A job without a digest has not ended, or did so in an older program.
bool is_as_it_ended(const SqliteStatement& row, const Job& job) {
  const std::string kept = row.text(kEndDigestColumn);
  return kept.empty() || (has_ended(job.state) && kept == end_digest(job, row.text(kRequestDigestColumn),
                                                                     row.text(kOutcomeDigestColumn)));
}

}  // namespace

bool is_whole(const SqliteStatement& row) {
  return job_state(row.text(2)).has_value() && is_as_it_ended(row, job_of(row));
}

Job told_job(const SqliteStatement& row) {
  Job job = job_of(row);
  if (is_as_it_ended(row, job)) return job;
  throw SqliteDamage(altered_end(job.id));
}

void keep_end(SqliteConnection& connection, std::string_view id) {
  auto row = connection.prepare(fmt::format("SELECT {} FROM jobs WHERE id = ?", kJobColumns));
  row.bind(id);
  if (!row.step()) throw SqliteDamage("a job is not found under its id");
  const std::string digest =
      end_digest(job_of(row), row.text(kRequestDigestColumn), row.text(kOutcomeDigestColumn));
  connection.prepare("INSERT OR REPLACE INTO ends (job_id, sha256) VALUES (?, ?)")
      .bind(id)
      .bind(digest)
      .step();
}

Job job_of(const SqliteStatement& row) {
  const auto state = job_state(row.text(2));
  if (!state)
    throw SqliteDamage(
        fmt::format("what is stored of job {} has the state \"{}\", which is none: ask again for "
                    "what it was asked",
                    row.text(0), row.text(2)));
  Job job;
  job.id = row.text(0);
  job.kind = row.text(1);
  job.state = *state;
  job.stage = row.text(3);
  job.progress = row.real(4);
  job.version = row.number(5);
  job.attempt = static_cast<int>(row.number(6));
  job.created_ms = row.number(7);
  job.started_ms = row.optional_number(8);
  job.ended_ms = row.optional_number(9);
  job.deaths = static_cast<int>(row.number(10));
  job.last_death = row.text(11);
  job.urgency = static_cast<int>(row.number(12));
  job.owner = row.text(13);
  job.best_so_far = row.text(14);
  job.cpu_s = row.real(15);
  job.whole = row.text(16);
  job.part = static_cast<int>(row.number(17));
  job.parts = {static_cast<int>(row.number(18)), static_cast<int>(row.number(19)),
               static_cast<int>(row.number(20)), row.real(21)};
  return job;
}

std::optional<Job> get_from(SqliteConnection& connection, std::string_view id) {
  auto row = connection.prepare(fmt::format("SELECT {} FROM jobs WHERE id = ?", kJobColumns));
  row.bind(id);
  return row.step() ? std::optional(job_of(row)) : std::nullopt;
}

std::optional<Job> told_from(SqliteConnection& connection, std::string_view id) {
  auto row = connection.prepare(fmt::format("SELECT {} FROM jobs WHERE id = ?", kJobColumns));
  row.bind(id);
  return row.step() ? std::optional(told_job(row)) : std::nullopt;
}

ClaimedJob claim_one(SqliteConnection& connection, const std::string& id, std::string_view worker,
                     std::int64_t now, std::int64_t lease_until) {
  auto update = connection.prepare(
      "UPDATE jobs SET deaths = deaths + (state = 'running'), "
      "last_death = CASE WHEN state = 'running' THEN ? ELSE last_death END, state = 'running', "
      "started_ms = ?, attempt = attempt + 1, version = version + 1, worker = ?, lease_until_ms = ? "
      "WHERE id = ?");
  update.bind(kLeaseEnded).bind(now).bind(worker).bind(lease_until).bind(id).step();
  auto asked = connection.prepare("SELECT request, request_sha256 FROM jobs WHERE id = ?");
  asked.bind(id);
  std::optional<Job> job = get_from(connection, id);
  if (!job || !asked.step()) throw SqliteDamage("a job is not found under its id");
  ClaimedJob claimed;
  claimed.job = *std::move(job);
  claimed.request = asked.text(0);
  claimed.worker = worker;
  claimed.damaged = asked.text(1) != request_digest(id, claimed.job.kind, claimed.request);
  return claimed;
}

std::vector<std::string> parts_beside(SqliteConnection& connection, const Job& first, int most) {
  std::vector<std::string> ids;
  if (most < 2 || first.whole.empty() || first.deaths > 0) return ids;
  const std::optional<Job> whole = get_from(connection, first.whole);
  if (!whole) throw SqliteDamage("a part's job is not found under its id");
  auto row = connection.prepare(
      "SELECT id FROM jobs WHERE whole = ? AND part > ? AND state = 'accepted' AND deaths = 0 ORDER BY part "
      "LIMIT ?");
  row.bind(first.whole).bind(std::int64_t{first.part});
  row.bind(std::int64_t{parts_at_once(whole->parts, most) - 1});
  while (row.step()) ids.push_back(row.text(0));
  return ids;
}

bool end_job(SqliteConnection& connection, const JobEnd& end, std::int64_t now) {
  const auto& [lease, state, outcome] = end;
  auto update = connection.prepare(fmt::format(
      "UPDATE jobs SET state = ?, outcome = ?, outcome_sha256 = ?, ended_ms = ?, version = version + 1, "
      "cpu_s = ?, progress = CASE WHEN ? THEN 1.0 ELSE progress END, worker = NULL WHERE {}",
      kHeld));
  update.bind(describe(state)).bind(outcome.bytes);
  update.bind(outcome_digest(lease.id, describe(state), outcome.bytes));
  update.bind(now).bind(outcome.cpu_s).bind(std::int64_t{state == JobState::kSuccessful});
  update.bind(lease.id).bind(std::int64_t{lease.attempt}).step();
  const bool held = connection.changes() == 1;
  if (held) keep_end(connection, lease.id);
  for (std::size_t k = 0; held && k < outcome.series.size(); ++k) {
    const std::string& bytes = outcome.series[k];
    auto insert = connection.prepare("INSERT INTO series (job_id, page, bytes, sha256) VALUES (?, ?, ?, ?)");
    insert.bind(lease.id).bind(static_cast<std::int64_t>(k + 1)).bind(bytes);
    insert.bind(series_digest(lease.id, static_cast<std::int64_t>(k + 1), bytes)).step();
  }
  return held;
}

bool split_job(SqliteConnection& connection, const Lease& lease, const std::vector<std::string>& requests,
               std::int64_t now) {
  const int count = static_cast<int>(requests.size());
  auto update = connection.prepare(fmt::format(
      "UPDATE jobs SET parts = ?, parts_ended = 0, stage = ?, progress = 0, version = version + 1, "
      "worker = NULL, lease_until_ms = NULL WHERE {}",
      kHeld));
  update.bind(std::int64_t{count}).bind(stage_of_parts(0, count));
  update.bind(lease.id).bind(std::int64_t{lease.attempt}).step();
  if (connection.changes() != 1) return false;
  const std::optional<Job> whole = get_from(connection, lease.id);
  if (!whole) throw SqliteDamage("a job is not found under its id");
  for (int k = 0; k < count; ++k) {
    const NewJob part = new_part(*whole, requests[static_cast<std::size_t>(k)]);
    auto insert = connection.prepare(
        "INSERT INTO jobs (id, kind, state, created_ms, request, request_sha256, owner, urgency, whole, "
        "part) "
        "VALUES (?, ?, 'accepted', ?, ?, ?, ?, ?, ?, ?)");
    insert.bind(part.id).bind(part.kind).bind(now).bind(part.request);
    insert.bind(request_digest(part.id, part.kind, part.request)).bind(part.owner);
    insert.bind(std::int64_t{part.urgency}).bind(whole->id).bind(std::int64_t{k}).step();
  }
  return true;
}

namespace {

std::vector<std::string> dismissed_parts(SqliteConnection& connection, std::string_view whole) {
  std::vector<std::string> ids;
  auto row = connection.prepare("SELECT id FROM jobs WHERE whole = ? AND state = 'dismissed'");
  row.bind(whole);
  while (row.step()) ids.push_back(row.text(0));
  return ids;
}

}  // namespace

void dismiss_job(SqliteConnection& connection, std::string_view id, std::int64_t now) {
  auto update = connection.prepare(
      "UPDATE jobs SET state = 'dismissed', ended_ms = ?, version = version + 1, worker = NULL "
      "WHERE id = ? AND state IN ('accepted', 'running')");
  update.bind(now).bind(id).step();
  if (connection.changes() != 1) return;
  auto parts = connection.prepare(
      "UPDATE jobs SET state = 'dismissed', ended_ms = ?, version = version + 1, worker = NULL "
      "WHERE whole = ? AND state IN ('accepted', 'running')");
  parts.bind(now).bind(id).step();
  keep_end(connection, id);
  for (const std::string& part : dismissed_parts(connection, id)) keep_end(connection, part);
  const std::optional<Job> job = get_from(connection, id);
  if (job && !job->whole.empty()) count_ended_part(connection, job->whole, false, 0.0);
}

void count_ended_part(SqliteConnection& connection, std::string_view whole, bool well, double cpu_s) {
  auto update = connection.prepare(
      "UPDATE jobs SET parts_ended = parts_ended + 1, parts_failed = parts_failed + ?, "
      "parts_cpu_s = parts_cpu_s + ?, version = version + 1 WHERE id = ? AND state = 'running'");
  update.bind(std::int64_t{!well}).bind(cpu_s).bind(whole).step();
  const std::optional<Job> job = get_from(connection, whole);
  if (!job || job->state != JobState::kRunning) return;
  auto told = connection.prepare("UPDATE jobs SET stage = ?, progress = ?, state = ? WHERE id = ?");
  told.bind(stage_of_parts(job->parts.ended, job->parts.count));
  told.bind(progress_of_parts(job->parts.ended, job->parts.count));
  told.bind(describe(job->parts.ended < job->parts.count ? JobState::kRunning : JobState::kAccepted));
  told.bind(whole).step();
}

int forget_jobs(SqliteConnection& connection, const Retention& kept, std::int64_t now) {
  // Bytes are counted in blobs: of a text length() counts characters, and none behind a zero. Those of a
  // row's pages count wherever they are.
  const auto own = [](std::string_view job) {
    return fmt::format(
        "length(CAST({0}.request AS BLOB)) + coalesce(length(CAST({0}.outcome AS BLOB)), 0) + "
        "coalesce((SELECT sum(CASE WHEN length(page) = {1} AND substr(page, 1, {2}) = CAST(?1 AS BLOB) THEN "
        "CAST(CAST(substr(page, {3}) AS TEXT) AS INTEGER) ELSE length(page) END) FROM "
        "(SELECT CAST(bytes AS BLOB) AS page FROM series WHERE job_id = {0}.id)), 0)",
        job, kArtefactRowBytes, kArtefactMark.size(), kArtefactMark.size() + kArtefactNameDigits + 1);
  };
  auto erase = connection.prepare(fmt::format(
      "DELETE FROM jobs WHERE sequence IN (SELECT sequence FROM ("
      "SELECT sequence, number, bytes, sum(CASE WHEN gap > ?6 THEN ?7 ELSE gap END) OVER latest AS age FROM ("
      "SELECT sequence, ended_ms, row_number() OVER newest AS number, sum({} + CASE parts WHEN 0 THEN 0 ELSE "
      "(SELECT sum({}) FROM jobs AS part_of_it WHERE part_of_it.whole = jobs.id) END) OVER newest AS bytes, "
      "max(0, lag(ended_ms, 1, ?4) OVER latest - ended_ms) AS gap "
      "FROM jobs WHERE state NOT IN ('accepted', 'running') AND whole IS NULL "
      "WINDOW newest AS (ORDER BY sequence DESC), latest AS (ORDER BY ended_ms DESC, sequence)) "
      "WINDOW latest AS (ORDER BY ended_ms DESC, sequence)) "
      "WHERE number > ?2 OR bytes > ?3 OR age > ?5)",
      own("jobs"), own("part_of_it")));
  erase.bind(kArtefactMark).bind(static_cast<std::int64_t>(kept.most)).bind(kept.most_bytes);
  erase.bind(now)
      .bind(kept.most_age_ms)
      .bind(Retention::kLongestPause_ms)
      .bind(kept.counted_pause_ms())
      .step();
  return connection.changes();
}

}  // namespace slipway::api
