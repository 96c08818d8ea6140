#include "api/jobs/job_runner.h"

#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <exception>
#include <new>
#include <random>
#include <ratio>
#include <utility>

#include "api/jobs/job_admission.h"
#include "api/json/problem_document.h"
#include "core/part_of_progress.h"
#include "core/utc.h"

namespace slipway::api {
namespace {

// Processor time of this thread, or of the whole process, from here on.
class ProcessorTime {
 public:
  explicit ProcessorTime(bool of_thread)
      : clock_(of_thread ? CLOCK_THREAD_CPUTIME_ID : CLOCK_PROCESS_CPUTIME_ID), begun_s_(now_s()) {}
  double spent_s() const { return now_s() - begun_s_; }

 private:
  double now_s() const {
    timespec time{};
    ::clock_gettime(clock_, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  }

  clockid_t clock_;
  double begun_s_;
};

}  // namespace

JobRunner::JobRunner(std::shared_ptr<JobStore> store, JobWork work, JobRunnerOptions options,
                     WorkInParts in_parts)
    : store_(std::move(store)),
      work_(std::move(work)),
      options_(std::move(options)),
      in_parts_(std::move(in_parts)) {}

JobRunner::~JobRunner() {
  stop();
}

Result<void> JobRunner::start() {
  // Where the workers are processes of their own, who counts their deaths is who sees them die.
  const auto released = options_.works_here ? store_->release(options_.worker, HandBack::kDied,
                                                              "the process ended while it was at this work")
                                            : store_->release(options_.worker, HandBack::kStopped);
  if (!released) return fail(released.error());
  trim();
  if (!options_.works_here) {
    store_->listen(StoreNews::kEnded, [this] {
      const std::scoped_lock lock(mutex_);
      ended_.notify_all();
    });
    return {};
  }
  store_->listen(StoreNews::kAccepted, [this] {
    const std::scoped_lock lock(mutex_);
    ++work_rings_;
    submitted_.notify_all();
  });
  for (const std::vector<std::string>& kinds : options_.workers) {
    threads_.emplace_back([this, &kinds] { serve(kinds); });
  }
  return {};
}

void JobRunner::stop() {
  for (const StoreNews news : {StoreNews::kAccepted, StoreNews::kEnded}) store_->listen(news, {});
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

Result<Job> JobRunner::submit(const std::string& kind, std::string request, Submission submission) {
  auto job = store_->append({.id = new_job_id(),
                             .kind = kind,
                             .request = std::move(request),
                             .owner = std::move(submission.owner),
                             .key = std::move(submission.key),
                             .urgency = submission.urgency},
                            now_ms(), options_.admission);
  if (job) {
    ring();
    if (on_change_) on_change_();
  }
  return job;
}

void JobRunner::trim() {
  if (options_.kept) static_cast<void>(store_->forget_ended(*options_.kept, now_ms()));
}

void JobRunner::ring() {
  const std::scoped_lock lock(mutex_);
  ++rings_;
  ++work_rings_;
  submitted_.notify_all();  // not every worker takes every kind
  ended_.notify_all();
}

std::chrono::milliseconds JobRunner::longest_silence() const {
  const std::scoped_lock lock(mutex_);
  std::chrono::milliseconds longest{0};
  for (const auto& [id, progress] : active_) longest = std::max(longest, progress->silence());
  return longest;
}

Result<std::optional<QueueEstimate>> JobRunner::queue_estimate(const Job& job) {
  // Those that the job waits behind are what the worker with the fewest kinds that takes it does.
  const std::vector<std::string>* fewest = nullptr;
  int takers = 0;
  for (const std::vector<std::string>& kinds : options_.workers) {
    if (!kinds.empty() && std::find(kinds.begin(), kinds.end(), job.kind) == kinds.end()) continue;
    ++takers;
    if (fewest == nullptr || fewest->empty() || (!kinds.empty() && kinds.size() < fewest->size()))
      fewest = &kinds;
  }
  if (fewest == nullptr) return std::nullopt;
  const auto place = store_->place_in_queue(job.id, *fewest);
  if (!place) return fail(place.error());
  if (!*place) return std::nullopt;
  QueueEstimate estimate{.ahead = (*place)->ahead, .wait_s = (*place)->work_ahead_s};
  if (estimate.wait_s) *estimate.wait_s /= takers;
  if (shortage_) estimate.shortage = shortage_();
  return estimate;
}

Result<std::optional<Job>> JobRunner::dismiss(std::string_view id) {
  auto job = store_->dismiss(id, now_ms());
  {
    const std::scoped_lock lock(mutex_);
    if (job && *job && (*job)->state == JobState::kDismissed) {
      const auto active = active_.find(id);
      if (active != active_.end()) active->second->cancel();
    }
  }
  ended_.notify_all();
  if (on_change_) on_change_();
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
    // Whether it ended in another process is asked for, should that not have rung.
    ended_.wait_until(lock, std::min(until, std::chrono::steady_clock::now() + options_.idle_poll));
  }
}

void JobRunner::serve(const std::vector<std::string>& kinds) {
  std::minstd_rand chance{std::random_device{}()};
  // Workers that all became idle at once do not all look at once.
  std::uniform_real_distribution<double> share(0.5, 1.0);
  BatchSize size(options_.batch_time);
  while (!stopping_) {
    const int seen = work_rings_;
    const auto term = store_->lease_term(options_.lease);
    auto claimed = term ? store_->claim_some(options_.worker, kinds, now_ms(), *term, size.next())
                        : Result<std::vector<ClaimedJob>>(fail(term.error()));
    if (claimed && !claimed->empty()) {
      const bool of_parts = !claimed->front().job.whole.empty();
      JobBatch batch(*store_, *std::move(claimed), 2 * options_.batch_time);
      work_through(batch);
      if (of_parts) size.learn(batch.ended(), batch.age());
      continue;
    }
    size = BatchSize(options_.batch_time);  // what comes next may be of another kind
    std::unique_lock lock(mutex_);
    submitted_.wait_for(lock, options_.idle_poll * share(chance),
                        [&] { return stopping_ || work_rings_ != seen; });
  }
}

// What is left when the process stops is given back with all that it holds.
void JobRunner::work_through(JobBatch& batch) {
  while (!stopping_)
    if (const auto job = batch.next(); !job)
      break;
    else if (!divided(*job))
      run(*job, batch);
  write(batch);
}

void JobRunner::run(const ClaimedJob& claimed, JobBatch& batch) {
  JobProgress progress({.store = *store_,
                        .lease = options_.lease,
                        .progress_interval = options_.progress_interval,
                        .renewal = options_.renewal,
                        .max_time = options_.max_time,
                        .stopping = stopping_,
                        .rings = rings_},
                       claimed.lease(), [&batch] { batch.settle_if_late(); });
  {
    const std::scoped_lock lock(mutex_);
    active_[claimed.job.id] = &progress;
    ++running_;
  }
  // A dismissal between the claim and the line above reached the store but not us: the first report tells.
  progress.report("starting", claimed.job.parts.count > 0 ? kShareOfParts : 0.0);
  const bool gives_up = claimed.damaged || claimed.job.deaths >= options_.most_deaths;
  // What other threads of the process do is not this job's, and what a planner's threads do is.
  const ProcessorTime time(options_.workers.size() > 1);
  Result<JobAnswer> answer = answer_of(claimed, progress);
  const double cpu_s = time.spent_s();
  const bool over_time = !answer && !stopping_ && progress.is_over_time();
  if (over_time)
    answer = fail(ErrorCode::kJobTooLarge,
                  fmt::format("the work took longer than the {:g} minutes that one job may take",
                              std::chrono::duration<double, std::ratio<60>>(*options_.max_time).count()));
  const bool wanted = gives_up || over_time || !progress.cancelled();
  {
    const std::scoped_lock lock(mutex_);
    active_.erase(claimed.job.id);
  }
  if (wanted || answer) {
    // The store refuses it when the job was dismissed meanwhile: then nobody ever sees this outcome.
    JobAnswer outcome = answer ? *std::move(answer) : JobAnswer(json::write_problem(answer.error()));
    outcome.cpu_s = cpu_s;
    batch.end({claimed.lease(), answer ? JobState::kSuccessful : JobState::kFailed, std::move(outcome)});
  }
  if (!batch.has_more() || batch.is_late()) write(batch);
  const std::scoped_lock lock(mutex_);
  --running_;
  ended_.notify_all();
}

Result<JobAnswer> JobRunner::answer_of(const ClaimedJob& claimed, JobProgress& progress) {
  if (claimed.damaged)
    return fail(ErrorCode::kDamagedStore,
                "what is stored of the request is not what was accepted: ask again");
  if (claimed.job.deaths >= options_.most_deaths)
    return fail(
        ErrorCode::kInternal,
        fmt::format("the worker died {} times while it was at this work{}{}", claimed.job.deaths,
                    claimed.job.last_death.empty() ? "" : "; the last time: ", claimed.job.last_death));
  if (progress.cancelled()) return fail(ErrorCode::kCancelled, "the work was dismissed before it began");
  try {
    return work_on(claimed, progress);
  } catch (const std::bad_alloc&) {
    return fail(ErrorCode::kJobTooLarge, "the work needs more memory than one job may use");
  } catch (const std::exception& broken) {
    return fail(ErrorCode::kInternal, broken.what());
  }
}

// The job is others' then, or nobody's: work that can't be divided now is done in one go.
bool JobRunner::divided(const ClaimedJob& claimed) {
  const Job& job = claimed.job;
  const bool is_whole = job.whole.empty() && job.parts.count == 0;
  if (!in_parts_.split || !is_whole || claimed.damaged || job.deaths >= options_.most_deaths) return false;
  const auto requests = in_parts_.split(job.kind, claimed.request);
  if (!requests || requests->size() < 2) return false;
  const auto kept = store_->split(claimed.lease(), *requests, now_ms());
  if (!kept) return false;
  ring();
  if (on_change_) on_change_();
  return true;
}

Result<JobAnswer> JobRunner::work_on(const ClaimedJob& claimed, Progress& progress) {
  if (!claimed.job.whole.empty()) return in_parts_.part(claimed.job.kind, claimed.request, progress);
  if (claimed.job.parts.count == 0) return work_(claimed.job.kind, claimed.request, progress);
  PartOfProgress rest(progress, kShareOfParts, 1.0);
  return put_together(*store_, in_parts_, claimed, rest);
}

void JobRunner::write(JobBatch& batch) {
  if (!batch.write(options_.lease, stopping_)) return;
  trim();
  if (on_change_) on_change_();
}

}  // namespace slipway::api
