#include "api/jobs/memory_job_store.h"

#include <algorithm>
#include <deque>
#include <map>
#include <mutex>
#include <set>
#include <utility>

#include "api/jobs/job_admission.h"
#include "core/boot_clock.h"

namespace slipway::api {
namespace {

struct Entry {
  Job job;
  NewJob asked;
  std::string outcome;
  std::vector<std::string> series = {};
  std::string worker = {};
  std::int64_t lease_until = 0;
  bool waits = false;  // for its parts, running and nobody's
};

class MemoryJobStore final : public JobStore {
 public:
  Result<Job> append(const NewJob& job, std::int64_t now, const Admission& admission) override {
    const std::scoped_lock lock(mutex_);
    std::int64_t unfinished = 0, of_owner = 0;
    for (const Entry& entry : entries_) {
      const bool same_owner = entry.asked.owner == job.owner;
      if (job.key && same_owner && entry.asked.key == job.key) {
        if (entry.asked.kind != job.kind || entry.asked.request != job.request)
          return fail(another_request());
        return entry.job;
      }
      if (has_ended(entry.job.state) || !entry.job.whole.empty()) continue;
      ++unfinished;
      of_owner += same_owner ? 1 : 0;
    }
    if (auto refusal = refused_by(admission, unfinished, of_owner)) return fail(*std::move(refusal));
    if (find(job.id) != nullptr) return fail(ErrorCode::kStorage, "the job's id is taken");
    Entry& entry = entries_.emplace_back();
    entry.job = accepted_job(job, now);
    entry.asked = job;
    return entry.job;
  }

  Result<std::int64_t> lease_clock() override { return boot_ms(); }

  Result<std::vector<ClaimedJob>> claim_some(std::string_view worker, const std::vector<std::string>& kinds,
                                             std::int64_t now, LeaseTerm term, int most) override {
    const std::scoped_lock lock(mutex_);
    std::vector<ClaimedJob> claimed;
    Entry* first = nullptr;
    for (Entry& entry : entries_) {
      const bool late = entry.job.state == JobState::kRunning && !entry.waits && entry.lease_until < term.now;
      const bool free = entry.job.state == JobState::kAccepted || late;
      if (free && is_among(kinds, entry) && (first == nullptr || entry.job.urgency < first->job.urgency))
        first = &entry;
    }
    if (first == nullptr) return claimed;
    if (first->job.state == JobState::kRunning) {
      ++first->job.deaths;
      first->job.last_death = kLeaseEnded;
    }
    claimed.push_back(give(*first, worker, now, term.until));
    if (first->job.whole.empty() || first->job.deaths > 0) return claimed;
    const int at_once = parts_at_once(find(first->job.whole)->job.parts, most);
    for (Entry& entry : entries_) {  // the first part is before the others
      if (static_cast<int>(claimed.size()) >= at_once) break;
      const bool is_beside = entry.job.whole == first->job.whole && entry.job.deaths == 0;
      if (is_beside && entry.job.state == JobState::kAccepted)
        claimed.push_back(give(entry, worker, now, term.until));
    }
    return claimed;
  }

  Result<int> give_back(const std::vector<Lease>& leases) override {
    const std::scoped_lock lock(mutex_);
    int count = 0;
    for (const Lease& lease : leases) {
      Entry* const entry = held(lease);
      if (entry == nullptr) continue;
      entry->job.state = JobState::kAccepted;
      ++entry->job.version;
      ++count;
    }
    return count;
  }

  Result<bool> report(const Lease& lease, std::string_view stage, double progress, std::int64_t lease_until,
                      std::string_view best_so_far) override {
    const std::scoped_lock lock(mutex_);
    Entry* const entry = held(lease);
    if (entry == nullptr) return false;
    entry->lease_until = lease_until;
    if (!best_so_far.empty()) entry->job.best_so_far = best_so_far;
    if (best_so_far.empty() && entry->job.stage == stage && entry->job.progress == progress) return true;
    entry->job.stage = stage;
    entry->job.progress = progress;
    ++entry->job.version;
    return true;
  }

  Result<std::vector<bool>> finish_all(const std::vector<JobEnd>& ends, std::int64_t now) override {
    const std::scoped_lock lock(mutex_);
    std::vector<bool> kept;
    for (const JobEnd& its : ends) {
      Entry* const entry = held(its.lease);
      kept.push_back(entry != nullptr);
      if (entry == nullptr) continue;
      entry->job.cpu_s = its.outcome.cpu_s;
      entry->outcome = its.outcome.bytes;
      entry->series = its.outcome.series;
      end(*entry, its.state, now);
    }
    return kept;
  }

