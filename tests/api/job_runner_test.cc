#include "api/jobs/job_runner.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <future>
#include <mutex>
#include <new>
#include <string>
#include <thread>

#include "api/jobs/open_job_store.h"
#include "api/jobs/sqlite_job_store.h"
#include "api/json/problem_document.h"
#include "core/utc.h"
#include "small_world.h"

namespace slipway::api {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::ScratchFolder;

Result<std::string> echo(const std::string& kind, const std::string& request, Progress& progress) {
  progress.report("echoing", 0.5);
  return kind + ": " + request;
}

// Work that ends only when it hears that nobody wants it.
struct Endless {
  std::atomic<int> begun{0};
  std::atomic<int> ended{0};
  Result<std::string> operator()(const std::string& /*kind*/, const std::string& /*request*/,
                                 Progress& progress) {
    ++begun;
    while (!progress.cancelled()) std::this_thread::sleep_for(milliseconds(20));
    ++ended;
    return fail(ErrorCode::kCancelled, "cancelled");
  }
};

void wait_until(const std::function<bool()>& condition) {
  const auto until = std::chrono::steady_clock::now() + seconds(10);
  while (!condition() && std::chrono::steady_clock::now() < until)
    std::this_thread::sleep_for(milliseconds(5));
  ASSERT_TRUE(condition());
}

TEST(JobRunner, RunsAJobToItsAnswer) {
  JobRunner runner(open_job_store("").value(), echo);
  ASSERT_TRUE(runner.start());
  const auto job = runner.submit("plan", "{}");
  ASSERT_TRUE(job);
  EXPECT_EQ(job->state, JobState::kAccepted);
  EXPECT_EQ(runner.wait(job->id, seconds(5)).value()->state, JobState::kSuccessful);
  EXPECT_EQ(runner.store().outcome(job->id).value(), "plan: {}");
}

// The thread sanitizer (preset tsan) sees what is read beside the lock.
TEST(JobRunner, WorkOfManyThreadsReportsAndAsks) {
  JobRunner runner(open_job_store("").value(),
                   [](const std::string&, const std::string&, Progress& progress) {
                     std::atomic<bool> done{false};
                     const auto ask = [&] {
                       while (!done) static_cast<void>(progress.cancelled());
                     };
                     std::thread one(ask), other(ask);
                     for (int k = 0; k < 200; ++k) progress.report("stage " + std::to_string(k), k / 200.0);
                     done = true;
                     one.join();
                     other.join();
                     return Result<std::string>("answer");
                   });
  ASSERT_TRUE(runner.start());
  const std::string id = runner.submit("plan", "{}")->id;
  ASSERT_EQ(runner.wait(id, seconds(30)).value()->state, JobState::kSuccessful);
  EXPECT_EQ(runner.store().get(id).value()->stage, "stage 199");
}

TEST(JobRunner, AFailureAndABrokenPromiseAreProblems) {
  JobRunner runner(open_job_store("").value(), [](const std::string&, const std::string& request, Progress&) {
    if (request == "throw") throw std::logic_error("broken");
    return Result<std::string>(fail(ErrorCode::kNoData, "hole", {{"/path/1", "m"}}));
  });
  ASSERT_TRUE(runner.start());
  const std::string failing = runner.submit("plan", "{}")->id;
  const std::string throwing = runner.submit("plan", "throw")->id;
  EXPECT_EQ(runner.wait(failing, seconds(5)).value()->state, JobState::kFailed);
  EXPECT_EQ(runner.wait(throwing, seconds(5)).value()->state, JobState::kFailed);
  const Error error = json::read_problem(runner.store().outcome(failing).value().value());
  EXPECT_EQ(error.code, ErrorCode::kNoData);
  EXPECT_EQ(error.faults, (std::vector<Fault>{{"/path/1", "m"}}));
  EXPECT_EQ(json::read_problem(runner.store().outcome(throwing).value().value()).code, ErrorCode::kInternal);
}

TEST(JobRunner, DismissingStopsTheWorkWithinTwoSeconds) {
  Endless endless;
  JobRunner runner(open_job_store("").value(), std::ref(endless));
  ASSERT_TRUE(runner.start());
  const std::string id = runner.submit("plan", "{}")->id;
  wait_until([&] { return endless.begun == 1; });
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(runner.dismiss(id).value()->state, JobState::kDismissed);
  wait_until([&] { return endless.ended == 1 && runner.running() == 0; });
  EXPECT_LT(std::chrono::steady_clock::now() - begin, seconds(2));
  EXPECT_EQ(runner.store().get(id).value()->state, JobState::kDismissed);
  EXPECT_EQ(runner.store().outcome(id).value(), std::nullopt);
}

TEST(JobRunner, AnAnswerThatComesAfterTheDismissalIsNeverShown) {
  std::promise<void> begun;
  std::promise<void> go_on;
  JobRunner runner(open_job_store("").value(), [&](const std::string&, const std::string&, Progress&) {
    begun.set_value();
    go_on.get_future().wait();  // deaf to cancelled()
    return Result<std::string>("late");
  });
  ASSERT_TRUE(runner.start());
  const std::string id = runner.submit("plan", "{}")->id;
  begun.get_future().wait();
  ASSERT_TRUE(runner.dismiss(id));
  go_on.set_value();
  wait_until([&] { return runner.running() == 0; });
  EXPECT_EQ(runner.store().get(id).value()->state, JobState::kDismissed);
  EXPECT_EQ(runner.store().outcome(id).value(), std::nullopt);
}

TEST(JobRunner, ADismissalWakesWhoWaits) {
  Endless endless;
  JobRunner runner(open_job_store("").value(), std::ref(endless));
  ASSERT_TRUE(runner.start());
  const std::string id = runner.submit("plan", "{}")->id;
  auto waiting = std::async(std::launch::async, [&] { return runner.wait(id, seconds(20)); });
  wait_until([&] { return endless.begun == 1; });
  ASSERT_TRUE(runner.dismiss(id));
  ASSERT_EQ(waiting.wait_for(seconds(2)), std::future_status::ready);
  EXPECT_EQ(waiting.get().value()->state, JobState::kDismissed);
}

TEST(JobRunner, ShortWorkDoesNotWaitBehindLongWork) {
  Endless endless;
  JobRunnerOptions options;
  options.workers = {{"plan", "prediction"}, {"prediction"}};
  JobRunner runner(
      open_job_store("").value(),
      [&](const std::string& kind, const std::string& request, Progress& p) {
        return kind == "plan" ? endless(kind, request, p) : echo(kind, request, p);
      },
      options);
  ASSERT_TRUE(runner.start());
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(runner.submit("plan", "{}"));
  const std::string id = runner.submit("prediction", "{}")->id;
  EXPECT_EQ(runner.wait(id, seconds(5)).value()->state, JobState::kSuccessful);
}

TEST(JobRunner, RefusesJobsWhenTheQueueIsFull) {
  Endless endless;
  JobRunnerOptions options;
  options.admission.most_unfinished = 2;
  JobRunner runner(open_job_store("").value(), std::ref(endless), options);
  ASSERT_TRUE(runner.start());
  ASSERT_TRUE(runner.submit("plan", "{}"));
  ASSERT_TRUE(runner.submit("plan", "{}"));
  EXPECT_EQ(runner.submit("plan", "{}").error().code, ErrorCode::kTooManyJobs);
}

TEST(JobRunner, WhatWasAcceptedOrRunningRunsAfterARestart) {
  const ScratchFolder folder;
  const auto path = folder.path() / "jobs.sqlite";
  std::vector<std::string> ids;
  {
    Endless endless;
    JobRunner runner(std::shared_ptr<JobStore>(std::move(*open_sqlite_job_store(path))), std::ref(endless));
    ASSERT_TRUE(runner.start());
    for (int i = 0; i < 3; ++i) ids.push_back(runner.submit("plan", std::to_string(i))->id);
    wait_until([&] { return endless.begun == 1; });
  }
  JobRunner runner(std::shared_ptr<JobStore>(std::move(*open_sqlite_job_store(path))), echo);
  ASSERT_TRUE(runner.start());
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(runner.wait(ids[i], seconds(5)).value()->state, JobState::kSuccessful);
    EXPECT_EQ(runner.store().outcome(ids[i]).value(), "plan: " + std::to_string(i));
  }
}

