#include "api/jobs/sqlite_job_store.h"

#include <fmt/format.h>

#include <condition_variable>
#include <mutex>
#include <utility>

#include "api/jobs/sqlite_connection.h"
#include "api/jobs/sqlite_job_schema.h"

namespace slipway::api {
namespace {

constexpr std::string_view kJobColumns =
    "id, kind, state, stage, progress, version, attempt, created_ms, started_ms, ended_ms, deaths";
constexpr std::string_view kHeld = "id = ? AND attempt = ? AND state = 'running'";

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
  return job;
}

std::optional<Job> get_from(SqliteConnection& connection, std::string_view id) {
  auto row = connection.prepare(fmt::format("SELECT {} FROM jobs WHERE id = ?", kJobColumns));
  row.bind(id);
  return row.step() ? std::optional(job_of(row)) : std::nullopt;
}

// Runs `work` on a connection that only one thread at a time may use.
template <class Work>
auto guarded(std::mutex& mutex, const Work& work) -> Result<decltype(work())> {
  const std::scoped_lock lock(mutex);
  try {
    return work();
  } catch (const SqliteFull& failure) {
    return fail(ErrorCode::kStorageFull, failure.what());
  } catch (const SqliteDamage& failure) {
    return fail(ErrorCode::kDamagedStore, failure.what());
  } catch (const SqliteFailure& failure) {
    return fail(ErrorCode::kStorage, failure.what());
  }
}

class SqliteJobStore final : public JobStore {
 public:
  explicit SqliteJobStore(const std::filesystem::path& path)
      : durable_(path, CommitKind::kDurable),
        quick_(path, CommitKind::kQuick),
        reader_(path, CommitKind::kQuick) {
    settle_schema(durable_, path);
  }

  // The first of those that wait commits for all of them: a disk does few commits a second, however large.
  Result<Job> append(const NewJob& job, std::int64_t now, std::size_t most_unfinished) override {
    PendingAppend mine{job, now, most_unfinished, std::nullopt};
    std::unique_lock lock(append_mutex_);
    pending_.push_back(&mine);
    while (!mine.answer) {
      if (committing_) {
        appended_.wait(lock);
        continue;
      }
      committing_ = true;
      const std::vector<PendingAppend*> batch = std::exchange(pending_, {});
      lock.unlock();
      std::vector<Result<Job>> answers = append_batch(batch);
      lock.lock();
      for (std::size_t i = 0; i < batch.size(); ++i) batch[i]->answer = std::move(answers[i]);
      committing_ = false;
      appended_.notify_all();
    }
    return *mine.answer;
  }

  Result<std::optional<ClaimedJob>> claim(std::string_view worker, const std::vector<std::string>& kinds,
                                          std::int64_t now, std::int64_t lease_until) override {
    return guarded(write_mutex_, [&]() -> std::optional<ClaimedJob> {
      std::string places;
      for (std::size_t i = 0; i < kinds.size(); ++i) places += i == 0 ? "?" : ", ?";
      const std::string of_kind = kinds.empty() ? "" : fmt::format("AND kind IN ({}) ", places);
      SqliteTransaction transaction(quick_);
      auto next = quick_.prepare(fmt::format(
          "SELECT id, request, request_sha256, kind FROM jobs WHERE state IN ('accepted', 'running') AND "
          "(state = 'accepted' OR lease_until_ms < ?) {}ORDER BY sequence LIMIT 1",
          of_kind));
      next.bind(now);
      for (const std::string& kind : kinds) next.bind(kind);
      if (!next.step()) return std::nullopt;
      ClaimedJob claimed;
      const std::string id = next.text(0);
      claimed.request = next.text(1);
      claimed.damaged = next.text(2) != request_digest(id, next.text(3), claimed.request);
      auto update = quick_.prepare(
          "UPDATE jobs SET deaths = deaths + (state = 'running'), state = 'running', started_ms = ?, "
          "attempt = attempt + 1, version = version + 1, "
          "worker = ?, lease_until_ms = ? WHERE id = ?");
      update.bind(now).bind(worker).bind(lease_until).bind(id).step();
      const std::optional<Job> job = get_from(quick_, id);
      if (!job) throw SqliteDamage("a job is not found under its id");
      claimed.job = *job;
      transaction.commit();
      return claimed;
    });
  }

