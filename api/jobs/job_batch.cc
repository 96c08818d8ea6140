#include "api/jobs/job_batch.h"

#include <algorithm>
#include <iterator>
#include <thread>
#include <utility>

#include "core/utc.h"

namespace slipway::api {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

void BatchSize::learn(int jobs, std::chrono::duration<double> took) {
  constexpr int kMost = 256;
  const double fit = time_ / std::max(took / std::max(jobs, 1), std::chrono::duration<double>(1e-6));
  next_ = static_cast<int>(std::clamp(fit, 1.0, 1.0 * std::min(2 * next_, kMost)));
}

JobBatch::JobBatch(JobStore& store, std::vector<ClaimedJob> claimed, milliseconds longest)
    : store_(store),
      longest_(longest),
      begun_(Clock::now()),
      waiting_(std::make_move_iterator(claimed.begin()), std::make_move_iterator(claimed.end())) {}

std::optional<ClaimedJob> JobBatch::next() {
  if (waiting_.empty()) return std::nullopt;
  ClaimedJob job = std::move(waiting_.front());
  waiting_.pop_front();
  return job;
}

void JobBatch::end(JobEnd end) {
  ends_.push_back(std::move(end));
  ++ended_count_;
}

void JobBatch::settle_if_late() {
  if (!is_late()) return;
  // What fails here is tried again with the next writing, or when the job has ended.
  if (!ends_.empty() && store_.finish_all(ends_, now_ms())) ends_.clear();
  if (waiting_.empty()) return;
  std::vector<Lease> leases;
  for (const ClaimedJob& job : waiting_) leases.push_back(job.lease());
  if (store_.give_back(leases)) waiting_.clear();
}

bool JobBatch::write(milliseconds longest, const std::atomic<bool>& stopping) {
  const std::vector<JobEnd> ends = std::exchange(ends_, {});
  if (ends.empty()) return false;
  const auto until = Clock::now() + longest;
  constexpr milliseconds kBetweenTries{200};
  for (;;) {
    const auto kept = store_.finish_all(ends, now_ms());
    const bool may_pass = !kept && kept.error().code == ErrorCode::kStorage;
    if (!may_pass || stopping || Clock::now() >= until) return true;
    std::this_thread::sleep_for(kBetweenTries);
  }
}

}  // namespace slipway::api
