#include "api/jobs/sqlite_job_store.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <mutex>
#include <utility>

#include "api/jobs/job_admission.h"
#include "api/jobs/job_digest.h"
#include "api/jobs/sqlite_connection.h"
#include "api/jobs/sqlite_job_rows.h"
#include "api/jobs/sqlite_job_schema.h"
#include "core/boot_clock.h"
#include "core/file_descriptor.h"

namespace slipway::api {
namespace {

// "AND kind IN (?, ?)"; nothing where any kind will do.
std::string among(const std::vector<std::string>& kinds) {
  std::string places;
  for (std::size_t i = 0; i < kinds.size(); ++i) places += i == 0 ? "?" : ", ?";
  return kinds.empty() ? "" : fmt::format("AND kind IN ({})", places);
}

// A file of blocks beside the store's, of which a part is given back where a full disk would not let somebody
// free it. Somebody else may take what is given: so it is little at a time. Thread-safe.
class DiskReserve {
 public:
  // An empty path keeps none.
  explicit DiskReserve(std::string path) : path_(std::move(path)) {}

  // As much of it as the disk has room for.
  void keep() {
    const std::scoped_lock lock(mutex_);
    fill();
  }
  // Where a part has been given and there may be room again.
  void keep_again() {
    if (is_whole_) return;
    const std::unique_lock lock(mutex_, std::try_to_lock);  // a reader does not wait for a disk
    if (lock) fill();
  }
  // The answer of `work`, for which a part more is given while it is `is_short` of room.
  template <class Work, class IsShort>
  auto give_to(const Work& work, const IsShort& is_short) -> decltype(work()) {
    const std::scoped_lock lock(mutex_);
    auto done = work();
    for (bool given = true; given && is_short(done);) {
      given = give_part();
      if (given) done = work();
    }
    fill();
    return done;
  }

 private:
  static constexpr std::int64_t kBytes = std::int64_t{4} << 20U, kPart = std::int64_t{64} << 10U;

  FileDescriptor open() const {
    constexpr int kOwnersAlone = 0600;
    return FileDescriptor(path_.empty() ? -1
                                        : ::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, kOwnersAlone));
  }
  void fill() {
    const FileDescriptor file = open();
    std::int64_t bytes = file.is_open() ? ::lseek(file.fd(), 0, SEEK_END) : kBytes;
    while (bytes >= 0 && bytes < kBytes && ::posix_fallocate(file.fd(), bytes, kPart) == 0) bytes += kPart;
    is_whole_ = bytes >= kBytes;
  }
  bool give_part() const {
    const FileDescriptor file = open();
    const std::int64_t bytes = file.is_open() ? ::lseek(file.fd(), 0, SEEK_END) : 0;
    return bytes > 0 && ::ftruncate(file.fd(), std::max(std::int64_t{0}, bytes - kPart)) == 0;
  }

  std::string path_;
  std::mutex mutex_;
  std::atomic<bool> is_whole_ = true;
};

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
  SqliteJobStore(const std::filesystem::path& path, StoreCheck how_far)
      : path_(path),
        durable_(path, CommitKind::kDurable),
        second_(quick_to(path)),
        third_(quick_to(path)),
        reserve_(path.empty() ? "" : path.string() + ".reserve") {
    settle_schema(durable_, path, how_far);
    opened_ = file_at(path_);
    if (how_far == StoreCheck::kWhole) reserve_.keep();
  }

