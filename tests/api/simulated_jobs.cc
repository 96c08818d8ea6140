#include "simulated_jobs.h"

#include <fmt/format.h>

#include <array>
#include <map>
#include <optional>
#include <random>
#include <set>
#include <utility>
#include <vector>

namespace slipway::api::testing {
namespace {

constexpr std::int64_t kLease_ms = 1000;

// What the simulation knows of a job, as somebody outside who hears every answer.
struct KnownJob {
  std::string request;
  std::optional<std::string> key;
  bool acknowledged = false;  // otherwise it may be there or not
  bool may_be_dismissed = false;
  std::set<std::string> may_be_answers;                    // of calls whose answer was lost
  std::optional<std::string> end;                          // as it was seen: its state and answer
  std::map<std::string, std::vector<std::string>> series;  // by answer
};

// A process that works on the store; a service looks through the whole file when it opens it.
struct Process {
  int id = 0;
  std::unique_ptr<JobStore> store;
};

class Simulation {
 public:
  Simulation(std::uint64_t seed, SimulatedWorld& world) : seed_(seed), chance_(seed), world_(world) {}

  // What was found; empty: nothing.
  std::string run() {
    const bool rots = below(5) == 0;
    for (int step = 0; step < 45 && found_.empty(); ++step) {
      now_ += below(20) == 0 ? 5 * kLease_ms : below(50);
      Process& process = processes_[below(processes_.size())];
      if (below(4) == 0) arm();
      if (process.store || open(process)) act(*process.store);
      world_.rest();
      bury();
      if (rots && below(20) == 0) rotten_ = world_.rot() || rotten_;
    }
    if (!rotten_ && found_.empty()) end_well();
    for (Process& process : processes_) close(process);
    return found_;
  }

 private:
  int below(std::size_t most) { return static_cast<int>(chance_() % most); }

  void arm() {
    const int mishap = below(SimulatedWorld::kMishaps);
    world_.arm(mishap, below(40));
  }

  void violated(std::string what) {
    if (found_.empty()) found_ = fmt::format("seed {}: {}", seed_, what);
  }

  // Every error says why.
  template <class T>
  bool answered(const Result<T>& result) {
    if (result) return true;
    const Error& why = result.error();
    const bool expected = why.code == ErrorCode::kStorage || why.code == ErrorCode::kStorageFull ||
                          why.code == ErrorCode::kDamagedStore;
    if (!expected || why.detail.empty())
      violated(fmt::format("refused with {}: \"{}\"", error_row(why.code).name, why.detail));
    return false;
  }

  bool open(Process& process) {
    process.id = world_.begin_process();
    const bool is_service = &process == &processes_.front();
    auto store = world_.open(process.id, is_service);
    if (answered(store)) process.store = *std::move(store);
    // A service gives back what its workers held when it died with them.
    if (process.store && is_service) answered(process.store->release("w", HandBack::kDied, "it died"));
    return process.store != nullptr;
  }

  // What is left of it does nothing any more.
  void close(Process& process) {
    world_.die(process.id);
    process.store.reset();
  }

  void bury() {
    for (Process& process : processes_)
      if (process.store && world_.is_dead(process.id)) close(process);
    if (below(30) == 0) close(processes_[below(processes_.size())]);
    if (below(60) == 0) {
      world_.lose_power();
      bury_all();
    }
  }
  void bury_all() {
    for (Process& process : processes_) close(process);
  }

  void act(JobStore& store) {
    switch (below(10)) {
      case 0:
      case 1:
        return append(store);
      case 2:
      case 3:
        return claim(store);
      case 4:
      case 5:
        return finish(store);
      case 6:
        return leases_.empty() ? claim(store) : report(store, leases_[below(leases_.size())]);
      case 7:
        return dismiss(store);
      case 8:
        answered(store.list(100));
        return;
      default:
        return look(store);
    }
  }

  std::string random_id() {
    std::string id;
    for (int k = 0; k < 32; ++k) id += "0123456789abcdef"[below(16)];
    return id;
  }

  // A new request, or one again of which the answer was lost.
  void append(JobStore& store) {
    std::string id = random_id();
    NewJob job{.id = id, .kind = "plan", .request = fmt::format("request {}", id), .owner = "o"};
    if (below(2) == 0) job.key = fmt::format("key {}", id);
    for (const auto& [known_id, known] : jobs_)
      if (known.key && below(4) == 0) {
        job.request = known.request;
        job.key = known.key;
        id = known_id;
      }
    const auto accepted = store.append(job, now_, {1000, 1000});
    if (accepted && job.key && jobs_.contains(id) && accepted->id != id && jobs_[id].acknowledged &&
        !may_be_forgotten_)
      violated(fmt::format("a repeated request is job {} and not {}", accepted->id, id));
    const std::string named = accepted ? accepted->id : job.id;
    KnownJob& known = jobs_[named];
    known.request = job.request;
    known.key = job.key;
    known.acknowledged = known.acknowledged || accepted;
    answered(accepted);
  }

  void claim(JobStore& store) {
    const std::string worker = fmt::format("w/{}", below(2));
    const auto claimed = store.claim_some(worker, {}, now_, {now_, now_ + kLease_ms}, 3);
    if (!answered(claimed)) return;
    for (const ClaimedJob& job : *claimed) {
      leases_.push_back(job.lease());
      parts_.insert({job.job.id, job.job.whole});
      if (job.damaged || !job.job.whole.empty()) continue;
      if (!jobs_.contains(job.job.id)) return violated("a job is claimed that nobody asked for");
      const KnownJob& known = jobs_[job.job.id];
      if (known.request != job.request) return violated("another request is run than was asked");
      if (known.end) return violated(fmt::format("job {} is run after its end", job.job.id));
      if (job.job.parts.count == 0 && below(4) == 0) split(store, job);
    }
  }

