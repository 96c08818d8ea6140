#include "api/jobs/postgres_job_store.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <mutex>
#include <string>
#include <utility>

#include "api/jobs/job_admission.h"
#include "api/jobs/job_digest.h"
#include "api/jobs/postgres_bell.h"
#include "api/jobs/postgres_job_claims.h"
#include "api/jobs/postgres_job_rows.h"
#include "api/jobs/postgres_job_schema.h"
#include "api/jobs/postgres_pool.h"
#include "core/boot_clock.h"

namespace slipway::api {
namespace {

// What stands in the store before a job is appended, and whether it was.
struct Appended {
  std::int64_t unfinished = 0, of_owner = 0;
  bool made = false;
  std::optional<std::string> known;  // the job of the same key, or of the same id
  bool same_request = false;
};

class PostgresJobStore final : public JobStore {
 public:
  PostgresJobStore(const PostgresAddress& address, const PostgresOptions& options)
      : durable_(address, CommitKind::kDurable, options.deadline),
        quick_(address, CommitKind::kQuick, options.deadline),
        bell_(address) {}

  Result<void> settle() {
    const auto settled = durable_.run([](PostgresConnection& connection) {
      settle_schema(connection);
      return true;
    });
    if (!settled) return fail(settled.error());
    return {};
  }

  Result<Job> append(const NewJob& job, std::int64_t now, const Admission& admission) override {
    int tries = 0;
    std::optional<Result<Job>> accepted;
    const auto done = durable_.run([&](PostgresConnection& connection) {
      const bool may_be_known = ++tries > 1 || job.key;
      accepted.reset();
      while (!accepted) {
        const Appended found = append_where_new(connection, job, now, admission);
        if (found.made)
          accepted = accepted_job(job, now);
        else if (found.known)
          accepted = known_job(connection, *found.known, found.same_request, may_be_known);
        else if (auto refusal = refused_by(admission, found.unfinished, found.of_owner))
          accepted = fail(*std::move(refusal));
        // Otherwise somebody else has accepted the same just now, and it is found the next time.
      }
      return true;
    });
    if (!done) return fail(done.error());
    if (*accepted) bell_.ring(StoreNews::kAccepted);
    return *std::move(accepted);
  }

  // The server's clock, read every few seconds and counted on by this machine's in between.
  Result<std::int64_t> lease_clock() override {
    constexpr std::int64_t kReadAgain_ms = 10'000;
    const std::scoped_lock lock(clock_mutex_);
    if (!clock_read_at_ || boot_ms() - *clock_read_at_ > kReadAgain_ms) {
      const auto ahead = quick_.run([](PostgresConnection& connection) {
        const std::int64_t before = boot_ms();
        const PostgresRows rows = connection.run(
            "SELECT (extract(epoch FROM clock_timestamp()) * 1000)::bigint::text", PostgresValues());
        return std::stoll(rows.text(0, 0)) - (before + boot_ms()) / 2;
      });
      if (!ahead) return fail(ahead.error());
      clock_ahead_ms_ = *ahead;
      clock_read_at_ = boot_ms();
    }
    return boot_ms() + clock_ahead_ms_;
  }

  Result<std::vector<ClaimedJob>> claim_some(std::string_view worker, const std::vector<std::string>& kinds,
                                             std::int64_t now, LeaseTerm term, int most) override {
    auto claimed = quick_.run([&](PostgresConnection& connection) {
      return claim_jobs(connection, worker, kinds, now, term, most);
    });
    return claimed;
  }

  Result<int> give_back(const std::vector<Lease>& leases) override {
    auto given =
        quick_.run([&](PostgresConnection& connection) { return give_back_jobs(connection, leases); });
    if (given && *given > 0) bell_.ring(StoreNews::kAccepted);
    return given;
  }

  Result<bool> report(const Lease& lease, std::string_view stage, double progress, std::int64_t lease_until,
                      std::string_view best_so_far) override {
    return quick_.run([&](PostgresConnection& connection) {
      const PostgresRows rows = connection.run(
          fmt::format(
              "UPDATE slipway_jobs SET version = version + CASE WHEN stage <> $4 OR progress <> $5 OR "
              "$7 <> '' THEN 1 ELSE 0 END, stage = $4, progress = $5, lease_until_ms = $6, "
              "best_so_far = CASE $7 WHEN '' THEN best_so_far ELSE $7 END WHERE {}",
              kHeldRow),
          held(lease).text(stage).real(progress).number(lease_until).text(best_so_far));
      return rows.changed() == 1;
    });
  }

