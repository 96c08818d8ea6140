#pragma once

#include <atomic>
#include <chrono>
#include <deque>
#include <optional>
#include <vector>

#include "api/jobs/job_store.h"

namespace slipway::api {

// How many parts are to be claimed at once so that they take `time`, by what the last ones took: at first
// one, then at most twice as many each time.
class BatchSize {
 public:
  explicit BatchSize(std::chrono::duration<double> time) : time_(time) {}
  int next() const { return next_; }
  // What the last batch has come to: so many jobs, in that time.
  void learn(int jobs, std::chrono::duration<double> took);

 private:
  std::chrono::duration<double> time_;
  int next_ = 1;
};

// What one worker has claimed at once: jobs that have not begun, and ends that are not in the store yet. Used
// by one thread at a time.
class JobBatch {
 public:
  // A batch that takes longer than `longest` is late.
  JobBatch(JobStore& store, std::vector<ClaimedJob> claimed, std::chrono::milliseconds longest);

  // One that has not begun.
  std::optional<ClaimedJob> next();
  void end(JobEnd end);
  bool is_late() const { return age() >= longest_; }
  // Of a late batch: puts the ends into the store, and gives back what has not begun.
  void settle_if_late();
  // Puts the ends into the store, tried for `longest` where that is away, but not once `stopping`: after the
  // lease somebody else does the work again. Whether there were any.
  bool write(std::chrono::milliseconds longest, const std::atomic<bool>& stopping);
  // Whether there is a next() one.
  bool has_more() const { return !waiting_.empty(); }
  int ended() const { return ended_count_; }
  std::chrono::steady_clock::duration age() const { return std::chrono::steady_clock::now() - begun_; }

 private:
  JobStore& store_;
  const std::chrono::milliseconds longest_;
  const std::chrono::steady_clock::time_point begun_;
  std::deque<ClaimedJob> waiting_;
  std::vector<JobEnd> ends_;
  int ended_count_ = 0;
};

}  // namespace slipway::api
