#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include "api/jobs/job_store.h"
#include "core/progress.h"

namespace slipway::api {

// What the progress of a job is told to, and when.
struct JobProgressPlace {
  JobStore& store;
  std::chrono::milliseconds lease;              // for which each writing renews it
  std::chrono::milliseconds progress_interval;  // between two writings of what the work reports
  std::chrono::milliseconds renewal;            // between two writings of work that has nothing to report
  std::optional<std::chrono::milliseconds> max_time;
  const std::atomic<bool>& stopping;  // nobody of this process works any longer
  const std::atomic<int>& rings;      // grows whenever the store may say something else than before
};

// Passes progress on to the store, not more often than the place says, and renews the lease. Learns from the
// store, the process and the clock that nobody wants the work any more. The stages of a part are nobody's
// news: its first word goes to the store after the interval. Thread-safe.
class JobProgress final : public Progress {
 public:
  // `on_writing` is called with each writing, by one thread at a time, and not once the work has returned.
  JobProgress(const JobProgressPlace& place, Lease lease, std::function<void()> on_writing);

  void report(std::string_view stage, double fraction) override;
  bool cancelled() const override;
  void found(const RouteSoFar& route) override;

  void cancel() { cancelled_ = true; }
  bool is_over_time() const;
  // Since the work last reported or asked.
  std::chrono::milliseconds silence() const;

 private:
  using Clock = std::chrono::steady_clock;

  void write() const;

  const JobProgressPlace place_;
  const Lease lease_;
  const std::function<void()> on_writing_;
  const Clock::time_point begun_;
  mutable std::mutex mutex_;
  mutable Clock::time_point written_;
  mutable int rings_;  // of the process, as of the last writing
  mutable std::atomic<Clock::duration> heard_;
  mutable std::atomic<bool> cancelled_{false};
  std::string stage_;
  double fraction_ = 0.0;
  mutable std::string best_so_far_;  // that is not written yet
};

}  // namespace slipway::api