  Result<bool> report(const Lease& lease, std::string_view stage, double progress,
                      std::int64_t lease_until) override {
    return guarded(write_mutex_, [&] {
      auto update = quick_.prepare(fmt::format(
          "UPDATE jobs SET version = version + (stage <> ? OR progress <> ?), stage = ?, progress = ?, "
          "lease_until_ms = ? WHERE {}",
          kHeld));
      update.bind(stage).bind(progress).bind(stage).bind(progress).bind(lease_until);
      update.bind(lease.id).bind(std::int64_t{lease.attempt}).step();
      return quick_.changes() == 1;
    });
  }

  Result<bool> finish(const Lease& lease, JobState state, std::string_view outcome,
                      std::int64_t now) override {
    return guarded(write_mutex_, [&] {
      auto update = durable_.prepare(fmt::format(
          "UPDATE jobs SET state = ?, outcome = ?, outcome_sha256 = ?, ended_ms = ?, version = version + 1, "
          "progress = CASE WHEN ? THEN 1.0 ELSE progress END, worker = NULL WHERE {}",
          kHeld));
      update.bind(describe(state)).bind(outcome).bind(outcome_digest(lease.id, describe(state), outcome));
      update.bind(now).bind(std::int64_t{state == JobState::kSuccessful});
      update.bind(lease.id).bind(std::int64_t{lease.attempt}).step();
      return durable_.changes() == 1;
    });
  }

  Result<int> release(std::string_view worker, HandBack why) override {
    return guarded(write_mutex_, [&] {
      auto update = quick_.prepare(
          "UPDATE jobs SET state = 'accepted', deaths = deaths + ?, version = version + 1, worker = NULL "
          "WHERE state = 'running' AND worker = ?");
      update.bind(std::int64_t{why == HandBack::kDied}).bind(worker).step();
      return quick_.changes();
    });
  }

  Result<std::optional<Job>> dismiss(std::string_view id, std::int64_t now) override {
    return guarded(write_mutex_, [&] {
      auto update = durable_.prepare(
          "UPDATE jobs SET state = 'dismissed', ended_ms = ?, version = version + 1, worker = NULL "
          "WHERE id = ? AND state IN ('accepted', 'running')");
      update.bind(now).bind(id).step();
      return get_from(durable_, id);
    });
  }

  Result<std::optional<Job>> get(std::string_view id) override {
    return guarded(read_mutex_, [&] { return get_from(reader_, id); });
  }

  Result<std::optional<std::string>> request(std::string_view id) override {
    return guarded(read_mutex_, [&]() -> std::optional<std::string> {
      auto row = reader_.prepare("SELECT request, request_sha256, kind FROM jobs WHERE id = ?");
      row.bind(id);
      if (!row.step()) return std::nullopt;
      std::string bytes = row.text(0);
      if (row.text(1) != request_digest(id, row.text(2), bytes))
        throw SqliteDamage(fmt::format("what is stored of job {} is not what was asked: ask again", id));
      return bytes;
    });
  }

  Result<std::optional<std::string>> outcome(std::string_view id) override {
    return guarded(read_mutex_, [&]() -> std::optional<std::string> {
      auto row = reader_.prepare(
          "SELECT outcome, outcome_sha256, state FROM jobs WHERE id = ? AND state IN ('successful', "
          "'failed')");
      row.bind(id);
      if (!row.step()) return std::nullopt;
      std::string bytes = row.text(0);
      if (row.text(1) != outcome_digest(id, row.text(2), bytes))
        throw SqliteDamage(
            fmt::format("what is stored of job {} is not what it answered: ask for it again", id));
      return bytes;
    });
  }