  Result<bool> split(const Lease& lease, const std::vector<std::string>& requests,
                     std::int64_t now) override {
    const std::scoped_lock lock(mutex_);
    Entry* const entry = held(lease);
    if (entry == nullptr) return false;
    const int count = static_cast<int>(requests.size());
    entry->waits = true;
    entry->worker.clear();
    Job& whole = entry->job;
    whole.parts = {.count = count};
    whole.stage = stage_of_parts(0, count);
    ++whole.version;
    const std::string id = whole.id;
    for (int k = 0; k < count; ++k) {
      const NewJob asked = new_part(find(id)->job, requests[static_cast<std::size_t>(k)]);
      Entry& part = entries_.emplace_back();
      part.job = accepted_job(asked, now);
      part.job.whole = id;
      part.job.part = k;
      part.asked = asked;
    }
    return true;
  }

  Result<std::vector<Job>> parts(std::string_view id) override {
    const std::scoped_lock lock(mutex_);
    std::vector<Job> jobs;  // the entries of a job's parts are in their order
    for (const Entry& entry : entries_)
      if (!id.empty() && entry.job.whole == id) jobs.push_back(entry.job);
    return jobs;
  }

  Result<int> release(std::string_view worker, HandBack why, std::string_view reason) override {
    const std::scoped_lock lock(mutex_);
    const std::string family = std::string(worker) + "/";
    int released = 0;
    for (Entry& entry : entries_) {
      const bool holds = entry.worker == worker || entry.worker.starts_with(family);
      if (entry.job.state != JobState::kRunning || entry.waits || !holds) continue;
      entry.job.state = JobState::kAccepted;
      if (why == HandBack::kDied) {
        ++entry.job.deaths;
        entry.job.last_death = reason;
      }
      ++entry.job.version;
      ++released;
    }
    return released;
  }

  Result<std::optional<Job>> dismiss(std::string_view id, std::int64_t now) override {
    const std::scoped_lock lock(mutex_);
    Entry* const entry = find(id);
    if (entry == nullptr) return std::nullopt;
    if (has_ended(entry->job.state)) return entry->job;
    end(*entry, JobState::kDismissed, now);
    for (Entry& part : entries_)
      if (part.job.whole == id && !has_ended(part.job.state)) end(part, JobState::kDismissed, now);
    return find(id)->job;
  }

  Result<std::optional<Job>> get(std::string_view id) override {
    const std::scoped_lock lock(mutex_);
    const Entry* const entry = find(id);
    return entry == nullptr ? std::nullopt : std::optional(entry->job);
  }

  Result<std::optional<std::string>> request(std::string_view id) override {
    const std::scoped_lock lock(mutex_);
    const Entry* const entry = find(id);
    return entry == nullptr ? std::nullopt : std::optional(entry->asked.request);
  }

  Result<std::optional<std::string>> outcome(std::string_view id) override {
    const std::scoped_lock lock(mutex_);
    const Entry* const entry = find(id);
    if (entry == nullptr || !has_ended(entry->job.state) || entry->job.state == JobState::kDismissed) {
      return std::nullopt;
    }
    return entry->outcome;
  }

  Result<std::optional<SeriesPage>> series(std::string_view id, std::int64_t page) override {
    const std::scoped_lock lock(mutex_);
    const Entry* const entry = find(id);
    if (entry == nullptr || entry->job.state != JobState::kSuccessful || page < 1 ||
        page > static_cast<std::int64_t>(entry->series.size()))
      return std::nullopt;
    return SeriesPage{.bytes = entry->series[static_cast<std::size_t>(page - 1)],
                      .more = page < static_cast<std::int64_t>(entry->series.size())};
  }

  Result<std::optional<QueuePlace>> place_in_queue(std::string_view id,
                                                   const std::vector<std::string>& kinds) override {
    const std::scoped_lock lock(mutex_);
    const Entry* const own = find(id);
    if (own == nullptr || own->job.state != JobState::kAccepted) return std::nullopt;
    std::map<std::string, std::pair<double, int>, std::less<>> took;  // by kind: their sum [s], and how many
    for (const Entry& entry : entries_) {
      if (entry.job.state != JobState::kSuccessful) continue;
      auto& [sum_s, count] = took[entry.job.kind];
      sum_s += 1e-3 * static_cast<double>(*entry.job.ended_ms - *entry.job.started_ms);
      ++count;
    }
    QueueSum sum;
    bool before = true;
    for (const Entry& entry : entries_) {
      if (&entry == own) before = false;
      const bool running = entry.job.state == JobState::kRunning;
      const bool waits =
          entry.job.state == JobState::kAccepted && &entry != own &&
          (entry.job.urgency < own->job.urgency || (entry.job.urgency == own->job.urgency && before));
      if (!(running || waits) || !is_among(kinds, entry)) continue;
      const auto usual = took.find(entry.job.kind);
      sum.add(running, 1,
              usual == took.end() ? std::nullopt : std::optional(usual->second.first / usual->second.second));
    }
    return sum.place();
  }

