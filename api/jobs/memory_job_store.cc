#include "api/jobs/memory_job_store.h"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <mutex>

namespace slipway::api {
namespace {

struct Entry {
  Job job;
  std::string request;
  std::string outcome;
  std::string worker;
  std::int64_t lease_until = 0;
};

class MemoryJobStore final : public JobStore {
 public:
  Result<Job> append(const NewJob& job, std::int64_t now, std::size_t most_unfinished) override {
    const std::scoped_lock lock(mutex_);
    const auto unfinished = static_cast<std::size_t>(std::count_if(
        entries_.begin(), entries_.end(), [](const Entry& e) { return !has_ended(e.job.state); }));
    if (unfinished >= most_unfinished) {
      return fail(ErrorCode::kTooManyJobs, fmt::format("{} jobs are waiting or running already", unfinished));
    }
    if (find(job.id) != nullptr) return fail(ErrorCode::kStorage, "the job's id is taken");
    Entry& entry = entries_.emplace_back();
    entry.job.id = job.id;
    entry.job.kind = job.kind;
    entry.job.created_ms = now;
    entry.request = job.request;
    return entry.job;
  }

  Result<std::optional<ClaimedJob>> claim(std::string_view worker, const std::vector<std::string>& kinds,
                                          std::int64_t now, std::int64_t lease_until) override {
    const std::scoped_lock lock(mutex_);
    for (Entry& entry : entries_) {
      const bool free = entry.job.state == JobState::kAccepted ||
                        (entry.job.state == JobState::kRunning && entry.lease_until < now);
      const bool of_kind =
          kinds.empty() || std::find(kinds.begin(), kinds.end(), entry.job.kind) != kinds.end();
      if (!free || !of_kind) continue;
      if (entry.job.state == JobState::kRunning) ++entry.job.deaths;
      entry.job.state = JobState::kRunning;
      entry.job.started_ms = now;
      ++entry.job.attempt;
      ++entry.job.version;
      entry.worker = worker;
      entry.lease_until = lease_until;
      return ClaimedJob{entry.job, entry.request};
    }
    return std::nullopt;
  }

  Result<bool> report(const Lease& lease, std::string_view stage, double progress,
                      std::int64_t lease_until) override {
    const std::scoped_lock lock(mutex_);
    Entry* const entry = held(lease);
    if (entry == nullptr) return false;
    entry->lease_until = lease_until;
    if (entry->job.stage == stage && entry->job.progress == progress) return true;
    entry->job.stage = stage;
    entry->job.progress = progress;
    ++entry->job.version;
    return true;
  }

  Result<bool> finish(const Lease& lease, JobState state, std::string_view outcome,
                      std::int64_t now) override {
    const std::scoped_lock lock(mutex_);
    Entry* const entry = held(lease);
    if (entry == nullptr) return false;
    end(*entry, state, now);
    entry->outcome = outcome;
    return true;
  }

  Result<int> release(std::string_view worker, HandBack why) override {
    const std::scoped_lock lock(mutex_);
    int released = 0;
    for (Entry& entry : entries_) {
      if (entry.job.state != JobState::kRunning || entry.worker != worker) continue;
      entry.job.state = JobState::kAccepted;
      if (why == HandBack::kDied) ++entry.job.deaths;
      ++entry.job.version;
      ++released;
    }
    return released;
  }

  Result<std::optional<Job>> dismiss(std::string_view id, std::int64_t now) override {
    const std::scoped_lock lock(mutex_);
    Entry* const entry = find(id);
    if (entry == nullptr) return std::nullopt;
    if (!has_ended(entry->job.state)) end(*entry, JobState::kDismissed, now);
    return entry->job;
  }

  Result<std::optional<Job>> get(std::string_view id) override {
    const std::scoped_lock lock(mutex_);
    const Entry* const entry = find(id);
    return entry == nullptr ? std::nullopt : std::optional(entry->job);
  }

  Result<std::optional<std::string>> request(std::string_view id) override {
    const std::scoped_lock lock(mutex_);
    const Entry* const entry = find(id);
    return entry == nullptr ? std::nullopt : std::optional(entry->request);
  }

  Result<std::optional<std::string>> outcome(std::string_view id) override {
    const std::scoped_lock lock(mutex_);
    const Entry* const entry = find(id);
    if (entry == nullptr || !has_ended(entry->job.state) || entry->job.state == JobState::kDismissed) {
      return std::nullopt;
    }
    return entry->outcome;
  }

  Result<std::vector<Job>> list(std::size_t most) override {
    const std::scoped_lock lock(mutex_);
    std::vector<Job> jobs;
    for (auto entry = entries_.rbegin(); entry != entries_.rend() && jobs.size() < most; ++entry) {
      jobs.push_back(entry->job);
    }
    return jobs;
  }

  Result<int> forget_ended(const Retention& kept, std::int64_t now) override {
    const std::scoped_lock lock(mutex_);
    std::size_t ended = 0;
    std::int64_t bytes = 0;
    const std::size_t before = entries_.size();
    std::deque<Entry> left;
    for (auto entry = entries_.rbegin(); entry != entries_.rend(); ++entry) {
      if (has_ended(entry->job.state)) {
        bytes += static_cast<std::int64_t>(entry->request.size() + entry->outcome.size());
        const bool old = now - entry->job.ended_ms.value_or(now) > kept.most_age_ms;
        if (++ended > kept.most || bytes > kept.most_bytes || old) continue;
      }
      left.push_front(std::move(*entry));
    }
    entries_ = std::move(left);
    return static_cast<int>(before - entries_.size());
  }

 private:
  Entry* find(std::string_view id) {
    const auto found =
        std::find_if(entries_.begin(), entries_.end(), [id](const Entry& e) { return e.job.id == id; });
    return found == entries_.end() ? nullptr : &*found;
  }

  // The entry that the lease still holds.
  Entry* held(const Lease& lease) {
    Entry* const entry = find(lease.id);
    const bool holds =
        entry != nullptr && entry->job.state == JobState::kRunning && entry->job.attempt == lease.attempt;
    return holds ? entry : nullptr;
  }

  static void end(Entry& entry, JobState state, std::int64_t now) {
    entry.job.state = state;
    entry.job.ended_ms = now;
    if (state == JobState::kSuccessful) entry.job.progress = 1.0;
    ++entry.job.version;
  }

  std::mutex mutex_;
  std::deque<Entry> entries_;  // oldest first
};

}  // namespace

std::unique_ptr<JobStore> make_memory_job_store() {
  return std::make_unique<MemoryJobStore>();
}

}  // namespace slipway::api
