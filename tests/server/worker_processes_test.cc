#include "server/worker_processes.h"

#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <thread>

namespace slipway::server {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

// What a worker and its supervisor do to each other, with a shell as the worker.
class Shells {
 public:
  explicit Shells(const std::string& script)
      : workers_(
            {.commands = {{"/bin/sh", "-c", script, "{name}"}},
             .first_pause = milliseconds(10),
             .longest_pause = milliseconds(20),
             .patience = milliseconds(300)},
            [this] { ++bells_; },
            [this](const std::string& name, const std::string& reason) {
              const std::scoped_lock lock(mutex_);
              deaths_.emplace_back(name, reason);
            }) {}

  WorkerProcesses& workers() { return workers_; }
  int bells() const { return bells_; }
  std::vector<std::pair<std::string, std::string>> deaths() {
    const std::scoped_lock lock(mutex_);
    return deaths_;
  }

 private:
  std::mutex mutex_;
  std::vector<std::pair<std::string, std::string>> deaths_;
  std::atomic<int> bells_{0};
  WorkerProcesses workers_;
};

template <class Condition>
bool comes_true(const Condition& condition) {
  const auto until = std::chrono::steady_clock::now() + seconds(20);
  while (!condition() && std::chrono::steady_clock::now() < until)
    std::this_thread::sleep_for(milliseconds(5));
  return condition();
}

TEST(WorkerProcesses, WhatDiesIsTakenDownWithItsReasonAndBegunAgainUnderANewName) {
  Shells shells("kill -SEGV $$");
  ASSERT_TRUE(shells.workers().start());
  ASSERT_TRUE(comes_true([&] { return shells.deaths().size() >= 3; }));
  shells.workers().stop();
  const auto deaths = shells.deaths();
  EXPECT_EQ(deaths[0].second, "the worker was ended by signal 11 (Segmentation fault)");
  EXPECT_TRUE(deaths[0].first.starts_with("slipway/"));
  EXPECT_NE(deaths[0].first, deaths[1].first);
}

TEST(WorkerProcesses, AnExitStatusIsToldToo) {
  Shells shells("exit 7");
  ASSERT_TRUE(shells.workers().start());
  ASSERT_TRUE(comes_true([&] { return !shells.deaths().empty(); }));
  EXPECT_EQ(shells.deaths().front().second, "the worker ended by itself with status 7");
}

TEST(WorkerProcesses, BellsGoBothWays) {
  Shells shells("while read line; do echo; done");
  ASSERT_TRUE(shells.workers().start());
  shells.workers().ring();
  EXPECT_TRUE(comes_true([&] { return shells.bells() >= 1; }));
  const int before = shells.bells();
  shells.workers().ring();
  EXPECT_TRUE(comes_true([&] { return shells.bells() > before; }));
  shells.workers().stop();
  EXPECT_TRUE(shells.deaths().empty()) << "who is asked to end has not died";
}

TEST(WorkerProcesses, WhatDiesAtItsStartIsMissingAllTheTime) {
  Shells dying("exit 7"), starting("echo; read line");
  EXPECT_TRUE(dying.workers().shortage());
  ASSERT_TRUE(dying.workers().start());
  ASSERT_TRUE(starting.workers().start());
  while (dying.deaths().size() < 20) {
    const auto shortage = dying.workers().shortage();
    ASSERT_TRUE(shortage);
    std::this_thread::sleep_for(milliseconds(1));
  }
  EXPECT_NE(dying.workers().shortage()->find("status 7"), std::string::npos);
  EXPECT_TRUE(comes_true([&] { return !starting.workers().shortage(); }));
}

TEST(WorkerProcesses, WhoDoesNotEndIsKilled) {
  Shells shells("trap '' TERM; echo; while :; do sleep 1; done");
  ASSERT_TRUE(shells.workers().start());
  ASSERT_TRUE(comes_true([&] { return shells.bells() >= 1; }));
  const auto begun = std::chrono::steady_clock::now();
  shells.workers().stop();
  EXPECT_LT(std::chrono::steady_clock::now() - begun, seconds(5));
}

TEST(WorkerProcesses, AProgramThatIsNotThereIsAnError) {
  WorkerProcesses workers(
      {.commands = {{"/no/such/program"}}}, [] {}, [](const auto&, const auto&) {});
  EXPECT_FALSE(workers.start());
}

}  // namespace
}  // namespace slipway::server