  // The first of those that wait commits for all of them: a disk does few commits a second, however large.
  Result<Job> append(const NewJob& job, std::int64_t now, const Admission& admission) override {
    if (const auto there = in_place(); !there) return fail(there.error());
    PendingAppend mine{job, now, admission, std::nullopt};
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

  Result<void> in_place() override {
    if (!opened_ || file_at(path_) == opened_) return {};
    return fail(ErrorCode::kStorage,
                fmt::format("the job store {} was moved, removed or replaced while it was open, and what is "
                            "written now would be lost: put its file back, or start the service anew",
                            path_.string()));
  }

  Result<std::int64_t> lease_clock() override { return boot_ms(); }

  Result<std::vector<ClaimedJob>> claim_some(std::string_view worker, const std::vector<std::string>& kinds,
                                             std::int64_t now, LeaseTerm term, int most) override {
    // The index of unfinished jobs says which there are. A bad disk may have left one there that ended, which
    // its own row knows.
    const std::string next = fmt::format(
        "SELECT id FROM jobs WHERE state IN ('accepted', 'running') AND (state = 'accepted' OR "
        "lease_until_ms < ?) AND ended_ms IS NULL {} ORDER BY urgency, sequence LIMIT 1",
        among(kinds));
    const auto found_by = [&](SqliteConnection& connection) -> std::optional<std::string> {
      auto row = connection.prepare(next);
      row.bind(term.now);
      for (const std::string& kind : kinds) row.bind(kind);
      return row.step() ? std::optional(row.text(0)) : std::nullopt;
    };
    // Idle workers of several processes ask all the time: who finds nothing has locked nothing.
    const auto any = guarded(read_mutex_, [&] { return found_by(reader_).has_value(); });
    if (!any) return fail(any.error());
    if (!*any) return std::vector<ClaimedJob>{};
    return guarded(write_mutex_, [&] {
      std::vector<ClaimedJob> claimed;
      SqliteTransaction transaction(quick_);
      const std::optional<std::string> id = found_by(quick_);
      if (!id) return claimed;
      claimed.push_back(claim_one(quick_, *id, worker, now, term.until));
      for (const std::string& part : parts_beside(quick_, claimed.front().job, most))
        claimed.push_back(claim_one(quick_, part, worker, now, term.until));
      transaction.commit();
      return claimed;
    });
  }

  Result<int> give_back(const std::vector<Lease>& leases) override {
    return guarded(write_mutex_, [&] {
      SqliteTransaction transaction(quick_);
      int count = 0;
      for (const Lease& lease : leases) {
        auto update = quick_.prepare(fmt::format(
            "UPDATE jobs SET state = 'accepted', version = version + 1, worker = NULL WHERE {}", kHeld));
        update.bind(lease.id).bind(std::int64_t{lease.attempt}).step();
        count += quick_.changes();
      }
      transaction.commit();
      return count;
    });
  }

  Result<bool> report(const Lease& lease, std::string_view stage, double progress, std::int64_t lease_until,
                      std::string_view best_so_far) override {
    return guarded(write_mutex_, [&] {
      SqliteTransaction transaction(quick_);
      auto update = quick_.prepare(fmt::format(
          "UPDATE jobs SET version = version + (stage <> ? OR progress <> ? OR ?), stage = ?, progress = ?, "
          "lease_until_ms = ? WHERE {}",
          kHeld));
      update.bind(stage).bind(progress).bind(std::int64_t{!best_so_far.empty()});
      update.bind(stage).bind(progress).bind(lease_until);
      update.bind(lease.id).bind(std::int64_t{lease.attempt}).step();
      const bool held = quick_.changes() == 1;
      if (held && !best_so_far.empty()) {
        auto found =
            quick_.prepare("INSERT OR REPLACE INTO best_so_far (job_id, attempt, document) VALUES (?, ?, ?)");
        found.bind(lease.id).bind(std::int64_t{lease.attempt}).bind(best_so_far).step();
      }
      transaction.commit();
      return held;
    });
  }

  Result<std::vector<bool>> finish_all(const std::vector<JobEnd>& ends, std::int64_t now) override {
    return guarded(write_mutex_, [&] {
      // The end of a part is nobody's answer yet.
      const bool parts_only =
          std::all_of(ends.begin(), ends.end(), [](const JobEnd& end) { return !end.lease.whole.empty(); });
      SqliteConnection& connection = parts_only ? quick_ : durable_;
      SqliteTransaction transaction(connection);
      std::vector<bool> kept;
      for (const JobEnd& end : ends) {
        kept.push_back(end_job(connection, end, now));
        if (kept.back() && !end.lease.whole.empty())
          count_ended_part(connection, end.lease.whole, end.state == JobState::kSuccessful,
                           end.outcome.cpu_s);
      }
      transaction.commit();
      return kept;
    });
  }

  Result<bool> split(const Lease& lease, const std::vector<std::string>& requests,
                     std::int64_t now) override {
    return guarded(write_mutex_, [&] {
      SqliteTransaction transaction(quick_);
      const bool held = split_job(quick_, lease, requests, now);
      transaction.commit();
      return held;
    });
  }

  Result<std::vector<Job>> parts(std::string_view id) override {
    return guarded(read_mutex_, [&] {
      std::vector<Job> jobs;
      auto row =
          reader_.prepare(fmt::format("SELECT {} FROM jobs WHERE whole = ? ORDER BY part", kJobColumns));
      row.bind(id);
      while (row.step()) jobs.push_back(told_job(row));
      return jobs;
    });
  }

  Result<int> release(std::string_view worker, HandBack why, std::string_view reason) override {
    return guarded(write_mutex_, [&] {
      auto update = quick_.prepare(
          "UPDATE jobs SET state = 'accepted', deaths = deaths + ?, "
          "last_death = CASE WHEN ? THEN ? ELSE last_death END, version = version + 1, worker = NULL "
          "WHERE state = 'running' AND (worker = ? OR substr(worker, 1, ?) = ?)");
      const std::string family = std::string(worker) + "/";
      const std::int64_t died = why == HandBack::kDied;
      update.bind(died).bind(died).bind(reason).bind(worker);
      update.bind(static_cast<std::int64_t>(family.size())).bind(family).step();
      return quick_.changes();
    });
  }

  Result<std::optional<Job>> dismiss(std::string_view id, std::int64_t now) override {
    return on_a_full_disk([&] {
      SqliteTransaction transaction(durable_);
      static_cast<void>(told_from(durable_, id));  // what is not as it ended does not end again
      dismiss_job(durable_, id, now);
      const std::optional<Job> job = told_from(durable_, id);
      transaction.commit();
      return job;
    });
  }

  Result<std::optional<Job>> get(std::string_view id) override {
    return guarded(read_mutex_, [&] { return told_from(reader_, id); });
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

  Result<std::optional<SeriesPage>> series(std::string_view id, std::int64_t page) override {
    return guarded(read_mutex_, [&]() -> std::optional<SeriesPage> {
      auto row = reader_.prepare(
          "SELECT bytes, sha256, EXISTS (SELECT 1 FROM series WHERE job_id = ? AND page = ?) FROM series "
          "WHERE job_id = ? AND page = ?");
      row.bind(id).bind(page + 1).bind(id).bind(page);
      if (!row.step()) return std::nullopt;
      std::string bytes = row.text(0);
      if (row.text(1) != series_digest(id, page, bytes))
        throw SqliteDamage(
            fmt::format("what is stored of job {} is not what it answered: ask for it again", id));
      return SeriesPage{.bytes = std::move(bytes), .more = row.number(2) != 0};
    });
  }

  Result<std::optional<QueuePlace>> place_in_queue(std::string_view id,
                                                   const std::vector<std::string>& kinds) override {
    return guarded(read_mutex_, [&]() -> std::optional<QueuePlace> {
      auto own = reader_.prepare("SELECT urgency, sequence FROM jobs WHERE id = ? AND state = 'accepted'");
      own.bind(id);
      if (!own.step()) return std::nullopt;
      const std::int64_t urgency = own.number(0), sequence = own.number(1);
      auto before = reader_.prepare(fmt::format(
          "SELECT kind, state, count(*), (SELECT avg(took) FROM (SELECT kind AS its_kind, state AS its_end, "
          "ended_ms - started_ms AS took FROM jobs WHERE state NOT IN ('accepted', 'running') "
          "ORDER BY sequence DESC LIMIT 200) WHERE its_kind = jobs.kind AND its_end = 'successful') "
          "FROM jobs WHERE state IN ('accepted', 'running') {} AND "
          "(state = 'running' OR urgency < ? OR (urgency = ? AND sequence < ?)) GROUP BY kind, state",
          among(kinds)));
      for (const std::string& kind : kinds) before.bind(kind);
      before.bind(urgency).bind(urgency).bind(sequence);
      QueueSum sum;
      while (before.step()) {
        const auto took_ms = before.optional_number(3);
        sum.add(before.text(1) == "running", static_cast<int>(before.number(2)),
                took_ms ? std::optional(1e-3 * static_cast<double>(*took_ms)) : std::nullopt);
      }
      return sum.place();
    });
  }

  Result<std::vector<JobCount>> counts() override {
    return guarded(read_mutex_, [&] {
      std::vector<JobCount> all;
      auto row = reader_.prepare("SELECT kind, state, count(*) FROM jobs GROUP BY kind, state");
      while (row.step())
        if (const auto state = job_state(row.text(1))) all.push_back({row.text(0), *state, row.number(2)});
      return all;
    });
  }

  Result<std::vector<Job>> list(std::size_t most) override {
    reserve_.keep_again();  // here, since a service looks at the list time and again
    return guarded(read_mutex_, [&] {
      std::vector<Job> jobs;
      auto row = reader_.prepare(
          fmt::format("SELECT {} FROM jobs WHERE whole IS NULL ORDER BY sequence DESC LIMIT ?", kJobColumns));
      row.bind(static_cast<std::int64_t>(most));
      while (row.step())
        if (is_whole(row)) jobs.push_back(job_of(row));  // one that is damaged hides itself alone
      return jobs;
    });
  }

  Result<int> forget_ended(const Retention& kept, std::int64_t now) override {
    auto forgotten = on_a_full_disk([&] {
      const int count = forget_jobs(quick_, kept, now);
      if (count > 0) quick_.execute("PRAGMA incremental_vacuum");
      return count;
    });
    if (forgotten) reserve_.keep();
    return forgotten;
  }

 private:
  // What frees a full disk, or stops what fills it, may use the reserve.
  template <class Work>
  auto on_a_full_disk(const Work& work) -> Result<decltype(work())> {
    const auto is_short = [](const auto& done) {
      return !done && done.error().code == ErrorCode::kStorageFull;
    };
    auto done = guarded(write_mutex_, work);
    if (!is_short(done)) return done;
    const auto with_the_log_begun_anew = [&] {
      // What it needs goes to the tables, and then the log has room up to where it ended.
      static_cast<void>(guarded(write_mutex_, [&] {
        durable_.execute("PRAGMA wal_checkpoint(PASSIVE)");
        return true;
      }));
      return guarded(write_mutex_, work);
    };
    return reserve_.give_to(with_the_log_begun_anew, is_short);
  }

  struct PendingAppend {
    const NewJob& job;
    std::int64_t now;
    const Admission& admission;
    std::optional<Result<Job>> answer;
  };

  std::vector<Result<Job>> append_batch(const std::vector<PendingAppend*>& batch) {
    auto answers = guarded(write_mutex_, [&] {
      std::vector<Result<Job>> all;
      SqliteTransaction transaction(durable_);
      for (const PendingAppend* pending : batch) all.push_back(append_one(*pending));
      transaction.commit();
      return all;
    });
    if (answers) return std::move(*answers);
    // One id that is taken undoes the batch: with 128 random bits that is a caller's mistake, not luck.
    return {batch.size(), Result<Job>(fail(answers.error()))};
  }

  // Within a transaction of durable_.
  Result<Job> append_one(const PendingAppend& pending) {
    const NewJob& wanted = pending.job;
    if (wanted.key) {
      auto before = durable_.prepare(
          "SELECT id, kind = ? AND request = ? FROM jobs WHERE owner = ? AND idempotency_key = ?");
      before.bind(wanted.kind).bind(wanted.request).bind(wanted.owner).bind(*wanted.key);
      if (before.step()) {
        if (before.number(1) == 0) return fail(another_request());
        const std::optional<Job> job = get_from(durable_, before.text(0));
        if (!job) throw SqliteDamage("a job is not found under its id");
        return *job;
      }
    }
    auto count = durable_.prepare(
        "SELECT count(*), coalesce(sum(owner = ?), 0) FROM jobs WHERE state IN ('accepted', 'running') "
        "AND whole IS NULL");
    count.bind(wanted.owner).step();
    if (auto refusal = refused_by(pending.admission, count.number(0), count.number(1)))
      return fail(*std::move(refusal));
    auto insert = durable_.prepare(fmt::format(
        "INSERT INTO jobs (id, kind, state, created_ms, request, request_sha256, owner, urgency{}) "
        "VALUES (?, ?, 'accepted', ?, ?, ?, ?, ?{})",
        wanted.key ? ", idempotency_key" : "", wanted.key ? ", ?" : ""));
    insert.bind(wanted.id).bind(wanted.kind).bind(pending.now).bind(wanted.request);
    insert.bind(request_digest(wanted.id, wanted.kind, wanted.request)).bind(wanted.owner);
    insert.bind(std::int64_t{wanted.urgency});
    if (wanted.key) insert.bind(*wanted.key);
    insert.step();
    return accepted_job(wanted, pending.now);
  }

  // Nothing for a database in memory, which is that of its first connection alone: it serves for all.
  static std::unique_ptr<SqliteConnection> quick_to(const std::filesystem::path& path) {
    return path.empty() ? nullptr : std::make_unique<SqliteConnection>(path, CommitKind::kQuick);
  }

  // Which file lies there; nothing where there is none.
  static std::optional<std::pair<dev_t, ino_t>> file_at(const std::filesystem::path& path) {
    struct ::stat status {};
    if (path.empty() || ::stat(path.c_str(), &status) != 0) return std::nullopt;
    return std::pair(status.st_dev, status.st_ino);
  }

  const std::filesystem::path path_;
  std::optional<std::pair<dev_t, ino_t>> opened_;
  SqliteConnection durable_;
  const std::unique_ptr<SqliteConnection> second_, third_;
  SqliteConnection& quick_ = second_ ? *second_ : durable_;
  SqliteConnection& reader_ = third_ ? *third_ : durable_;
  DiskReserve reserve_;
  std::mutex write_mutex_;  // durable_, quick_: SQLite has one writer at a time anyway
  std::mutex third_mutex_;
  std::mutex& read_mutex_ = third_ ? third_mutex_ : write_mutex_;  // pollers do not wait for the disk

  std::mutex append_mutex_;
  std::condition_variable appended_;
  std::vector<PendingAppend*> pending_;
  bool committing_ = false;
};

}  // namespace

Result<std::unique_ptr<JobStore>> open_sqlite_job_store(const std::filesystem::path& path,
                                                        StoreCheck how_far) {
  try {
    check_marker(path);
    return std::make_unique<SqliteJobStore>(path, how_far);
  } catch (const SqliteFull& failure) {
    return fail(ErrorCode::kStorageFull, failure.what());
  } catch (const SqliteDamage& failure) {
    return fail(ErrorCode::kDamagedStore, failure.what());
  } catch (const SqliteFailure& failure) {
    return fail(ErrorCode::kStorage, failure.what());
  }
}

}  // namespace slipway::api