  Result<std::vector<bool>> finish_all(const std::vector<JobEnd>& ends, std::int64_t now) override {
    // The end of a part is nobody's answer yet.
    const bool parts_only =
        std::all_of(ends.begin(), ends.end(), [](const JobEnd& end) { return !end.lease.whole.empty(); });
    const bool one_statement =
        std::all_of(ends.begin(), ends.end(), [](const JobEnd& end) { return end.outcome.series.empty(); });
    bool to_put_together = false;
    auto kept = (parts_only ? quick_ : durable_).run([&](PostgresConnection& connection) {
      if (one_statement) return end_jobs(connection, ends, now, to_put_together);
      PostgresTransaction transaction(connection);
      std::vector<bool> ended = end_jobs(connection, ends, now, to_put_together);
      transaction.commit();
      return ended;
    });
    if (to_put_together) bell_.ring(StoreNews::kAccepted);
    if (kept && !parts_only) bell_.ring(StoreNews::kEnded);
    return kept;
  }

  Result<bool> split(const Lease& lease, const std::vector<std::string>& requests,
                     std::int64_t now) override {
    constexpr int kDeadlinesOfSplit = 4;  // thousands of rows, for which no client waits
    auto kept = quick_.run(
        [&](PostgresConnection& connection) {
          PostgresTransaction transaction(connection);
          const bool held = split_job(connection, lease, requests, now);
          transaction.commit();
          return held;
        },
        kDeadlinesOfSplit);
    if (kept && *kept) bell_.ring(StoreNews::kAccepted);
    return kept;
  }

  Result<std::vector<Job>> parts(std::string_view id) override {
    return quick_.run([&](PostgresConnection& connection) {
      return told_jobs(
          connection.run(fmt::format("SELECT {} FROM slipway_jobs WHERE whole = $1 ORDER BY part", kJobRow),
                         PostgresValues().text(id)));
    });
  }

  Result<int> release(std::string_view worker, HandBack why, std::string_view reason) override {
    auto released = quick_.run([&](PostgresConnection& connection) {
      const PostgresRows rows = connection.run(
          "UPDATE slipway_jobs SET state = 'accepted', deaths = deaths + $2, "
          "last_death = CASE $2 WHEN 1 THEN $3 ELSE last_death END, version = version + 1, worker = NULL "
          "WHERE state = 'running' AND (worker = $1 OR starts_with(worker, $4))",
          PostgresValues()
              .text(worker)
              .number(why == HandBack::kDied ? 1 : 0)
              .text(reason)
              .text(std::string(worker) + "/"));
      return rows.changed();
    });
    if (released && *released > 0) bell_.ring(StoreNews::kAccepted);
    return released;
  }

  Result<std::optional<Job>> dismiss(std::string_view id, std::int64_t now) override {
    auto job = durable_.run([&](PostgresConnection& connection) {
      PostgresTransaction transaction(connection);
      dismiss_job(connection, id, now);
      std::optional<Job> dismissed = told_from(connection, id);
      transaction.commit();
      return dismissed;
    });
    if (job && *job) bell_.ring((*job)->whole.empty() ? StoreNews::kEnded : StoreNews::kAccepted);
    return job;
  }

  Result<std::optional<Job>> get(std::string_view id) override {
    return quick_.run([&](PostgresConnection& connection) { return told_from(connection, id); });
  }

  Result<std::optional<std::string>> request(std::string_view id) override {
    return quick_.run([&](PostgresConnection& connection) -> std::optional<std::string> {
      const PostgresRows rows = connection.run(
          "SELECT request, request_sha256, kind FROM slipway_jobs WHERE id = $1", PostgresValues().text(id));
      if (rows.count() == 0) return std::nullopt;
      std::string bytes = rows.text(0, 0);
      if (rows.text(0, 1) != request_digest(id, rows.text(0, 2), bytes))
        throw PostgresDamage(fmt::format("what is stored of job {} is not what was asked: ask again", id));
      return bytes;
    });
  }

