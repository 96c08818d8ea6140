#include "api/jobs/job_runner.h"

#include <fmt/format.h>

#include <exception>
#include <utility>

#include "api/json/problem_document.h"

namespace slipway::api {

// Passes progress on to the store, not more often than the options say, and renews the lease. Learns from the
// store, the runner and the clock that nobody wants the work any more.
class JobRunner::JobProgress final : public Progress {
 public:
  JobProgress(JobRunner& runner, Lease lease)
      : runner_(runner), lease_(std::move(lease)), written_(Clock::now()) {}

  void report(std::string_view stage, double fraction) override {
    const std::scoped_lock lock(mutex_);
    const bool is_new_stage = stage != stage_;
    stage_ = stage;
    fraction_ = fraction;
    if (is_new_stage || Clock::now() - written_ >= runner_.options_.progress_interval) write();
  }

  bool cancelled() const override {
    if (cancelled_ || runner_.stopping_) return true;
    const std::unique_lock lock(mutex_, std::try_to_lock);
    // Work that asks but has nothing to report is alive too.
    constexpr int kRenewalsPerLease = 3;
    if (lock && Clock::now() - written_ >= runner_.options_.lease / kRenewalsPerLease) write();
    return cancelled_;
  }

  void cancel() { cancelled_ = true; }

 private:
  using Clock = std::chrono::steady_clock;

  void write() const {
    written_ = Clock::now();
    const auto held =
        runner_.store_->report(lease_, stage_, fraction_, now_ms() + runner_.options_.lease.count());
    // A store that can't be written for a moment is no reason to throw the work away.
    if (held && !*held) cancelled_ = true;
  }

  JobRunner& runner_;
  const Lease lease_;
  mutable std::mutex mutex_;
  mutable Clock::time_point written_;
  mutable std::atomic<bool> cancelled_{false};
  std::string stage_;
  double fraction_ = 0.0;
};

JobRunner::JobRunner(std::shared_ptr<JobStore> store, JobWork work, JobRunnerOptions options)
    : store_(std::move(store)), work_(std::move(work)), options_(std::move(options)) {}

JobRunner::~JobRunner() {
  stop();
}

Result<void> JobRunner::start() {
  const auto released = store_->release(options_.worker, HandBack::kDied);
  if (!released) return fail(released.error());
  static_cast<void>(store_->forget_ended(options_.kept, now_ms()));
  for (const std::vector<std::string>& kinds : options_.workers) {
    threads_.emplace_back([this, &kinds] { serve(kinds); });
  }
  return {};
}

void JobRunner::stop() {
  {
    const std::scoped_lock lock(mutex_);
    stopping_ = true;
    submitted_.notify_all();
    ended_.notify_all();
  }
  for (std::thread& thread : threads_) thread.join();
  if (!threads_.empty())
    static_cast<void>(store_->release(options_.worker, HandBack::kStopped));  // else the next start does it
  threads_.clear();
}

Result<Job> JobRunner::submit(const std::string& kind, std::string request) {
  auto job = store_->append({new_job_id(), kind, std::move(request)}, now_ms(), options_.most_unfinished);
  if (job) {
    const std::scoped_lock lock(mutex_);
    ++submissions_;
    submitted_.notify_all();  // not every worker takes every kind
  }
  return job;
}

Result<std::optional<Job>> JobRunner::dismiss(std::string_view id) {
  auto job = store_->dismiss(id, now_ms());
  const std::scoped_lock lock(mutex_);
  if (job && *job && (*job)->state == JobState::kDismissed) {
    const auto active = active_.find(id);
    if (active != active_.end()) active->second->cancel();
  }
  ended_.notify_all();
  return job;
}

Result<std::optional<Job>> JobRunner::wait(std::string_view id, std::chrono::milliseconds longest) {
  const auto until = std::chrono::steady_clock::now() + longest;
  std::unique_lock lock(mutex_);
  for (;;) {
    // Asked under the lock, so that an end between asking and waiting is not missed.
    auto job = store_->get(id);
    const bool over = !job || !*job || has_ended((*job)->state) || stopping_;
    if (over || std::chrono::steady_clock::now() >= until) return job;
    ended_.wait_until(lock, until);
  }
}

void JobRunner::serve(const std::vector<std::string>& kinds) {
  while (!stopping_) {
    const int seen = submissions_;
    const std::int64_t now = now_ms();
    const auto claimed = store_->claim(options_.worker, kinds, now, now + options_.lease.count());
    if (claimed && *claimed) {
      run(**claimed);
      continue;
    }
    std::unique_lock lock(mutex_);
    submitted_.wait_for(lock, options_.idle_poll, [&] { return stopping_ || submissions_ != seen; });
  }
}

void JobRunner::run(const ClaimedJob& claimed) {
  JobProgress progress(*this, claimed.lease());
  {
    const std::scoped_lock lock(mutex_);
    active_[claimed.job.id] = &progress;
    ++running_;
  }
  // A dismissal between the claim and the line above reached the store but not us: the first report tells.
  progress.report("starting", 0.0);
  Result<std::string> answer = fail(ErrorCode::kInternal, "");
  const bool gives_up = claimed.damaged || claimed.job.deaths >= options_.most_deaths;
  if (claimed.damaged) {
    answer =
        fail(ErrorCode::kDamagedStore, "what is stored of the request is not what was accepted: ask again");
  } else if (gives_up) {
    answer = fail(ErrorCode::kInternal,
                  fmt::format("the process ended {} times while it was at this work", claimed.job.deaths));
  } else if (!progress.cancelled()) {
    try {
      answer = work_(claimed.job.kind, claimed.request, progress);
    } catch (const std::exception& broken) {
      answer = fail(ErrorCode::kInternal, broken.what());
    }
  }
  {
    const std::scoped_lock lock(mutex_);
    active_.erase(claimed.job.id);
  }
  const bool wanted = !progress.cancelled() || gives_up;
  if (wanted || answer) conclude(claimed, answer);
  const std::scoped_lock lock(mutex_);
  --running_;
  ended_.notify_all();
}

void JobRunner::conclude(const ClaimedJob& claimed, const Result<std::string>& answer) {
  const JobState state = answer ? JobState::kSuccessful : JobState::kFailed;
  const std::string outcome = answer ? *answer : json::write_problem(answer.error());
  // The store refuses it when the job was dismissed meanwhile: then nobody ever sees this outcome.
  static_cast<void>(store_->finish(claimed.lease(), state, outcome, now_ms()));
  static_cast<void>(store_->forget_ended(options_.kept, now_ms()));
}

}  // namespace slipway::api