  Result<std::vector<JobCount>> counts() override {
    const std::scoped_lock lock(mutex_);
    std::map<std::pair<std::string, JobState>, std::int64_t> counts;
    for (const Entry& entry : entries_) ++counts[{entry.job.kind, entry.job.state}];
    std::vector<JobCount> all;
    for (const auto& [of, count] : counts) all.push_back({of.first, of.second, count});
    return all;
  }

  Result<std::vector<Job>> list(std::size_t most) override {
    const std::scoped_lock lock(mutex_);
    std::vector<Job> jobs;
    for (auto entry = entries_.rbegin(); entry != entries_.rend() && jobs.size() < most; ++entry)
      if (entry->job.whole.empty()) jobs.push_back(entry->job);
    return jobs;
  }

  Result<int> forget_ended(const Retention& kept, std::int64_t now) override {
    const std::scoped_lock lock(mutex_);
    std::map<std::string, std::int64_t, std::less<>> of_parts;  // bytes, by the job's id
    for (const Entry& entry : entries_)
      if (!entry.job.whole.empty()) of_parts[entry.job.whole] += bytes_of(entry);
    std::size_t ended = 0;
    std::int64_t bytes = 0;
    std::set<std::string> gone;
    for (auto entry = entries_.rbegin(); entry != entries_.rend(); ++entry) {
      if (!has_ended(entry->job.state) || !entry->job.whole.empty()) continue;
      bytes += bytes_of(*entry) + of_parts[entry->job.id];
      const bool old = now - entry->job.ended_ms.value_or(now) > kept.most_age_ms;
      if (++ended > kept.most || bytes > kept.most_bytes || old) gone.insert(entry->job.id);
    }
    std::erase_if(entries_,
                  [&](const Entry& e) { return gone.contains(e.job.id) || gone.contains(e.job.whole); });
    return static_cast<int>(gone.size());
  }

 private:
  static bool is_among(const std::vector<std::string>& kinds, const Entry& entry) {
    return kinds.empty() || std::find(kinds.begin(), kinds.end(), entry.job.kind) != kinds.end();
  }

  Entry* find(std::string_view id) {
    const auto found =
        std::find_if(entries_.begin(), entries_.end(), [id](const Entry& e) { return e.job.id == id; });
    return found == entries_.end() ? nullptr : &*found;
  }

  // The entry that the lease still holds.
  Entry* held(const Lease& lease) {
    Entry* const entry = find(lease.id);
    const bool holds = entry != nullptr && entry->job.state == JobState::kRunning && !entry->waits &&
                       entry->job.attempt == lease.attempt;
    return holds ? entry : nullptr;
  }

  static ClaimedJob give(Entry& entry, std::string_view worker, std::int64_t now, std::int64_t lease_until) {
    Job& job = entry.job;
    job.state = JobState::kRunning;
    job.best_so_far.clear();
    job.started_ms = now;
    ++job.attempt;
    ++job.version;
    entry.worker = worker;
    entry.lease_until = lease_until;
    return ClaimedJob{.job = job, .request = entry.asked.request, .worker = std::string(worker)};
  }

  static std::int64_t bytes_of(const Entry& entry) {
    std::size_t bytes = entry.asked.request.size() + entry.outcome.size();
    for (const std::string& page : entry.series) bytes += page.size();
    return static_cast<std::int64_t>(bytes);
  }

  void end(Entry& entry, JobState state, std::int64_t now) {
    entry.job.state = state;
    entry.job.ended_ms = now;
    if (state == JobState::kSuccessful) entry.job.progress = 1.0;
    ++entry.job.version;
    Entry* const whole = entry.job.whole.empty() ? nullptr : find(entry.job.whole);
    if (whole == nullptr || !whole->waits || has_ended(whole->job.state)) return;
    Job& job = whole->job;
    ++job.parts.ended;
    job.parts.failed += state == JobState::kSuccessful ? 0 : 1;
    job.parts.cpu_s += entry.job.cpu_s;
    job.stage = stage_of_parts(job.parts.ended, job.parts.count);
    job.progress = progress_of_parts(job.parts.ended, job.parts.count);
    ++job.version;
    if (job.parts.ended < job.parts.count) return;
    whole->waits = false;
    job.state = JobState::kAccepted;
  }

  std::mutex mutex_;
  std::deque<Entry> entries_;  // oldest first
};

}  // namespace

std::unique_ptr<JobStore> make_memory_job_store() {
  return std::make_unique<MemoryJobStore>();
}

}  // namespace slipway::api