  Result<std::optional<std::string>> outcome(std::string_view id) override {
    return quick_.run([&](PostgresConnection& connection) -> std::optional<std::string> {
      const PostgresRows rows = connection.run(
          "SELECT outcome, outcome_sha256, state FROM slipway_jobs WHERE id = $1 AND state IN ('successful', "
          "'failed')",
          PostgresValues().text(id));
      if (rows.count() == 0) return std::nullopt;
      std::string bytes = rows.text(0, 0);
      if (rows.text(0, 1) != outcome_digest(id, rows.text(0, 2), bytes)) throw_altered(id);
      return bytes;
    });
  }

  Result<std::optional<SeriesPage>> series(std::string_view id, std::int64_t page) override {
    return quick_.run([&](PostgresConnection& connection) -> std::optional<SeriesPage> {
      const PostgresRows rows = connection.run(
          "SELECT bytes, sha256, (SELECT count(*) FROM slipway_series WHERE job_id = $1 AND page = "
          "$2::bigint + 1) "
          "FROM slipway_series WHERE job_id = $1 AND page = $2::bigint",
          PostgresValues().text(id).number(page));
      if (rows.count() == 0) return std::nullopt;
      std::string bytes = rows.text(0, 0);
      if (rows.text(0, 1) != series_digest(id, page, bytes)) throw_altered(id);
      return SeriesPage{.bytes = std::move(bytes), .more = rows.number(0, 2) != 0};
    });
  }

  Result<std::optional<QueuePlace>> place_in_queue(std::string_view id,
                                                   const std::vector<std::string>& kinds) override {
    return quick_.run([&](PostgresConnection& connection) -> std::optional<QueuePlace> {
      PostgresValues values;
      values.text(id);
      if (!kinds.empty()) values.list(kinds);
      if (connection
              .run("SELECT id FROM slipway_jobs WHERE id = $1 AND state = 'accepted'",
                   PostgresValues().text(id))
              .count() == 0)
        return std::nullopt;
      const PostgresRows rows = connection.run(
          fmt::format(
              "WITH own AS (SELECT urgency, sequence FROM slipway_jobs WHERE id = $1), "
              "took AS (SELECT kind, avg(ms)::float8 AS ms FROM (SELECT kind, state, ended_ms - started_ms "
              "AS ms "
              "FROM slipway_jobs WHERE state NOT IN ('accepted', 'running') ORDER BY sequence DESC LIMIT "
              "200) "
              "AS lately WHERE state = 'successful' GROUP BY kind) "
              "SELECT job.state, count(*), min(took.ms) FROM slipway_jobs AS job CROSS JOIN own "
              "LEFT JOIN took ON took.kind = job.kind "
              "WHERE job.state IN ('accepted', 'running') AND (job.state = 'running' OR "
              "(job.urgency, job.sequence) < (own.urgency, own.sequence)) {} GROUP BY job.kind, job.state",
              kinds.empty() ? "" : "AND job.kind = ANY($2::text[])"),
          values);
      QueueSum sum;
      for (int row = 0; row < rows.count(); ++row)
        sum.add(rows.text(row, 0) == "running", static_cast<int>(rows.number(row, 1)),
                rows.is_null(row, 2) ? std::nullopt : std::optional(1e-3 * rows.real(row, 2)));
      return sum.place();
    });
  }

  Result<std::vector<JobCount>> counts() override {
    return quick_.run([&](PostgresConnection& connection) {
      const PostgresRows rows =
          connection.run("SELECT kind, state, count(*) FROM slipway_jobs GROUP BY kind, state");
      std::vector<JobCount> all;
      for (int row = 0; row < rows.count(); ++row)
        if (const auto state = job_state(rows.text(row, 1)))
          all.push_back({rows.text(row, 0), *state, rows.number(row, 2)});
      return all;
    });
  }

  Result<std::vector<Job>> list(std::size_t most) override {
    return quick_.run([&](PostgresConnection& connection) {
      const PostgresRows rows = connection.run(
          fmt::format("SELECT {} FROM slipway_jobs WHERE whole IS NULL ORDER BY sequence DESC LIMIT $1",
                      kJobRow),
          PostgresValues().number(static_cast<std::int64_t>(most)));
      std::vector<Job> jobs;
      for (int row = 0; row < rows.count(); ++row)
        if (is_whole(rows, row)) jobs.push_back(job_of(rows, row));  // a damaged one hides itself alone
      return jobs;
    });
  }