TEST(JobRunner, AJobOfADeadProcessIsTakenUpThoughItsLeaseStillRuns) {
  const std::shared_ptr<JobStore> store = open_job_store("").value();
  ASSERT_TRUE(store->append({new_job_id(), "plan", "{}"}, now_ms(), {10}));
  const std::string id = store->claim("slipway", {"plan"}, now_ms(), now_ms() + 3'600'000).value()->job.id;
  JobRunner runner(store, echo);
  ASSERT_TRUE(runner.start());
  EXPECT_EQ(runner.wait(id, seconds(5)).value()->state, JobState::kSuccessful);
}

TEST(JobRunner, AJobThatEndsTheProcessAgainAndAgainFails) {
  const std::shared_ptr<JobStore> store = open_job_store("").value();
  const std::string id = store->append({new_job_id(), "plan", "{}"}, now_ms(), {10})->id;
  JobRunnerOptions options;
  for (int i = 0; i < options.most_deaths; ++i) {
    ASSERT_TRUE(store->claim("slipway", {"plan"}, now_ms(), now_ms() + 1000).value());
    ASSERT_EQ(store->release("slipway", HandBack::kDied).value(), 1);
  }
  std::atomic<int> worked{0};
  JobRunner runner(store, [&](const std::string&, const std::string&, Progress&) {
    ++worked;
    return Result<std::string>("answer");
  });
  ASSERT_TRUE(runner.start());
  EXPECT_EQ(runner.wait(id, seconds(5)).value()->state, JobState::kFailed);
  EXPECT_EQ(worked, 0);
}