  void split(JobStore& store, const ClaimedJob& job) {
    answered(store.split(job.lease(), {"part 0", "part 1"}, now_));
  }

  void report(JobStore& store, const Lease& lease) {
    answered(store.report(lease, "work", 0.5, now_ + kLease_ms));
  }

  void finish(JobStore& store) {
    if (leases_.empty()) return claim(store);
    const Lease lease = leases_[below(leases_.size())];
    JobAnswer answer(fmt::format("answer {}", below(1'000'000)));
    for (int page = below(3); page > 0; --page)
      answer.series.push_back(std::string(1 + below(3000), static_cast<char>('a' + below(26))));
    const auto kept = store.finish(lease, JobState::kSuccessful, answer, now_);
    if (!lease.whole.empty()) return static_cast<void>(answered(kept));
    KnownJob& known = jobs_[lease.id];
    known.series[answer.bytes] = answer.series;
    if (!answered(kept)) {
      known.may_be_answers.insert(answer.bytes);
    } else if (*kept) {
      if (known.end) violated(fmt::format("job {} ended twice", lease.id));
      known.end = "successful " + answer.bytes;
    }
  }

  void dismiss(JobStore& store) {
    if (jobs_.empty() || below(3) != 0) return look(store);
    const std::string id = any_job();
    const auto job = store.dismiss(id, now_);
    if (!answered(job)) jobs_[id].may_be_dismissed = true;
    if (job && *job && (*job)->state == JobState::kDismissed) seen(store, **job, true);
  }

  std::string any_job() { return std::next(jobs_.begin(), below(jobs_.size()))->first; }

  void look(JobStore& store) {
    if (jobs_.empty()) return;
    check(store, any_job());
    if (below(10) != 0) return;
    may_be_forgotten_ = true;
    answered(store.forget_ended({.most = static_cast<std::size_t>(below(20))}, now_));
  }

  void check(JobStore& store, const std::string& id) {
    const auto job = store.get(id);
    if (!answered(job)) return;
    const KnownJob& known = jobs_[id];
    if (!*job) {
      const bool may_have_ended = known.end || known.may_be_dismissed || !known.may_be_answers.empty();
      if (known.acknowledged && !(may_be_forgotten_ && may_have_ended))
        violated(fmt::format("job {} was accepted and is lost", id));
      return;
    }
    const auto request = store.request(id);
    if (answered(request) && *request && **request != known.request) violated("an altered request is served");
    seen(store, **job, false);
  }

  // Of a job that ended: it is as it was seen before, or as somebody may have ended it.
  void seen(JobStore& store, const Job& job, bool by_dismissal) {
    KnownJob& known = jobs_[job.id];
    if (known.end && !has_ended(job.state)) violated(fmt::format("job {} goes on after its end", job.id));
    if (!has_ended(job.state)) return;
    std::string end(describe(job.state));
    if (job.state == JobState::kSuccessful) {
      const auto outcome = store.outcome(job.id);
      if (!answered(outcome) || !*outcome) return;
      const std::string& answer = **outcome;
      end += " " + answer;
      if (!known.end && !known.may_be_answers.contains(answer)) violated("an answer that nobody gave");
      const auto& pages = known.series[answer];
      for (std::size_t k = 0; k < pages.size(); ++k) {
        const auto page = store.series(job.id, static_cast<std::int64_t>(k + 1));
        if (!answered(page)) return;
        if (!*page || (*page)->bytes != pages[k]) violated("a page of an answer is altered or lost");
      }
    } else if (!known.end && !known.may_be_dismissed && !by_dismissal) {
      violated(fmt::format("job {} is {} and nobody did that", job.id, describe(job.state)));
    }
    if (known.end && *known.end != end) violated(fmt::format("\"{}\" has become \"{}\"", *known.end, end));
    known.end = end;
  }

  // Where nothing has rotted all that was accepted comes to an end.
  void end_well() {
    bury_all();
    Process& process = processes_.front();
    if (!open(process)) return violated("a sound store does not open");
    JobStore& store = *process.store;
    for (int turn = 0; turn < 1000; ++turn) {
      now_ += 10 * kLease_ms;
      const auto claimed = store.claim_some("w/last", {}, now_, {now_, now_ + kLease_ms}, 1);
      if (!claimed) return violated("nothing can be claimed of a sound store: " + claimed.error().detail);
      if (claimed->empty()) break;
      leases_ = {claimed->front().lease()};
      finish(store);
    }
    for (const auto& [id, known] : jobs_) {
      check(store, id);
      if (known.acknowledged && !known.end && !may_be_forgotten_)
        violated(fmt::format("job {} was accepted and never ends", id));
    }
  }

  std::uint64_t seed_;
  std::mt19937_64 chance_;
  SimulatedWorld& world_;
  std::int64_t now_ = 1'000'000;
  std::array<Process, 3> processes_;
  std::map<std::string, KnownJob> jobs_;
  std::multimap<std::string, std::string> parts_;
  std::vector<Lease> leases_;
  bool may_be_forgotten_ = false, rotten_ = false;
  std::string found_;
};

}  // namespace

std::string simulate_jobs(std::uint64_t seed, SimulatedWorld& world) {
  return Simulation(seed, world).run();
}

}  // namespace slipway::api::testing
