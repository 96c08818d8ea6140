#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/jobs/job.h"
#include "core/result.h"

namespace slipway::api {

struct NewJob {
  std::string id;
  std::string kind;
  std::string request;  // its bytes, as they are to be run
};

// The right to work on a job until the lease ends or is renewed. The attempt is the fence: a worker that was
// taken for dead and comes back holds an old attempt, and nothing that it writes is kept.
struct Lease {
  std::string id;
  int attempt = 0;
};

struct ClaimedJob {
  Job job;
  std::string request;
  Lease lease() const { return {job.id, job.attempt}; }
};

// Where jobs are kept: the one thing that machines would have to share. Every call stands alone and holds
// nothing open afterwards, so that a database server or a service can implement it: append, claim, report,
// finish and dismiss each are one atomic statement or transaction, and a claim does not keep its transaction
// while the job runs (PostgreSQL: SELECT ... FOR UPDATE SKIP LOCKED, then a lease). Times come from the
// caller; machines that share a store keep their clocks within a fraction of the lease.
//
// Errors are always `storage`, except where said. Thread-safe.
class JobStore {
 public:
  virtual ~JobStore() = default;

  // Once this returns, the job survives the process, and whatever else the implementation promises to
  // survive. too_many_jobs when `most_unfinished` jobs are accepted or running already.
  virtual Result<Job> append(const NewJob& job, std::int64_t now, std::size_t most_unfinished) = 0;

  // The oldest job of these kinds (of any kind where none is named) that is accepted, or running under a
  // lease that has ended. It is running afterwards, its attempt one higher. Nothing where there is none.
  virtual Result<std::optional<ClaimedJob>> claim(std::string_view worker,
                                                  const std::vector<std::string>& kinds, std::int64_t now,
                                                  std::int64_t lease_until) = 0;
  // Writes progress and renews the lease. False: the lease is lost (dismissed, or claimed by another); stop
  // working.
  virtual Result<bool> report(const Lease& lease, std::string_view stage, double progress,
                              std::int64_t lease_until) = 0;
  // successful with its answer, or failed with its problem document. False: the lease is lost, nothing was
  // kept.
  virtual Result<bool> finish(const Lease& lease, JobState state, std::string_view outcome,
                              std::int64_t now) = 0;
  // Gives back what `worker` holds, as accepted: for a worker that stops, or starts again after it died.
  virtual Result<int> release(std::string_view worker) = 0;

  // The job afterwards: dismissed, or as it had ended before. Nothing where the id is unknown.
  virtual Result<std::optional<Job>> dismiss(std::string_view id, std::int64_t now) = 0;
  virtual Result<std::optional<Job>> get(std::string_view id) = 0;
  // The answer or the problem document of a job that ended so; nothing otherwise.
  virtual Result<std::optional<std::string>> outcome(std::string_view id) = 0;
  // Newest first.
  virtual Result<std::vector<Job>> list(std::size_t most) = 0;
  // Forgets the oldest ended jobs, beyond the `most_kept` newest ones. Returns how many.
  virtual Result<int> forget_ended(std::size_t most_kept) = 0;
};

}  // namespace slipway::api
