#include "api/jobs/sqlite_job_rows.h"

#include <fmt/format.h>

#include "api/jobs/job_admission.h"
#include "api/jobs/job_digest.h"

namespace slipway::api {

Job job_of(const SqliteStatement& row) {
  const auto state = job_state(row.text(2));
  if (!state) throw SqliteFailure("a job has a state that is none");
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

bool end_job(SqliteConnection& connection, const Lease& lease, JobState state, const JobAnswer& outcome,
             std::int64_t now) {
  auto update = connection.prepare(fmt::format(
      "UPDATE jobs SET state = ?, outcome = ?, outcome_sha256 = ?, ended_ms = ?, version = version + 1, "
      "cpu_s = ?, progress = CASE WHEN ? THEN 1.0 ELSE progress END, worker = NULL WHERE {}",
      kHeld));
  update.bind(describe(state)).bind(outcome.bytes);
  update.bind(outcome_digest(lease.id, describe(state), outcome.bytes));
  update.bind(now).bind(outcome.cpu_s).bind(std::int64_t{state == JobState::kSuccessful});
  update.bind(lease.id).bind(std::int64_t{lease.attempt}).step();
  const bool held = connection.changes() == 1;
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

}  // namespace slipway::api