  Result<int> forget_ended(const Retention& kept, std::int64_t now) override {
    return quick_.run([&](PostgresConnection& connection) { return forget_jobs(connection, kept, now); });
  }

  void listen(StoreNews news, std::function<void()> call) override { bell_.listen(news, std::move(call)); }

 private:
  // One statement, which is one transaction.
  static Appended append_where_new(PostgresConnection& connection, const NewJob& job, std::int64_t now,
                                   const Admission& admission) {
    constexpr std::string_view kAppend =
        "WITH known AS MATERIALIZED (SELECT id, kind = $2 AND request = $3 AS same FROM slipway_jobs "
        "WHERE id = $1 OR (owner = $4 AND idempotency_key = $5)), "
        "unfinished AS MATERIALIZED (SELECT count(*) AS n, count(*) FILTER (WHERE owner = $4) AS mine "
        "FROM slipway_jobs WHERE state IN ('accepted', 'running') AND whole IS NULL), "
        "made AS (INSERT INTO slipway_jobs (id, kind, state, created_ms, request, request_sha256, owner, "
        "idempotency_key, urgency) SELECT $1, $2, 'accepted', $6::bigint, $3, $7::text, $4, $5, $8::bigint "
        "FROM unfinished "
        "WHERE n < $9 AND mine < $10 AND NOT EXISTS (SELECT FROM known) ON CONFLICT DO NOTHING RETURNING id) "
        "SELECT n, mine, (SELECT count(*) FROM made), (SELECT id FROM known LIMIT 1), "
        "(SELECT count(*) FROM known WHERE same) FROM unfinished";
    PostgresValues values;
    values.text(job.id).text(job.kind).text(job.request).text(job.owner);
    if (job.key)
      values.text(*job.key);
    else
      values.nothing();
    values.number(now).text(request_digest(job.id, job.kind, job.request)).number(job.urgency);
    constexpr std::size_t kMost = std::numeric_limits<std::int64_t>::max();
    values.number(static_cast<std::int64_t>(std::min(admission.most_unfinished, kMost)));
    values.number(static_cast<std::int64_t>(std::min(admission.most_of_owner, kMost)));
    const PostgresRows rows = connection.run(std::string(kAppend), values);
    Appended found;
    found.unfinished = rows.number(0, 0);
    found.of_owner = rows.number(0, 1);
    found.made = rows.number(0, 2) == 1;
    if (!rows.is_null(0, 3)) found.known = rows.text(0, 3);
    found.same_request = rows.number(0, 4) > 0;
    return found;
  }

  // The answer to a repeated request. Whoever accepted it first may not have heard that the commit took
  // place, as that may still wait for a standby: this one changes the row too, and waits for both.
  static Result<Job> known_job(PostgresConnection& connection, const std::string& id, bool same_request,
                               bool may_repeat) {
    if (!may_repeat) return fail(ErrorCode::kStorage, "the job's id is taken");
    if (!same_request) return fail(another_request());
    connection.run("UPDATE slipway_jobs SET idempotency_key = idempotency_key WHERE id = $1",
                   PostgresValues().text(id));
    std::optional<Job> job = get_from(connection, id);
    if (!job) return fail(ErrorCode::kStorage, "the job was forgotten meanwhile");
    return *std::move(job);
  }

  [[noreturn]] static void throw_altered(std::string_view id) {
    throw PostgresDamage(
        fmt::format("what is stored of job {} is not what it answered: ask for it again", id));
  }

  PostgresPool durable_, quick_;
  PostgresBell bell_;
  std::mutex clock_mutex_;  // guards the server's clock: when it was read, and how far before boot_ms() it is
  std::optional<std::int64_t> clock_read_at_;
  std::int64_t clock_ahead_ms_ = 0;
};

}  // namespace

Result<std::unique_ptr<JobStore>> open_postgres_job_store(const std::string& address,
                                                          const PostgresOptions& options) {
  try {
    const PostgresAddress where(address);
    auto store = std::make_unique<PostgresJobStore>(where, options);
    if (const auto settled = store->settle(); !settled)
      return fail(settled.error().code,
                  fmt::format("the job store {}: {}", where.shown(), settled.error().detail));
    return store;
  } catch (const PostgresFailure& failure) {
    return fail(ErrorCode::kStorage, fmt::format("the job store: {}", failure.what()));
  }
}

}  // namespace slipway::api