TEST(JobRunner, AJobIsNotBlamedForStopsOfTheService) {
  const std::shared_ptr<JobStore> store = open_job_store("").value();
  const std::string id = store->append({new_job_id(), "plan", "{}"}, now_ms(), {10})->id;
  Endless endless;
  for (int k = 1; k <= 2 * JobRunnerOptions{}.most_deaths; ++k) {
    JobRunner runner(store, std::ref(endless));
    ASSERT_TRUE(runner.start());
    while (endless.begun < k) std::this_thread::sleep_for(milliseconds(1));
    runner.stop();
    ASSERT_EQ(store->get(id).value()->state, JobState::kAccepted) << "after stop " << k;
  }
  JobRunner runner(store, echo);
  ASSERT_TRUE(runner.start());
  EXPECT_EQ(runner.wait(id, seconds(5)).value()->state, JobState::kSuccessful);
}

TEST(JobRunner, WorkThatAsksKeepsItsLease) {
  Endless endless;
  JobRunnerOptions options;
  options.workers = {{"plan"}, {"plan"}};
  options.lease = milliseconds(300);
  options.idle_poll = milliseconds(50);
  JobRunner runner(open_job_store("").value(), std::ref(endless), options);
  ASSERT_TRUE(runner.start());
  const std::string id = runner.submit("plan", "{}")->id;
  std::this_thread::sleep_for(milliseconds(1000));
  EXPECT_EQ(endless.begun, 1) << "the other worker must not have taken it";
  EXPECT_EQ(runner.store().get(id).value()->attempt, 1);
}

TEST(JobRunner, WorkThatTakesTooLongOrTooMuchFailsWithTheReason) {
  Endless endless;
  JobRunnerOptions options;
  options.max_time = milliseconds(50);
  const auto problem_of = [](JobRunner& runner) {
    EXPECT_TRUE(runner.start());
    const std::string id = runner.submit("plan", "{}")->id;
    EXPECT_EQ(runner.wait(id, seconds(5)).value()->state, JobState::kFailed);
    return json::read_problem(*runner.store().outcome(id).value());
  };
  JobRunner slow(open_job_store("").value(), std::ref(endless), options);
  EXPECT_EQ(problem_of(slow).code, ErrorCode::kJobTooLarge);
  JobRunner large(open_job_store("").value(),
                  [](const std::string&, const std::string&, Progress&) -> Result<std::string> {
                    throw std::bad_alloc();
                  });
  EXPECT_EQ(problem_of(large).code, ErrorCode::kJobTooLarge);
}

