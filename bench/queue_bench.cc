// How many parts of a job a second a store hands out and takes back, and whether workers that only sleep are
// kept busy.
//
//   queue_bench STORE WORKERS SLEEP_MS PARTS
//
// STORE is what --jobs takes. One job is divided into PARTS parts, on which WORKERS threads work as the
// workers of `slipway worker` do; 16 of them share connections as little as as many processes would. Prints
// one JSON line; `repeated` counts attempts beyond one for each part.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "api/jobs/job_runner.h"
#include "api/jobs/open_job_store.h"
#include "core/utc.h"

namespace {

namespace api = slipway::api;
using slipway::Progress;
using slipway::Result;
using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

constexpr milliseconds kLease{600'000};

// The work that sleeps in each of its parts.
api::WorkInParts sleep_in_parts(milliseconds sleep) {
  return {.split = nullptr,
          .part = [sleep](const std::string&, const std::string&, Progress&) -> Result<api::JobAnswer> {
            if (sleep.count() > 0) std::this_thread::sleep_for(sleep);
            return api::JobAnswer("{}");
          },
          .put_together = [](const std::string&, const std::string&, const api::PartAnswer&,
                             Progress&) -> Result<api::JobAnswer> { return api::JobAnswer("{}"); }};
}

// Runners on the store, which share the workers among them.
std::vector<std::unique_ptr<api::JobRunner>> open_runners(const std::string& address, int workers,
                                                          const api::WorkInParts& work) {
  constexpr int kMaxStores = 4;
  std::vector<std::unique_ptr<api::JobRunner>> runners;
  const int stores = std::min(workers, kMaxStores);
  for (int k = 0; k < stores; ++k) {
    auto store = api::open_job_store(address);
    if (!store) {
      std::cerr << store.error().detail << '\n';
      return {};
    }
    api::JobRunnerOptions options;
    options.workers.assign(static_cast<std::size_t>((workers + k) / stores), {"sleep"});
    options.worker = "sleeper " + api::new_job_id();
    options.lease = kLease;
    options.progress_interval = milliseconds(1000);  // as of workers on a database
    options.kept = std::nullopt;
    runners.push_back(std::make_unique<api::JobRunner>(std::move(*store), nullptr, options, work));
  }
  return runners;
}

// The job that is divided, before anybody works; empty where the store refuses it.
std::string divide(api::JobStore& store, int parts) {
  const auto job = store.append({api::new_job_id(), "sleep", "{}"}, slipway::now_ms(), {1000});
  if (!job) return {};
  const auto claimed =
      store.claim("divider", {"sleep"}, slipway::now_ms(), slipway::now_ms() + kLease.count());
  const std::vector<std::string> requests(static_cast<std::size_t>(parts), "{}");
  const bool divided = claimed && *claimed && (*claimed)->job.id == job->id &&
                       store.split((*claimed)->lease(), requests, slipway::now_ms()).value_or(false);
  return divided ? job->id : "";
}

// Until all parts have ended.
void wait_for(api::JobStore& store, const std::string& id, int parts) {
  for (;; std::this_thread::sleep_for(milliseconds(10)))
    if (const auto job = store.get(id); job && *job && (*job)->parts.ended == parts) return;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) {
    std::cerr << "usage: queue_bench STORE WORKERS SLEEP_MS PARTS\n";
    return 2;
  }
  const int workers = std::atoi(argv[2]), parts = std::atoi(argv[4]);
  const milliseconds sleep(std::atoi(argv[3]));
  const auto runners = open_runners(argv[1], workers, sleep_in_parts(sleep));
  if (runners.empty()) return 1;
  api::JobStore& store = runners.front()->store();
  const std::string job = divide(store, parts);
  if (job.empty()) {
    std::cerr << "the store took no job in parts: has it others?\n";
    return 1;
  }
  const auto begun = Clock::now();
  for (const auto& runner : runners)
    if (!runner->start()) return 1;
  wait_for(store, job, parts);
  const double seconds = std::chrono::duration<double>(Clock::now() - begun).count();
  const auto done = store.parts(job);
  int repeated = 0;
  for (const api::Job& part : *done) repeated += part.attempt - 1;
  for (const auto& runner : runners) runner->stop();
  std::cout << fmt::format(
      "{{\"workers\":{},\"sleep_ms\":{},\"parts\":{},\"repeated\":{},\"seconds\":{:.2f},\"parts_per_s\":{:."
      "0f},"
      "\"busy\":{:.3f}}}\n",
      workers, sleep.count(), parts, repeated, seconds, parts / seconds,
      1e-3 * static_cast<double>(sleep.count()) * parts / (workers * seconds));
  return repeated == 0 ? 0 : 1;
}
