#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "api/jobs/job.h"
#include "core/result.h"

namespace slipway::api {

struct NewJob {
  std::string id;
  std::string kind;
  std::string request;     // its bytes, as they are to be run
  std::string owner = {};  // who asks: bounds and keys hold for each owner alone
  // The client's name for this request. A second request of the owner under it is answered with the job of
  // the first, for as long as that is kept.
  std::optional<std::string> key = {};
  int urgency = kUsualUrgency;
};

// How many jobs may be waiting or running when another is to be accepted.
struct Admission {
  std::size_t most_unfinished = 64;
  std::size_t most_of_owner = std::numeric_limits<std::size_t>::max();
};

// How many jobs of a kind are in a state.
struct JobCount {
  std::string kind;
  JobState state = JobState::kAccepted;
  std::int64_t count = 0;
};

// What is before a job that waits, of certain kinds.
struct QueuePlace {
  int ahead = 0;  // how many of those that wait begin before it
  // How long the work takes that these and those under way still have, by what the last jobs of their kinds
  // took. Nothing where a kind has none that ended well.
  std::optional<double> work_ahead_s;
};

// The right to work on a job until the lease ends or is renewed. Attempt and worker are the fence: a worker
// that was taken for dead and comes back holds an old attempt, and nothing that it writes is kept. A store
// that may lose a claim in a crash gives an attempt's number again, but to a worker of another name.
struct Lease {
  std::string id;
  int attempt = 0;
  std::string worker = {};
  std::string whole = {};  // the job that it is a part of; empty: of none
};

// Two times by JobStore::lease_clock(): leases that end before `now` have ended, a new one ends at `until`.
struct LeaseTerm {
  std::int64_t now = 0;
  std::int64_t until = 0;
};

struct ClaimedJob {
  Job job;
  std::string request;
  bool damaged = false;     // the stored request is not what was accepted, and must not be run
  std::string worker = {};  // who claimed it
  Lease lease() const { return {job.id, job.attempt, worker, job.whole}; }
};

// What is kept of a job that ended well.
struct JobAnswer {
  JobAnswer() = default;
  JobAnswer(std::string the_bytes, std::vector<std::string> the_series = {})
      : bytes(std::move(the_bytes)), series(std::move(the_series)) {}

  std::string bytes;
  std::vector<std::string> series;  // a long table in pages, which are kept and read one by one
  double cpu_s = 0.0;               // processor time that it took
};

// How a claimed job has ended: successful with its answer, or failed with its problem document.
struct JobEnd {
  Lease lease;
  JobState state = JobState::kSuccessful;
  JobAnswer outcome;
};

// A page of such a table.
struct SeriesPage {
  std::string bytes;
  bool more = false;  // another follows
};

// Why a worker gives back what it holds.
enum class HandBack {
  kStopped,  // it stops in an orderly way
  kDied,     // it died, and starts again
};

// Which ended jobs are kept: none beyond any of these, the newest first. A time of more than kLongestPause_ms
// in which no job ended looks like a clock that was set wrong, and of it only counted_pause_ms() is added to
// the age of what ended before: no such jump makes all jobs too old.
struct Retention {
  static constexpr std::int64_t kLongestPause_ms = std::int64_t{30} * 24 * 3600 * 1000;

  std::size_t most = 1000;
  std::int64_t most_age_ms = std::int64_t{90} * 24 * 3600 * 1000;
  std::int64_t most_bytes = std::int64_t{4} << 30;  // of requests and outcomes

  std::int64_t counted_pause_ms() const { return std::min(kLongestPause_ms, most_age_ms / 3); }
};

// What happens to a store that somebody may wait for.
enum class StoreNews {
  kAccepted,  // there is work
  kEnded,     // a job has ended or was dismissed
};

// Where jobs are kept: the one thing that processes and machines share. Every call stands alone and holds
// nothing open afterwards: append, claim, report, finish and dismiss each are one atomic statement or
// transaction, and a claim does not keep its transaction while the job runs. Times of a day come from the
// caller and are for people; leases are counted by a clock that all who share the store read alike, which
// nobody sets. Names of workers are new at each start of a process.
//
// Errors are always `storage`, or `storage_full` where the disk is full, except where said. After `storage`
// the change may have been made all the same: who asks again with the same key, id or lease finds it made
// once. Thread-safe.
class JobStore {
 public:
  virtual ~JobStore() = default;

  // Once this returns, the job survives the process, and whatever else the implementation promises to
  // survive. Errors: as in_place(); too_many_jobs, over_quota (the owner's) where as many are accepted or
  // running already; invalid_request at /Idempotency-Key where the key names another request.
  virtual Result<Job> append(const NewJob& job, std::int64_t now, const Admission& admission) = 0;

