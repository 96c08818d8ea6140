#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "api/jobs/job_store.h"
#include "core/progress.h"

namespace slipway::api {

// What a job of some kind does with its request: the answer's bytes. It asks progress.cancelled() at least
// every 100 ms.
using JobWork =
    std::function<Result<std::string>(const std::string& kind, const std::string& request, Progress&)>;

struct JobRunnerOptions {
  // One list of kinds per worker thread: that worker claims only these; an empty list claims every kind.
  // Short work has a worker of its own, so that it does not wait behind long work: see worker_kinds().
  std::vector<std::vector<std::string>> workers{{}};
  std::size_t most_unfinished = 64;  // accepted and running jobs; more are refused
  Retention kept = {};               // of ended jobs
  int most_deaths = 5;               // a job during which the process ended so often has failed
  std::string worker = "slipway";  // the name under which jobs are claimed; a restart gives back what it held
  std::chrono::milliseconds lease{30'000};
  std::chrono::milliseconds progress_interval{200};
  std::chrono::milliseconds idle_poll{1000};  // how often an idle worker looks for jobs that others left
};

// Claims jobs from a store and runs them on its own threads. Jobs that were accepted or running when the
// process died run again. Thread-safe.
class JobRunner {
 public:
  JobRunner(std::shared_ptr<JobStore> store, JobWork work, JobRunnerOptions options = {});
  ~JobRunner();  // stop()
  JobRunner(const JobRunner&) = delete;
  JobRunner& operator=(const JobRunner&) = delete;

  // Gives back what a process of this name held, and starts the workers.
  Result<void> start();
  // Stops the work and gives back what was running; nobody waits any longer. Idempotent.
  void stop();

  JobStore& store() { return *store_; }

  // Errors: too_many_jobs, storage; then nothing was accepted.
  Result<Job> submit(const std::string& kind, std::string request);
  // Dismisses and stops the work. The job afterwards; nothing where the id is unknown.
  Result<std::optional<Job>> dismiss(std::string_view id);
  // The job as soon as it has ended, or as it is after the time.
  Result<std::optional<Job>> wait(std::string_view id, std::chrono::milliseconds longest);
  // Jobs being worked on by this process now.
  int running() const { return running_; }

 private:
  class JobProgress;

  void serve(const std::vector<std::string>& kinds);
  void run(const ClaimedJob& claimed);
  void conclude(const ClaimedJob& claimed, const Result<std::string>& answer);

  std::shared_ptr<JobStore> store_;
  JobWork work_;
  JobRunnerOptions options_;

  std::mutex mutex_;
  std::condition_variable submitted_;
  std::condition_variable ended_;
  std::map<std::string, JobProgress*, std::less<>> active_;  // by job id
  std::atomic<int> submissions_{0};  // so that none is missed between a claim and the wait for the next
  std::atomic<bool> stopping_{false};
  std::atomic<int> running_{0};
  std::vector<std::thread> threads_;
};

}  // namespace slipway::api
