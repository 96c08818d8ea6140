#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "api/jobs/job_batch.h"
#include "api/jobs/job_progress.h"
#include "api/jobs/job_store.h"
#include "api/jobs/work_in_parts.h"

namespace slipway::api {

struct JobRunnerOptions {
  // One list of kinds per worker: that worker claims only these; an empty list claims every kind. Short work
  // has a worker of its own, so that it does not wait behind long work: see worker_kinds().
  std::vector<std::vector<std::string>> workers{{}};
  bool works_here = true;    // the workers are threads of this process; otherwise other processes work
  Admission admission = {};  // more jobs are refused
  std::optional<Retention> kept = Retention{};  // of ended jobs; nothing: another process sees to that
  int most_deaths = 5;                          // a job during which its worker died so often has failed
  std::string worker = "slipway";  // the name under which jobs are claimed; a restart gives back what it held
  std::chrono::milliseconds lease{30'000};
  std::chrono::milliseconds progress_interval{200};
  // How often work that has nothing to report renews its lease, and learns that nobody wants it any more.
  std::chrono::milliseconds renewal{1000};
  // How often an idle worker looks for jobs that others left, and who waits for an end whether it has come.
  std::chrono::milliseconds idle_poll{1000};
  std::optional<std::chrono::milliseconds> max_time = {};  // of one attempt
  // A worker claims as many short parts at once as take so long. Others wait for what it holds, and what it
  // has done of it is lost if it dies; what it has not begun after twice the time it gives back.
  std::chrono::milliseconds batch_time{2000};
};

// Who asks for a job, and how.
struct Submission {
  std::string owner = {};
  std::optional<std::string> key = {};
  int urgency = kUsualUrgency;
};

// When a job that waits is likely to begin.
struct QueueEstimate {
  int ahead = 0;                             // how many of those that wait begin before it
  std::optional<double> wait_s;              // by what the last jobs took; nothing where that is not known
  std::optional<std::string> shortage = {};  // why not all workers run, in words for a person
};

// Claims jobs from a store and runs them on its own threads; of short parts of one job each takes several at
// once. Jobs that were accepted or running when the
// process died run again. Thread-safe.
class JobRunner {
 public:
  JobRunner(std::shared_ptr<JobStore> store, JobWork work, JobRunnerOptions options = {},
            WorkInParts in_parts = {});
  ~JobRunner();  // stop()
  JobRunner(const JobRunner&) = delete;
  JobRunner& operator=(const JobRunner&) = delete;

  // Gives back what a process of this name held, and starts the workers.
  Result<void> start();
  // Stops the work and gives back what was running; nobody waits any longer. Idempotent.
  void stop();

  JobStore& store() { return *store_; }

  // Errors: too_many_jobs, storage; then nothing was accepted.
  // over_quota; invalid_request where the submission's key names another request.
  Result<Job> submit(const std::string& kind, std::string request, Submission submission = {});
  // Dismisses and stops the work. The job afterwards; nothing where the id is unknown.
  Result<std::optional<Job>> dismiss(std::string_view id);
  // The job as soon as it has ended, or as it is after the time.
  Result<std::optional<Job>> wait(std::string_view id, std::chrono::milliseconds longest);
  // Of a job that waits; nothing where it does not.
  Result<std::optional<QueueEstimate>> queue_estimate(const Job& job);
  // Looks at once whether there is new work, an end that somebody waits for, or a dismissal: another process
  // has said so.
  void ring();
  // Forgets the ended jobs that are not to be kept; called here after each job that this process has worked
  // on.
  void trim();
  // Called after each acceptance, dismissal and end, from the thread that brought it about; to be set before
  // start().
  void on_change(std::function<void()> call) { on_change_ = std::move(call); }
  // Who knows why not all workers run, where they are other processes; to be set before start().
  void on_shortage(std::function<std::optional<std::string>()> ask) { shortage_ = std::move(ask); }
  // Jobs being worked on by this process now.
  int running() const { return running_; }
  // How long the work of this process has neither reported anything nor asked whether it is wanted; the
  // longest of all jobs under way.
  std::chrono::milliseconds longest_silence() const;

 private:
  void serve(const std::vector<std::string>& kinds);
  void work_through(JobBatch& batch);
  void run(const ClaimedJob& claimed, JobBatch& batch);
  bool divided(const ClaimedJob& claimed);
  Result<JobAnswer> answer_of(const ClaimedJob& claimed, JobProgress& progress);
  Result<JobAnswer> work_on(const ClaimedJob& claimed, Progress& progress);
  void write(JobBatch& batch);

  std::shared_ptr<JobStore> store_;
  JobWork work_;
  JobRunnerOptions options_;
  WorkInParts in_parts_;

  mutable std::mutex mutex_;
  std::condition_variable submitted_;
  std::condition_variable ended_;
  std::map<std::string, JobProgress*, std::less<>> active_;  // by job id
  std::function<void()> on_change_;
  std::function<std::optional<std::string>()> shortage_;
  std::atomic<int> rings_{0};
  std::atomic<int> work_rings_{0};  // so that none is missed between a claim and the wait for the next
  std::atomic<bool> stopping_{false};
  std::atomic<int> running_{0};
  std::vector<std::thread> threads_;
};

}  // namespace slipway::api
