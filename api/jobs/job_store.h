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
  bool damaged = false;  // the stored request is not what was accepted, and must not be run
  Lease lease() const { return {job.id, job.attempt}; }
};

// Why a worker gives back what it holds.
enum class HandBack {
  kStopped,  // it stops in an orderly way
  kDied,     // it died, and starts again
};

// Which ended jobs are kept: none beyond any of these, the newest first.
struct Retention {
  std::size_t most = 1000;
  std::int64_t most_age_ms = std::int64_t{90} * 24 * 3600 * 1000;
  std::int64_t most_bytes = std::int64_t{4} << 30;  // of requests and outcomes
};

// Where jobs are kept: the one thing that machines would have to share. Every call stands alone and holds
// nothing open afterwards, so that a database server or a service can implement it: append, claim, report,
// finish and dismiss each are one atomic statement or transaction, and a claim does not keep its transaction
// while the job runs (PostgreSQL: SELECT ... FOR UPDATE SKIP LOCKED, then a lease). Times come from the
// caller; machines that share a store keep their clocks within a fraction of the lease.
//
// Errors are always `storage`, or `storage_full` where the disk is full, except where said. Thread-safe.
class JobStore {
 public:
  virtual ~JobStore() = default;

  // Once this returns, the job survives the process, and whatever else the implementation promises to
  // survive. too_many_jobs when `most_unfinished` jobs are accepted or running already.
  virtual Result<Job> append(const NewJob& job, std::int64_t now, std::size_t most_unfinished) = 0;

  // The oldest job of these kinds (of any kind where none is named) that is accepted, or running under a
  // lease that has ended, which is a death. It is running afterwards, its attempt one higher. Nothing where
  // there is none.
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
  // Gives back what `worker` holds, as accepted; a death is counted.
  virtual Result<int> release(std::string_view worker, HandBack why) = 0;

  // The job afterwards: dismissed, or as it had ended before. Nothing where the id is unknown.
  virtual Result<std::optional<Job>> dismiss(std::string_view id, std::int64_t now) = 0;
  virtual Result<std::optional<Job>> get(std::string_view id) = 0;
  // The request of a job, of whatever state, as it was accepted; nothing where the id is unknown. An error
  // where it is not what was accepted.
  virtual Result<std::optional<std::string>> request(std::string_view id) = 0;
  // The answer or the problem document of a job that ended so; nothing otherwise. An error where it is not
  // what was kept.
  virtual Result<std::optional<std::string>> outcome(std::string_view id) = 0;
  // Newest first.
  virtual Result<std::vector<Job>> list(std::size_t most) = 0;
  // Forgets the ended jobs that are not to be kept, and gives their place back. Returns how many.
  virtual Result<int> forget_ended(const Retention& kept, std::int64_t now) = 0;
};

}  // namespace slipway::api