TEST(JobRunner, SilentWorkIsSeen) {
  std::atomic<bool> enough{false};
  JobRunner runner(open_job_store("").value(), [&](const std::string&, const std::string&, Progress&) {
    while (!enough) std::this_thread::sleep_for(milliseconds(5));
    return Result<std::string>("answer");
  });
  ASSERT_TRUE(runner.start());
  EXPECT_EQ(runner.longest_silence(), milliseconds(0));
  const std::string id = runner.submit("plan", "{}")->id;
  wait_until([&] { return runner.longest_silence() > milliseconds(200); });
  enough = true;
  EXPECT_EQ(runner.wait(id, seconds(5)).value()->state, JobState::kSuccessful);
}

// Work in parts, of which `part` is told the number. The answer is that of the last part.
WorkInParts in_parts(int count, std::function<Result<JobAnswer>(int, Progress&)> part) {
  return {.split = [count](const std::string&, const std::string&) -> Result<std::vector<std::string>> {
            std::vector<std::string> requests;
            for (int k = 0; k < count; ++k) requests.push_back(std::to_string(k));
            return requests;
          },
          .part = [part = std::move(part)](const std::string&, const std::string& request,
                                           Progress& progress) { return part(std::stoi(request), progress); },
          .put_together = [count](const std::string&, const std::string&, const PartAnswer& answer,
                                  Progress&) { return answer(count - 1); }};
}

TEST(JobRunner, ShortPartsAreTakenTogetherAndWhatIsNotBegunIsGivenBack) {
  constexpr int kParts = 200, kSlow = 150;
  const std::shared_ptr<JobStore> store = open_job_store("").value();
  JobRunnerOptions options;
  options.batch_time = milliseconds(200);
  std::atomic<int> most_held{0};
  std::atomic<bool> others_free{false};
  const auto running = [&store](const std::string& id) {
    const std::vector<Job> parts = store->parts(id).value();
    return static_cast<int>(std::count_if(parts.begin(), parts.end(),
                                          [](const Job& p) { return p.state == JobState::kRunning; }));
  };
  std::string id;
  std::mutex mutex;
  const auto work = [&](int part, Progress& progress) -> Result<JobAnswer> {
    const std::scoped_lock lock(mutex);
    most_held = std::max(most_held.load(), running(id));
    const auto until = std::chrono::steady_clock::now() + seconds(10);
    while (part == kSlow && !others_free && std::chrono::steady_clock::now() < until) {
      EXPECT_FALSE(progress.cancelled());
      others_free = running(id) == 1;
      std::this_thread::sleep_for(milliseconds(20));
    }
    return JobAnswer(std::to_string(part));
  };
  options.renewal = milliseconds(50);
  JobRunner runner(store, nullptr, options, in_parts(kParts, work));
  {
    const std::scoped_lock lock(mutex);
    ASSERT_TRUE(runner.start());
    id = runner.submit("plan", "{}")->id;
  }
  EXPECT_EQ(runner.wait(id, seconds(20)).value()->state, JobState::kSuccessful);
  EXPECT_EQ(store->outcome(id).value(), "199");
  EXPECT_GT(most_held, 4);
  EXPECT_LE(most_held, kParts / 16);
  EXPECT_TRUE(others_free) << "nobody waits for what is behind a long part";
}