  Result<std::vector<Job>> list(std::size_t most) override {
    return guarded(read_mutex_, [&] {
      std::vector<Job> jobs;
      auto row =
          reader_.prepare(fmt::format("SELECT {} FROM jobs ORDER BY sequence DESC LIMIT ?", kJobColumns));
      row.bind(static_cast<std::int64_t>(most));
      while (row.step()) jobs.push_back(job_of(row));
      return jobs;
    });
  }

  Result<int> forget_ended(const Retention& kept, std::int64_t now) override {
    return guarded(write_mutex_, [&] {
      auto erase = quick_.prepare(
          "DELETE FROM jobs WHERE sequence IN (SELECT sequence FROM ("
          "SELECT sequence, ended_ms, row_number() OVER newest AS number, "
          "sum(length(request) + coalesce(length(outcome), 0)) OVER newest AS bytes "
          "FROM jobs WHERE state NOT IN ('accepted', 'running') WINDOW newest AS (ORDER BY sequence DESC)) "
          "WHERE number > ? OR bytes > ? OR ? - ended_ms > ?)");
      erase.bind(static_cast<std::int64_t>(kept.most)).bind(kept.most_bytes).bind(now).bind(kept.most_age_ms);
      erase.step();
      const int forgotten = quick_.changes();
      if (forgotten > 0) quick_.execute("PRAGMA incremental_vacuum");
      return forgotten;
    });
  }

 private:
  struct PendingAppend {
    const NewJob& job;
    std::int64_t now;
    std::size_t most_unfinished;
    std::optional<Result<Job>> answer;
  };

  std::vector<Result<Job>> append_batch(const std::vector<PendingAppend*>& batch) {
    auto answers = guarded(write_mutex_, [&] {
      std::vector<Result<Job>> all;
      SqliteTransaction transaction(durable_);
      auto count = durable_.prepare("SELECT count(*) FROM jobs WHERE state IN ('accepted', 'running')");
      count.step();
      auto unfinished = static_cast<std::size_t>(count.number(0));
      for (const PendingAppend* pending : batch) {
        if (unfinished >= pending->most_unfinished) {
          all.push_back(fail(ErrorCode::kTooManyJobs,
                             fmt::format("{} jobs are waiting or running already", unfinished)));
          continue;
        }
        auto insert = durable_.prepare(
            "INSERT INTO jobs (id, kind, state, created_ms, request, request_sha256) "
            "VALUES (?, ?, 'accepted', ?, ?, ?)");
        insert.bind(pending->job.id)
            .bind(pending->job.kind)
            .bind(pending->now)
            .bind(pending->job.request)
            .bind(request_digest(pending->job.id, pending->job.kind, pending->job.request))
            .step();
        Job job;
        job.id = pending->job.id;
        job.kind = pending->job.kind;
        job.created_ms = pending->now;
        all.push_back(std::move(job));
        ++unfinished;
      }
      transaction.commit();
      return all;
    });
    if (answers) return std::move(*answers);
    // One id that is taken undoes the batch: with 128 random bits that is a caller's mistake, not luck.
    return {batch.size(), Result<Job>(fail(answers.error()))};
  }

  std::mutex write_mutex_;  // durable_, quick_: SQLite has one writer at a time anyway
  SqliteConnection durable_;
  SqliteConnection quick_;
  std::mutex read_mutex_;  // pollers do not wait for the disk
  SqliteConnection reader_;

  std::mutex append_mutex_;
  std::condition_variable appended_;
  std::vector<PendingAppend*> pending_;
  bool committing_ = false;
};

}  // namespace

Result<std::unique_ptr<JobStore>> open_sqlite_job_store(const std::filesystem::path& path) {
  try {
    check_marker(path);
    return std::make_unique<SqliteJobStore>(path);
  } catch (const SqliteFull& failure) {
    return fail(ErrorCode::kStorageFull, fmt::format("the job store {}: {}", path.string(), failure.what()));
  } catch (const SqliteFailure& failure) {
    const std::string words = failure.what();
    const bool names_it = words.find(path.string()) != std::string::npos;
    return fail(ErrorCode::kStorage,
                names_it ? words : fmt::format("the job store {}: {}", path.string(), words));
  }
}

}  // namespace slipway::api