  // Whether what is written now is found again. Errors: storage where the store's file was moved, removed or
  // replaced while it was open.
  virtual Result<void> in_place() { return {}; }

  // The clock by which leases are counted, in milliseconds since some beginning: the machine's start for a
  // store on one machine, the server's time where a database is shared by several.
  virtual Result<std::int64_t> lease_clock() = 0;
  // Of a lease of that length that begins now.
  Result<LeaseTerm> lease_term(std::chrono::milliseconds length);

  // The most urgent, and of these the oldest, job of these kinds (of any kind where none is named) that is
  // accepted, or running under a lease that has ended, which is a death. It is running afterwards, its
  // attempt one higher. Nothing where there is none.
  //
  // Behind a part come the parts of the same job that follow it in the queue: `most` jobs in all, but not
  // more than parts_at_once() says. Parts with a death behind them are claimed alone, so that the one that
  // kills its worker brings at most one death upon others.
  virtual Result<std::vector<ClaimedJob>> claim_some(std::string_view worker,
                                                     const std::vector<std::string>& kinds, std::int64_t now,
                                                     LeaseTerm term, int most) = 0;
  // The first of them alone, where one clock serves for both times.
  Result<std::optional<ClaimedJob>> claim(std::string_view worker, const std::vector<std::string>& kinds,
                                          std::int64_t now, std::int64_t lease_until);
  // Accepts again what has not been begun under these leases; no death is counted. Lost ones are passed over.
  virtual Result<int> give_back(const std::vector<Lease>& leases) = 0;
  // Writes progress, and what was found where that is not empty, and renews the lease. False: the lease is
  // lost (dismissed, or claimed by another); stop working.
  virtual Result<bool> report(const Lease& lease, std::string_view stage, double progress,
                              std::int64_t lease_until, std::string_view best_so_far = {}) = 0;
  // All in one transaction. Of each, false: its lease is lost, nothing of it was kept.
  virtual Result<std::vector<bool>> finish_all(const std::vector<JobEnd>& ends, std::int64_t now) = 0;
  Result<bool> finish(const Lease& lease, JobState state, const JobAnswer& outcome, std::int64_t now);
  // Divides the job into parts, which are jobs of its kind, owner and urgency with these requests, and gives
  // the lease back. Until the last part has ended the job is running and nobody's; in the transaction of that
  // end it is accepted again, to be put together from its parts' answers. Parts are dismissed and forgotten
  // with their job and count for no Admission. Of an answer, only that of the whole is waited for: a part of
  // which a crash has lost the end is done again. False: the lease is lost, nothing was kept.
  virtual Result<bool> split(const Lease& lease, const std::vector<std::string>& requests,
                             std::int64_t now) = 0;
  // In their order; none of a job without parts, or of an unknown one.
  virtual Result<std::vector<Job>> parts(std::string_view id) = 0;
  // Gives back what `worker`, or one named after it ("worker/..."), holds, as accepted. A death is counted,
  // and its reason kept with the job.
  virtual Result<int> release(std::string_view worker, HandBack why, std::string_view reason = {}) = 0;

  // The job afterwards: dismissed, or as it had ended before. Nothing where the id is unknown.
  virtual Result<std::optional<Job>> dismiss(std::string_view id, std::int64_t now) = 0;
  virtual Result<std::optional<Job>> get(std::string_view id) = 0;
  // The request of a job, of whatever state, as it was accepted; nothing where the id is unknown. An error
  // where it is not what was accepted.
  virtual Result<std::optional<std::string>> request(std::string_view id) = 0;
  // The answer or the problem document of a job that ended so; nothing otherwise. An error where it is not
  // what was kept.
  virtual Result<std::optional<std::string>> outcome(std::string_view id) = 0;
  // A page of a successful job's series, from 1 on; nothing where there is no such page. An error where it is
  // not what was kept.
  virtual Result<std::optional<SeriesPage>> series(std::string_view id, std::int64_t page) = 0;
  // Of a job that waits, among jobs of these kinds. Nothing where it does not wait.
  virtual Result<std::optional<QueuePlace>> place_in_queue(std::string_view id,
                                                           const std::vector<std::string>& kinds) = 0;
  // Of those that are kept, by kind and state.
  virtual Result<std::vector<JobCount>> counts() = 0;
  // Newest first, without parts.
  virtual Result<std::vector<Job>> list(std::size_t most) = 0;
  // Forgets the ended jobs that are not to be kept, and gives their place back. Returns how many.
  virtual Result<int> forget_ended(const Retention& kept, std::int64_t now) = 0;

  // Has `call` called, from a thread of the store's, soon after another process has made such news; an empty
  // one ends that. A store that does not hear of others never calls, and news may be missed: who waits looks
  // from time to time too.
  virtual void listen(StoreNews /*news*/, std::function<void()> /*call*/) {}
};

}  // namespace slipway::api