TEST(JobRunner, APartThatKillsItsWorkerFailsWithItsReasonAndNoOtherDoes) {
  constexpr int kParts = 64, kPoison = 17;
  const std::shared_ptr<JobStore> store = open_job_store("").value();
  std::string id;
  // The work stops there for ever, as the process does; the next one finds what it held.
  for (int life = 1; life <= 20; ++life) {
    std::atomic<bool> dead{false};
    JobRunnerOptions options;
    options.worker = "worker " + std::to_string(life);
    JobRunner runner(store, nullptr, options, in_parts(kParts, [&](int part, Progress&) -> Result<JobAnswer> {
                       if (part == kPoison) {
                         store->release(options.worker, HandBack::kDied, "signal 11").value();
                         dead = true;
                       }
                       return JobAnswer(std::to_string(part));
                     }));
    ASSERT_TRUE(runner.start());
    if (id.empty()) id = runner.submit("plan", "{}")->id;
    wait_until([&] { return dead || has_ended(store->get(id).value()->state); });
    runner.stop();
    if (has_ended(store->get(id).value()->state)) break;
  }
  const Job job = store->get(id).value().value();
  EXPECT_EQ(job.state, JobState::kFailed);
  EXPECT_EQ(job.parts.failed, 1);
  const std::vector<Job> parts = store->parts(id).value();
  for (const Job& part : parts) {
    EXPECT_EQ(part.state, part.part == kPoison ? JobState::kFailed : JobState::kSuccessful) << part.part;
    EXPECT_LE(part.deaths, part.part == kPoison ? JobRunnerOptions{}.most_deaths : 1) << part.part;
  }
  EXPECT_EQ(parts[kPoison].deaths, JobRunnerOptions{}.most_deaths);
  const Error problem = json::read_problem(store->outcome(id).value().value());
  ASSERT_EQ(problem.faults.size(), 1U);
  EXPECT_EQ(problem.faults.front().pointer, "/parts/17");
  EXPECT_NE(problem.detail.find("1 of 64 parts of the work are missing"), std::string::npos);
  EXPECT_NE(problem.faults.front().message.find("died 5 times"), std::string::npos);
  EXPECT_NE(problem.faults.front().message.find("signal 11"), std::string::npos);
}

// Two runners on one store, as a service and its worker process are.
struct ServiceAndWorker {
  explicit ServiceAndWorker(JobWork work)
      : store(open_job_store("").value()),
        service(store, nullptr, not_here()),
        worker(store, std::move(work), named()) {}

  static JobRunnerOptions not_here() {
    JobRunnerOptions options;
    options.works_here = false;
    return options;
  }
  static JobRunnerOptions named() {
    JobRunnerOptions options;
    options.worker = "slipway/1";
    return options;
  }

  std::shared_ptr<JobStore> store;
  JobRunner service, worker;
};

TEST(JobRunner, OfAnotherProcessIsWokenByItsBell) {
  ServiceAndWorker both(echo);
  both.service.on_change([&] { both.worker.ring(); });
  both.worker.on_change([&] { both.service.ring(); });
  ASSERT_TRUE(both.service.start() && both.worker.start());
  const auto begun = std::chrono::steady_clock::now();
  for (int i = 0; i < 5; ++i) {
    const std::string id = both.service.submit("plan", "{}")->id;
    EXPECT_EQ(both.service.wait(id, seconds(5)).value()->state, JobState::kSuccessful);
  }
  EXPECT_LT(std::chrono::steady_clock::now() - begun, seconds(4)) << "five polls of a second each";
  both.worker.stop();
}

TEST(JobRunner, OfAnotherProcessNeedsNoBell) {
  Endless endless;
  ServiceAndWorker both(std::ref(endless));
  ASSERT_TRUE(both.service.start() && both.worker.start());
  const std::string id = both.service.submit("plan", "{}")->id;
  wait_until([&] { return endless.begun == 1; });
  ASSERT_TRUE(both.service.dismiss(id));
  wait_until([&] { return endless.ended == 1; });
  EXPECT_EQ(both.service.wait(id, seconds(5)).value()->state, JobState::kDismissed);
  both.worker.stop();
}

TEST(JobRunner, AServiceWithWorkersBlamesNoJobForItsOwnDeath) {
  const std::shared_ptr<JobStore> store = open_job_store("").value();
  const std::string id = store->append({new_job_id(), "plan", "{}"}, now_ms(), {10})->id;
  for (int k = 0; k < 2 * JobRunnerOptions{}.most_deaths; ++k) {
    ASSERT_TRUE(store->claim("slipway/" + std::to_string(k), {}, now_ms(), now_ms() + 60'000).value());
    JobRunner service(store, nullptr, ServiceAndWorker::not_here());
    ASSERT_TRUE(service.start());
    EXPECT_EQ(store->get(id).value()->state, JobState::kAccepted);
  }
  EXPECT_EQ(store->get(id).value()->deaths, 0);
}

}  // namespace
}  // namespace slipway::api
