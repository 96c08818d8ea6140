// How many jobs a second a store hands out and takes back, and whether workers that only sleep are kept busy.
//
//   queue_bench STORE WORKERS SLEEP_MS JOBS
//
// STORE is what --jobs takes. One job is divided into JOBS parts, and WORKERS threads claim, sleep and finish
// until none is left; 16 of them share connections as little as as many processes would. Prints one JSON
// line.
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "api/jobs/open_job_store.h"
#include "core/utc.h"

namespace {

using slipway::now_ms;
using slipway::api::JobStore;
using Clock = std::chrono::steady_clock;

constexpr std::int64_t kLease_ms = 600'000;

struct Outcome {
  std::atomic<int> done{0}, refused{0};
};

// Until no part is left.
void work(JobStore& store, const std::string& name, std::chrono::milliseconds sleep, int jobs,
          Outcome& outcome) {
  while (outcome.done < jobs) {
    const auto claimed = store.claim(name, {"sleep"}, now_ms(), now_ms() + kLease_ms);
    if (!claimed) {
      std::cerr << claimed.error().detail << '\n';
      continue;
    }
    if (!*claimed) return;
    const bool is_part = !(*claimed)->job.whole.empty();
    if (is_part && sleep.count() > 0) std::this_thread::sleep_for(sleep);
    const auto kept =
        store.finish((*claimed)->lease(), slipway::api::JobState::kSuccessful, std::string("{}"), now_ms());
    if (is_part) ++(kept && *kept ? outcome.done : outcome.refused);
  }
}

// The parts of one job of this store.
bool divide(JobStore& store, int jobs) {
  const auto job = store.append({slipway::api::new_job_id(), "sleep", "{}"}, now_ms(), {1000});
  if (!job) std::cerr << job.error().detail << '\n';
  const auto claimed = store.claim("divider", {"sleep"}, now_ms(), now_ms() + kLease_ms);
  return job && claimed && *claimed &&
         store
             .split((*claimed)->lease(), std::vector<std::string>(static_cast<std::size_t>(jobs), "{}"),
                    now_ms())
             .value_or(false);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) {
    std::cerr << "usage: queue_bench STORE WORKERS SLEEP_MS JOBS\n";
    return 2;
  }
  const int workers = std::atoi(argv[2]), jobs = std::atoi(argv[4]);
  const std::chrono::milliseconds sleep(std::atoi(argv[3]));
  constexpr int kMaxStores = 4;
  std::vector<std::unique_ptr<JobStore>> stores;
  for (int k = 0; k < std::min(workers, kMaxStores); ++k) {
    auto opened = slipway::api::open_job_store(argv[1]);
    if (!opened) {
      std::cerr << opened.error().detail << '\n';
      return 1;
    }
    stores.push_back(std::move(*opened));
  }
  if (!divide(*stores.front(), jobs)) return 1;
  Outcome outcome;
  const auto begun = Clock::now();
  std::vector<std::thread> threads;
  for (int k = 0; k < workers; ++k)
    threads.emplace_back([&, k] {
      work(*stores[static_cast<std::size_t>(k) % stores.size()], fmt::format("worker {}", k), sleep, jobs,
           outcome);
    });
  for (std::thread& thread : threads) thread.join();
  const double seconds = std::chrono::duration<double>(Clock::now() - begun).count();
  std::cout << fmt::format(
      "{{\"workers\":{},\"sleep_ms\":{},\"jobs\":{},\"refused\":{},\"seconds\":{:.2f},\"jobs_per_s\":{:.0f},"
      "\"busy\":{:.3f}}}\n",
      workers, sleep.count(), outcome.done.load(), outcome.refused.load(), seconds, outcome.done / seconds,
      1e-3 * static_cast<double>(sleep.count()) * outcome.done / (workers * seconds));
  return outcome.done == jobs ? 0 : 1;
}
