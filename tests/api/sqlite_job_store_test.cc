// What the SQLite store promises besides what every store does.
#include "api/jobs/sqlite_job_store.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <iostream>
#include <set>
#include <thread>

#include "api/jobs/sqlite_connection.h"
#include "small_world.h"

namespace slipway::api {
namespace {

using testing::ScratchFolder;

const std::vector<std::string> kBoth{"plan", "prediction"};
constexpr std::size_t kMany = 1000;

// The child accepts jobs and acknowledges each through the pipe until it is killed in the middle of it.
TEST(SqliteJobStore, AKilledProcessLosesNoAcknowledgedJob) {
  const ScratchFolder folder;
  const auto path = folder.path() / "jobs.sqlite";
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    ::close(ends[0]);
    const auto store = open_sqlite_job_store(path);
    if (!store) ::_exit(1);
    for (;;) {
      const std::string id = new_job_id();
      if (!(*store)->append({id, "plan", "{}"}, 1, {1'000'000})) ::_exit(1);
      if (::write(ends[1], id.data(), id.size()) != static_cast<ssize_t>(id.size())) ::_exit(1);
    }
  }
  ::close(ends[1]);
  std::vector<std::string> acknowledged;
  std::string id(32, ' ');
  constexpr std::size_t kEnough = 40;
  while (::read(ends[0], id.data(), id.size()) == 32) {
    acknowledged.push_back(id);
    if (acknowledged.size() == kEnough) ::kill(child, SIGKILL);
  }
  ::close(ends[0]);
  int status = 0;
  ::waitpid(child, &status, 0);
  ASSERT_TRUE(WIFSIGNALED(status)) << "the child must have been killed, not have failed";
  ASSERT_GE(acknowledged.size(), kEnough);
  const auto store = open_sqlite_job_store(path);
  ASSERT_TRUE(store) << store.error().detail;
  for (const std::string& known : acknowledged)
    EXPECT_TRUE((*store)->get(known).value().has_value()) << known;
}

TEST(SqliteJobStore, LeasesHoldThroughAReopeningButNotThroughAStartOfTheMachine) {
  const ScratchFolder folder;
  const auto path = folder.path() / "jobs.sqlite";
  const auto claimed_anew = [&] {
    const auto store = open_sqlite_job_store(path).value();
    const LeaseTerm term = store->lease_term(std::chrono::hours(1)).value();
    return store->claim_some("b", kBoth, 3, term, 1).value();
  };
  ASSERT_TRUE(open_sqlite_job_store(path).value()->append({new_job_id(), "plan", "{}"}, 1, {10}));
  ASSERT_EQ(claimed_anew().size(), 1U);
  EXPECT_TRUE(claimed_anew().empty()) << "the lease still runs";
  SqliteConnection(path, CommitKind::kDurable).execute("UPDATE lease_clock SET boot = 'an earlier one'");
  const auto again = claimed_anew();
  ASSERT_EQ(again.size(), 1U);
  EXPECT_EQ(again.front().job.attempt, 2);
  EXPECT_EQ(again.front().job.deaths, 1);
  EXPECT_TRUE(claimed_anew().empty());
}

TEST(SqliteJobStore, KeepsEverythingThroughAReopening) {
  const ScratchFolder folder;
  const auto path = folder.path() / "jobs.sqlite";
  const std::string id = new_job_id();
  {
    const auto store = open_sqlite_job_store(path);
    ASSERT_TRUE(store);
    ASSERT_TRUE((*store)->append({id, "plan", "request"}, 1, {10}));
    const auto claimed = (*store)->claim("a", kBoth, 2, 3);
    ASSERT_TRUE(
        (*store)->finish(claimed.value()->lease(), JobState::kFailed, std::string("problem"), 4).value());
  }
  const auto store = open_sqlite_job_store(path);
  ASSERT_TRUE(store);
  const Job job = (*store)->get(id).value().value();
  EXPECT_EQ(job.state, JobState::kFailed);
  EXPECT_EQ(job.started_ms, 2);
  EXPECT_EQ(job.ended_ms, 4);
  EXPECT_EQ((*store)->outcome(id).value(), "problem");
}

TEST(SqliteJobStore, AFileThatIsNoDatabaseIsAnErrorAndNotOverwritten) {
  const ScratchFolder folder;
  const auto path = folder.path() / "notes.txt";
  const std::string notes(5000, 'n');
  testing::write_file(path, notes);
  const auto store = open_sqlite_job_store(path);
  ASSERT_FALSE(store);
  EXPECT_EQ(store.error().code, ErrorCode::kDamagedStore);
  EXPECT_EQ(testing::file_bytes(path), notes);
  EXPECT_FALSE(open_sqlite_job_store(folder.path() / "no" / "such" / "folder" / "jobs.sqlite"));
}

// A figure for the record; the bound is far below what any disk gives.
TEST(SqliteJobStore, ThreadsThatAcceptTogetherShareCommits) {
  const ScratchFolder folder;
  const auto store = open_sqlite_job_store(folder.path() / "jobs.sqlite");
  ASSERT_TRUE(store);
  for (const int threads : {1, 8}) {
    const int each = threads == 1 ? 100 : 50;
    const auto begin = std::chrono::steady_clock::now();
    std::vector<std::thread> all;
    all.reserve(static_cast<std::size_t>(threads));
    for (int t = 0; t < threads; ++t) {
      all.emplace_back([&] {
        for (int i = 0; i < each; ++i)
          EXPECT_TRUE((*store)->append({new_job_id(), "plan", "{}"}, 1, {1'000'000}));
      });
    }
    for (std::thread& thread : all) thread.join();
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    const double rate = threads * each / took.count();
    std::cout << "accepted jobs per second, " << threads << " threads: " << rate << '\n';
    EXPECT_GT(rate, 5.0);
  }
  EXPECT_EQ((*store)->list(kMany).value().size(), 500U);
}

TEST(JobId, HoldsAHundredAndTwentyEightBits) {
  std::set<std::string> ids;
  for (int i = 0; i < 1000; ++i) {
    const std::string id = new_job_id();
    EXPECT_TRUE(is_job_id(id)) << id;
    ids.insert(id);
  }
  EXPECT_EQ(ids.size(), 1000U);
  EXPECT_FALSE(is_job_id("../../../etc/passwd"));
  for (const char c : {'/', ':', '`', 'g', 'A'}) EXPECT_FALSE(is_job_id(std::string(32, c))) << c;
}

}  // namespace
}  // namespace slipway::api
