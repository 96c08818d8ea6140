#include "api/jobs/job_store.h"

#include <gtest/gtest.h>

#include <chrono>
#include <mutex>
#include <set>
#include <thread>

#include "api/jobs/memory_job_store.h"
#include "api/jobs/postgres_job_store.h"
#include "api/jobs/sqlite_job_store.h"
#include "postgres_schema.h"
#include "small_world.h"

namespace slipway::api {
namespace {

using testing::ScratchFolder;

const std::vector<std::string> kBoth{"plan", "prediction"};
constexpr std::size_t kMany = 1000;

// A job divided into three parts, and their claims in their order.
struct Divided {
  std::string id;
  std::vector<ClaimedJob> parts;
};

// All implementations keep the same promises.
class JobStores : public ::testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    if (GetParam() == "memory") {
      store_ = make_memory_job_store();
    } else if (GetParam() == "postgresql") {
      schema_ = testing::PostgresSchema::make();
      if (!schema_) GTEST_SKIP() << testing::kNoPostgres;
      auto opened = open_postgres_job_store(schema_->address());
      ASSERT_TRUE(opened) << opened.error().detail;
      store_ = std::move(*opened);
    } else {
      auto opened = open_sqlite_job_store(folder_.path() / "jobs.sqlite");
      ASSERT_TRUE(opened) << opened.error().detail;
      store_ = std::move(*opened);
    }
  }

  std::string accept(const std::string& kind = "plan", const std::string& request = "{}") {
    const auto job = store_->append({new_job_id(), kind, request}, ++now_, {kMany});
    EXPECT_TRUE(job);
    return job->id;
  }
  ClaimedJob claim(std::int64_t lease = 1000) {
    auto claimed = store_->claim("a", kBoth, now_, now_ + lease);
    EXPECT_TRUE(claimed && *claimed);
    return **claimed;
  }
  Divided divide() {
    Divided job{accept("plan", "whole"), {}};
    EXPECT_TRUE(store_->split(claim().lease(), {"part 0", "part 1", "part 2"}, now_).value());
    for (int k = 0; k < 3; ++k) job.parts.push_back(claim(1'000'000));
    return job;
  }
  // The id of a job that was divided into so many parts.
  std::string split_into(int parts) {
    const std::string id = accept("plan", "whole");
    for (;;) {
      const ClaimedJob claimed = claim();
      if (claimed.job.id != id) continue;
      EXPECT_TRUE(store_
                      ->split(claimed.lease(),
                              std::vector<std::string>(static_cast<std::size_t>(parts), "part"), now_)
                      .value());
      return id;
    }
  }
  std::vector<ClaimedJob> claim_some(const std::string& worker, int most) {
    return store_->claim_some(worker, {}, now_, {now_, now_ + 1000}, most).value();
  }
  static JobAnswer answer_of_part(int part) {
    JobAnswer answer("answer " + std::to_string(part));
    answer.cpu_s = 0.5 + part;
    return answer;
  }
  Job get(const std::string& id) { return store_->get(id).value().value(); }

  void TearDown() override { store_.reset(); }

  ScratchFolder folder_;
  std::unique_ptr<testing::PostgresSchema> schema_;
  std::unique_ptr<JobStore> store_;
  std::int64_t now_ = 1'700'000'000'000;
};

INSTANTIATE_TEST_SUITE_P(Each, JobStores, ::testing::Values("memory", "sqlite", "postgresql"),
                         [](const auto& instance) { return instance.param; });

// Before, an hour that somebody set the clock forward gave a running job to a second worker.
TEST_P(JobStores, ALeaseHoldsWhateverTheTimeOfDayIsSetTo) {
  constexpr std::chrono::hours kHour(1);
  const std::string id = accept();
  const LeaseTerm term = store_->lease_term(std::chrono::minutes(1)).value();
  EXPECT_EQ(term.until - term.now, 60'000);
  const auto held = store_->claim_some("a", kBoth, now_, term, 1).value();
  ASSERT_EQ(held.size(), 1U);
  for (const std::int64_t day :
       {now_ + std::chrono::milliseconds(kHour).count(), now_ - std::chrono::milliseconds(kHour).count()}) {
    const LeaseTerm later = store_->lease_term(std::chrono::minutes(1)).value();
    EXPECT_GE(later.now, term.now);
    EXPECT_TRUE(store_->claim_some("b", kBoth, day, later, 1).value().empty()) << day;
  }
  EXPECT_TRUE(store_->report(held.front().lease(), "", 0.5, term.now - 1).value());
  const auto again = store_->claim_some("b", kBoth, now_, term, 1).value();
  ASSERT_EQ(again.size(), 1U) << "its lease has ended by the store's clock";
  EXPECT_EQ(again.front().job.id, id);
  EXPECT_EQ(again.front().job.started_ms, now_);
}

TEST_P(JobStores, AJobGoesFromAcceptedOverRunningToSuccessful) {
  const std::string request("{\"a\": \"\xc3\xa9\"}\0more", 16);
  const std::string id = accept("plan", request);
  EXPECT_EQ(get(id).state, JobState::kAccepted);
  EXPECT_EQ(get(id).created_ms, now_);
  const ClaimedJob claimed = claim();
  EXPECT_EQ(claimed.request, request);
  EXPECT_EQ(claimed.job.state, JobState::kRunning);
  EXPECT_EQ(claimed.job.attempt, 1);
  EXPECT_TRUE(store_->report(claimed.lease(), "proposing routes", 0.25, now_ + 1).value());
  EXPECT_EQ(get(id).stage, "proposing routes");
  EXPECT_EQ(get(id).progress, 0.25);
  EXPECT_EQ(store_->outcome(id).value(), std::nullopt);
  EXPECT_TRUE(
      store_->finish(claimed.lease(), JobState::kSuccessful, std::string("answer"), now_ + 5).value());
  EXPECT_EQ(get(id).state, JobState::kSuccessful);
  EXPECT_EQ(get(id).progress, 1.0);
  EXPECT_EQ(get(id).ended_ms, now_ + 5);
  EXPECT_EQ(store_->outcome(id).value(), "answer");
}

TEST_P(JobStores, TheVersionGrowsWithEveryChangeAndOnlyThen) {
  const std::string id = accept();
  std::int64_t last = get(id).version;
  EXPECT_EQ(get(id).version, last) << "looking changes nothing";
  const Lease lease = claim().lease();
  EXPECT_GT(get(id).version, last);
  last = get(id).version;
  ASSERT_TRUE(store_->report(lease, "s", 0.5, now_ + 1).value());
  EXPECT_GT(get(id).version, last);
  last = get(id).version;
  ASSERT_TRUE(store_->report(lease, "s", 0.5, now_ + 2).value());
  EXPECT_EQ(get(id).version, last) << "a lease renewed is nothing to poll for";
  ASSERT_TRUE(store_->finish(lease, JobState::kFailed, std::string("p"), now_).value());
  EXPECT_GT(get(id).version, last);
}

TEST_P(JobStores, ClaimsTakeTheOldestOfTheirKindsOnce) {
  const std::string plan = accept("plan");
  const std::string prediction = accept("prediction");
  const auto first = store_->claim("a", {"prediction"}, now_, now_ + 10);
  EXPECT_EQ(first.value()->job.id, prediction);
  EXPECT_EQ(store_->claim("b", {"prediction"}, now_, now_ + 10).value(), std::nullopt);
  EXPECT_EQ(store_->claim("b", kBoth, now_, now_ + 10).value()->job.id, plan);
  EXPECT_EQ(store_->claim("b", {}, now_, now_ + 10).value(), std::nullopt);
  const std::string any = accept("another_kind");
  EXPECT_EQ(store_->claim("b", kBoth, now_, now_ + 10).value(), std::nullopt);
  EXPECT_EQ(store_->claim("b", {}, now_, now_ + 10).value()->job.id, any) << "where no kind is named, any";
}

TEST_P(JobStores, AnExpiredLeaseIsClaimedAgainAndTheOldOneIsFencedOff) {
  const std::string id = accept();
  const Lease old = claim(10).lease();
  now_ += 11;
  const Lease taken = claim(1000).lease();
  EXPECT_EQ(taken.attempt, 2);
  EXPECT_FALSE(store_->report(old, "late", 0.9, now_).value());
  EXPECT_FALSE(store_->finish(old, JobState::kSuccessful, std::string("late"), now_).value());
  EXPECT_EQ(get(id).state, JobState::kRunning);
  EXPECT_TRUE(store_->finish(taken, JobState::kSuccessful, std::string("good"), now_).value());
  EXPECT_EQ(store_->outcome(id).value(), "good");
}

TEST_P(JobStores, ReleaseGivesBackWhatAWorkerHeld) {
  const std::string id = accept();
  const Lease lease = claim().lease();
  EXPECT_EQ(store_->release("b", HandBack::kStopped).value(), 0);
  EXPECT_EQ(store_->release("a", HandBack::kStopped).value(), 1);
  EXPECT_EQ(get(id).state, JobState::kAccepted);
  EXPECT_FALSE(store_->finish(lease, JobState::kSuccessful, std::string("late"), now_).value());
  EXPECT_EQ(claim().job.attempt, 2);
  EXPECT_EQ(get(id).deaths, 0) << "an orderly stop is none";
  EXPECT_EQ(store_->release("a", HandBack::kDied).value(), 1);
  EXPECT_EQ(claim(10).job.deaths, 1);
  now_ += 11;
  EXPECT_EQ(claim().job.deaths, 2) << "nor does who lets a lease end live";
}

TEST_P(JobStores, ADismissedJobStaysDismissedAndShowsNothing) {
  const std::string waiting = accept();
  const std::string working = accept();
  EXPECT_EQ(store_->dismiss(waiting, now_).value()->state, JobState::kDismissed);
  const Lease lease = claim().lease();
  EXPECT_EQ(lease.id, working) << "what is dismissed is not claimed";
  EXPECT_EQ(store_->dismiss(working, now_).value()->state, JobState::kDismissed);
  EXPECT_FALSE(store_->report(lease, "s", 0.5, now_).value());
  EXPECT_FALSE(store_->finish(lease, JobState::kSuccessful, std::string("late"), now_).value());
  EXPECT_EQ(get(working).state, JobState::kDismissed);
  EXPECT_EQ(store_->outcome(working).value(), std::nullopt);
  EXPECT_EQ(store_->dismiss(working, now_ + 9).value()->ended_ms, now_) << "again changes nothing";
}

TEST_P(JobStores, AJobsRequestIsKeptAsLongAsTheJob) {
  const NewJob job{new_job_id(), "plan", R"({"drives":[1]})"};
  ASSERT_TRUE(store_->append(job, now_, {10}));
  EXPECT_EQ(store_->request(job.id).value(), job.request) << "accepted";
  ASSERT_TRUE(store_->finish(claim().lease(), JobState::kSuccessful, std::string("answer"), now_).value());
  EXPECT_EQ(store_->request(job.id).value(), job.request) << "ended";
  EXPECT_EQ(store_->request(new_job_id()).value(), std::nullopt);
  EXPECT_EQ(store_->forget_ended({.most = 0}, now_).value(), 1);
  EXPECT_EQ(store_->request(job.id).value(), std::nullopt);
}

TEST_P(JobStores, WhatHasEndedIsNotDismissed) {
  const std::string id = accept();
  ASSERT_TRUE(store_->finish(claim().lease(), JobState::kSuccessful, std::string("answer"), now_).value());
  EXPECT_EQ(store_->dismiss(id, now_).value()->state, JobState::kSuccessful);
  EXPECT_EQ(store_->outcome(id).value(), "answer");
  EXPECT_EQ(store_->dismiss(new_job_id(), now_).value(), std::nullopt);
}

TEST_P(JobStores, RefusesJobsBeyondTheBoundAndAcceptsAgainAfterwards) {
  const std::string first = accept();
  accept();
  const auto refused = store_->append({new_job_id(), "plan", "{}"}, now_, {2});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kTooManyJobs);
  ASSERT_TRUE(store_->dismiss(first, now_));
  EXPECT_TRUE(store_->append({new_job_id(), "plan", "{}"}, now_, {2}));
}

TEST_P(JobStores, AnOwnersJobsAreBoundedWithoutShuttingOthersOut) {
  const Admission one_each{.most_unfinished = 10, .most_of_owner = 1};
  ASSERT_TRUE(
      store_->append({.id = new_job_id(), .kind = "plan", .request = "{}", .owner = "a"}, now_, one_each));
  const auto refused =
      store_->append({.id = new_job_id(), .kind = "plan", .request = "{}", .owner = "a"}, now_, one_each);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kOverQuota);
  EXPECT_TRUE(
      store_->append({.id = new_job_id(), .kind = "plan", .request = "{}", .owner = "b"}, now_, one_each));
}

TEST_P(JobStores, AKeyNamesOneRequestOfItsOwner) {
  const Admission bounds{.most_unfinished = 3};
  const auto ask = [&](const char* owner, const char* request) {
    return store_->append(
        {.id = new_job_id(), .kind = "plan", .request = request, .owner = owner, .key = "k"}, now_, bounds);
  };
  const auto first = ask("a", "{}");
  ASSERT_TRUE(first);
  ASSERT_TRUE(store_->finish(claim().lease(), JobState::kSuccessful, std::string("answer"), now_).value());
  const auto again = ask("a", "{}");
  ASSERT_TRUE(again);
  EXPECT_EQ(again->id, first->id);
  EXPECT_EQ(again->state, JobState::kSuccessful) << "as it is now";
  const auto other = ask("a", "{} ");
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().code, ErrorCode::kInvalidRequest);
  EXPECT_EQ(other.error().faults.front().pointer, "/Idempotency-Key");
  EXPECT_NE(ask("b", "{}")->id, first->id);
  EXPECT_EQ(store_->list(10).value().size(), 2u);
}

TEST_P(JobStores, TheMostUrgentIsClaimedFirst) {
  const auto ask = [&](int urgency) {
    return store_->append({.id = new_job_id(), .kind = "plan", .request = "{}", .urgency = urgency}, now_, {})
        ->id;
  };
  const std::string usual = ask(3), last = ask(7), first = ask(0), also_usual = ask(3);
  for (const std::string& id : {first, usual, also_usual, last}) EXPECT_EQ(claim().job.id, id);
}

TEST_P(JobStores, APlaceInTheQueueCountsWhatBeginsBefore) {
  const std::string ended = accept();
  ASSERT_TRUE(
      store_->finish(claim().lease(), JobState::kSuccessful, std::string("answer"), now_ + 4000).value());
  accept();
  claim();
  accept("prediction");
  accept();
  const std::string mine = accept();
  store_->append({.id = new_job_id(), .kind = "plan", .request = "{}", .urgency = 0}, ++now_, {}).value();
  accept();
  const auto among_plans = store_->place_in_queue(mine, {"plan"}).value();
  ASSERT_TRUE(among_plans);
  EXPECT_EQ(among_plans->ahead, 2) << "an older one and an urgent one";
  ASSERT_TRUE(among_plans->work_ahead_s);
  EXPECT_NEAR(*among_plans->work_ahead_s, 4.0 * (0.5 + 2.0), 1e-9);
  const auto among_all = store_->place_in_queue(mine, kBoth).value();
  EXPECT_EQ(among_all->ahead, 3);
  EXPECT_FALSE(among_all->work_ahead_s) << "no prediction has ended yet";
  EXPECT_EQ(store_->place_in_queue(ended, kBoth).value(), std::nullopt);
}

TEST_P(JobStores, ADeathIsKeptWithItsReasonAndHolderOfTheFamilysName) {
  const std::string id = accept();
  ASSERT_TRUE(store_->claim("family/1", kBoth, now_, now_ + 1000).value());
  EXPECT_EQ(store_->release("fam", HandBack::kDied, "no").value(), 0);
  EXPECT_EQ(store_->release("family/1", HandBack::kDied, "signal 9").value(), 1);
  EXPECT_EQ(get(id).deaths, 1);
  EXPECT_EQ(get(id).last_death, "signal 9");
  ASSERT_TRUE(store_->claim("family/2", kBoth, now_, now_ + 1000).value());
  EXPECT_EQ(store_->release("family", HandBack::kStopped).value(), 1);
  EXPECT_EQ(get(id).deaths, 1);
  EXPECT_EQ(get(id).last_death, "signal 9");
}

TEST_P(JobStores, ListsNewestFirstAndForgetsTheOldestEnded) {
  std::vector<std::string> ids;
  ids.reserve(4);
  for (int i = 0; i < 4; ++i) ids.push_back(accept());
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(store_->dismiss(ids[i], now_));
  ASSERT_EQ(store_->list(2).value().size(), 2U);
  EXPECT_EQ(store_->list(2).value()[0].id, ids[3]);
  EXPECT_EQ(store_->forget_ended({.most = 1}, now_).value(), 2);
  EXPECT_EQ(store_->get(ids[0]).value(), std::nullopt);
  EXPECT_EQ(store_->get(ids[1]).value(), std::nullopt);
  EXPECT_TRUE(store_->get(ids[2]).value().has_value());
  EXPECT_EQ(get(ids[3]).state, JobState::kAccepted) << "what has not ended is never forgotten";
  EXPECT_EQ(store_->forget_ended({.most = 1}, now_).value(), 0);
}

TEST_P(JobStores, ForgetsWhatIsTooOldOrTooLarge) {
  std::vector<std::string> ids;
  for (int i = 0; i < 4; ++i) {
    ids.push_back(accept());
    now_ += 1000;
    ASSERT_TRUE(store_->finish(claim().lease(), JobState::kSuccessful, std::string(100, 'x'), now_).value());
  }
  EXPECT_EQ(store_->forget_ended({}, now_).value(), 0);
  EXPECT_EQ(store_->forget_ended({.most_age_ms = 2500}, now_).value(), 1)
      << "the oldest ended 3 s before the newest";
  EXPECT_EQ(store_->get(ids[0]).value(), std::nullopt);
  EXPECT_EQ(store_->forget_ended({.most_bytes = 250}, now_).value(), 1) << "102 bytes each";
  EXPECT_EQ(store_->get(ids[1]).value(), std::nullopt);
  EXPECT_TRUE(store_->get(ids[2]).value().has_value());
}

TEST_P(JobStores, BytesBehindAZeroCountToo) {
  accept();
  const std::string file = std::string(1, '\0') + std::string(5000, 'x');
  ASSERT_TRUE(store_->finish(claim().lease(), JobState::kSuccessful, {"answer", {file}}, now_).value());
  EXPECT_EQ(store_->forget_ended({.most_bytes = 5100}, now_).value(), 0);
  EXPECT_EQ(store_->forget_ended({.most_bytes = 4900}, now_).value(), 1);
}

TEST_P(JobStores, ASeriesIsReadPageByPageAndGoesWithItsJob) {
  const std::string id = accept();
  const std::vector<std::string> pages{"a,b\n1,2\n", "3,4\n"};
  ASSERT_TRUE(store_->finish(claim().lease(), JobState::kSuccessful, {"answer", pages}, now_).value());
  EXPECT_EQ(store_->outcome(id).value(), "answer");
  EXPECT_EQ(store_->series(id, 1).value()->bytes, pages[0]);
  EXPECT_TRUE(store_->series(id, 1).value()->more);
  EXPECT_EQ(store_->series(id, 2).value()->bytes, pages[1]);
  EXPECT_FALSE(store_->series(id, 2).value()->more);
  for (const std::int64_t page : {-1, 0, 3}) EXPECT_FALSE(store_->series(id, page).value());
  EXPECT_EQ(store_->forget_ended({.most_bytes = 15}, now_).value(), 1) << "its pages count";
  EXPECT_FALSE(store_->series(id, 1).value());
}

TEST_P(JobStores, NoSeriesOfALostLeaseIsKept) {
  const std::string id = accept();
  const Lease old = claim(10).lease();
  now_ += 11;
  claim();
  EXPECT_FALSE(store_->finish(old, JobState::kSuccessful, {"late", {"page"}}, now_).value());
  EXPECT_FALSE(store_->series(id, 1).value());
}

TEST_P(JobStores, AJobInPartsIsAcceptedAgainWithTheEndOfTheLast) {
  const Divided job = divide();
  EXPECT_EQ(get(job.id).state, JobState::kRunning);
  EXPECT_EQ(get(job.id).parts.count, 3);
  for (int k : {2, 0, 1}) {
    const ClaimedJob& part = job.parts[static_cast<std::size_t>(k)];
    EXPECT_EQ(part.job.whole, job.id);
    EXPECT_EQ(part.job.part, k);
    EXPECT_EQ(part.request, "part " + std::to_string(k));
    EXPECT_EQ(store_->claim("b", {}, now_ + 500'000, now_ + 500'001).value(), std::nullopt)
        << "who waits for parts can't be late";
    const std::int64_t version = get(job.id).version;
    ASSERT_TRUE(store_->finish(part.lease(), JobState::kSuccessful, answer_of_part(k), now_).value());
    EXPECT_GT(get(job.id).version, version);
  }
  EXPECT_EQ(get(job.id).state, JobState::kAccepted);
  EXPECT_EQ(get(job.id).parts.ended, 3);
  EXPECT_DOUBLE_EQ(get(job.id).parts.cpu_s, 0.5 + 1.5 + 2.5);
  const ClaimedJob whole = claim();
  EXPECT_EQ(whole.job.id, job.id);
  EXPECT_EQ(whole.request, "whole");
  EXPECT_EQ(whole.job.deaths, 0);
  const std::vector<Job> parts = store_->parts(job.id).value();
  ASSERT_EQ(parts.size(), 3U);
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(parts[static_cast<std::size_t>(k)].part, k);
    EXPECT_EQ(store_->outcome(parts[static_cast<std::size_t>(k)].id).value(), answer_of_part(k).bytes);
  }
  ASSERT_TRUE(store_->finish(whole.lease(), JobState::kSuccessful, std::string("all"), now_).value());
  EXPECT_EQ(store_->outcome(job.id).value(), "all");
}

TEST_P(JobStores, AJobInPartsIsNobodysAndPartsAreNobodyElsesBusiness) {
  const Divided job = divide();
  EXPECT_EQ(store_->list(10).value().size(), 1U) << "parts are not listed";
  EXPECT_TRUE(store_->append({new_job_id(), "plan", "{}"}, now_, {2})) << "nor do they fill the queue";
  EXPECT_EQ(store_->release("a", HandBack::kDied, "no").value(), 3) << "the parts that a holds";
  EXPECT_EQ(get(job.id).deaths, 0);
  EXPECT_EQ(store_->parts(new_job_id()).value().size(), 0U);
  EXPECT_EQ(store_->parts("").value().size(), 0U);
}

TEST_P(JobStores, TheLeaseOfADividedJobIsGone) {
  accept("plan", "whole");
  const Lease lease = claim().lease();
  ASSERT_TRUE(store_->split(lease, {"part 0", "part 1"}, now_).value());
  EXPECT_FALSE(store_->report(lease, "late", 0.5, now_ + 10).value());
  EXPECT_FALSE(store_->finish(lease, JobState::kSuccessful, std::string("late"), now_).value());
  ASSERT_TRUE(store_->dismiss(lease.id, now_));
  EXPECT_FALSE(store_->finish(lease, JobState::kSuccessful, std::string("late"), now_).value());
  accept();
  const Lease old = claim(10).lease();
  now_ += 11;
  claim();
  EXPECT_FALSE(store_->split(old, {"part 0", "part 1"}, now_).value());
  EXPECT_EQ(store_->parts(old.id).value().size(), 0U);
}

TEST_P(JobStores, ADismissalStopsTheParts) {
  const Divided job = divide();
  ASSERT_TRUE(store_->finish(job.parts[0].lease(), JobState::kSuccessful, answer_of_part(0), now_).value());
  EXPECT_EQ(store_->dismiss(job.id, now_).value()->state, JobState::kDismissed);
  EXPECT_FALSE(store_->report(job.parts[1].lease(), "s", 0.5, now_ + 10).value());
  EXPECT_FALSE(store_->finish(job.parts[2].lease(), JobState::kSuccessful, answer_of_part(2), now_).value());
  EXPECT_EQ(get(job.parts[0].job.id).state, JobState::kSuccessful);
  EXPECT_EQ(get(job.parts[1].job.id).state, JobState::kDismissed);
  EXPECT_EQ(store_->claim("b", {}, now_ + 500'000, now_ + 500'001).value(), std::nullopt);
}

TEST_P(JobStores, AFailedAndADismissedPartAreCounted) {
  const Divided job = divide();
  ASSERT_TRUE(store_->finish(job.parts[0].lease(), JobState::kFailed, std::string("{}"), now_).value());
  ASSERT_TRUE(store_->dismiss(job.parts[1].job.id, now_));
  ASSERT_TRUE(store_->dismiss(job.parts[1].job.id, now_));
  EXPECT_EQ(get(job.id).state, JobState::kRunning);
  ASSERT_TRUE(store_->finish(job.parts[2].lease(), JobState::kSuccessful, answer_of_part(2), now_).value());
  EXPECT_EQ(get(job.id).state, JobState::kAccepted);
  EXPECT_EQ(get(job.id).parts.failed, 2);
}

TEST_P(JobStores, PartsGoWithTheirJobAndCountForItsBytes) {
  const Divided job = divide();
  for (int k = 0; k < 3; ++k) {
    const JobAnswer large(std::string(1000, 'x'), {std::string(1000, 'y')});
    ASSERT_TRUE(
        store_->finish(job.parts[static_cast<std::size_t>(k)].lease(), JobState::kSuccessful, large, now_)
            .value());
  }
  EXPECT_EQ(store_->forget_ended({.most = 0}, now_).value(), 0) << "their job has not ended";
  ASSERT_TRUE(store_->finish(claim().lease(), JobState::kSuccessful, std::string("all"), now_).value());
  EXPECT_EQ(store_->forget_ended({.most = 1, .most_bytes = 6100}, now_).value(), 0);
  EXPECT_EQ(store_->forget_ended({.most_bytes = 5900}, now_).value(), 1);
  EXPECT_EQ(store_->parts(job.id).value().size(), 0U);
  EXPECT_EQ(store_->get(job.parts[0].job.id).value(), std::nullopt);
  EXPECT_FALSE(store_->series(job.parts[0].job.id, 1).value());
}

TEST_P(JobStores, OfPartsThatEndTogetherOneIsTheLast) {
  constexpr int kParts = 24;
  const std::string id = accept("plan", "whole");
  ASSERT_TRUE(store_->split(claim().lease(), std::vector<std::string>(kParts, "part"), now_).value());
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([this, t] {
      for (;;) {
        const auto part = store_->claim(std::to_string(t), {}, now_, now_ + 100'000).value();
        if (!part || part->job.whole.empty()) return;
        EXPECT_TRUE(
            store_->finish(part->lease(), JobState::kSuccessful, std::string("answer"), now_).value());
      }
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(get(id).parts.ended, kParts);
  EXPECT_EQ(get(id).attempt, 2) << "one of the threads has found the whole again";
}

TEST_P(JobStores, PartsOfOneJobAreClaimedTogetherAndOthersAlone) {
  const std::string id = split_into(64);
  const std::string other = accept(), another = accept();
  const std::vector<ClaimedJob> first = claim_some("a", 10), second = claim_some("b", 3);
  ASSERT_EQ(first.size(), 4U) << "a sixteenth of what is left";
  for (int k = 0; k < 4; ++k) {
    EXPECT_EQ(first[static_cast<std::size_t>(k)].job.part, k);
    EXPECT_EQ(first[static_cast<std::size_t>(k)].job.attempt, 1);
    EXPECT_EQ(first[static_cast<std::size_t>(k)].job.whole, id);
    EXPECT_EQ(first[static_cast<std::size_t>(k)].request, "part");
  }
  ASSERT_EQ(second.size(), 3U) << "as many as were asked for";
  EXPECT_EQ(second.front().job.part, 4);
  ASSERT_TRUE(store_->dismiss(id, now_));
  const std::vector<ClaimedJob> alone = claim_some("a", 10);
  ASSERT_EQ(alone.size(), 1U);
  EXPECT_EQ(alone.front().job.id, other);
  EXPECT_EQ(claim_some("a", 10).front().job.id, another);
  EXPECT_TRUE(claim_some("a", 10).empty());
}

TEST_P(JobStores, NoPartIsClaimedTogetherWithOnesOfAnotherJobOrUrgency) {
  const std::string id = split_into(32);
  const std::string urgent =
      store_->append({.id = new_job_id(), .kind = "plan", .request = "{}", .urgency = 0}, now_, {})->id;
  EXPECT_EQ(claim_some("a", 10).front().job.id, urgent);
  const std::vector<ClaimedJob> two = claim_some("a", 10);
  ASSERT_EQ(two.size(), 2U);
  for (const ClaimedJob& part : two) EXPECT_EQ(part.job.whole, id);
  const std::string other = split_into(32);  // claims all parts before it on its way
  EXPECT_EQ(claim_some("a", 10).front().job.whole, other);
}

TEST_P(JobStores, EndsAreKeptTogetherAndEachHearsWhetherItsLeaseHeld) {
  const std::string id = split_into(64);
  const std::vector<ClaimedJob> parts = claim_some("a", 4);
  ASSERT_EQ(parts.size(), 4U);
  ASSERT_TRUE(store_->dismiss(parts[2].job.id, now_));
  std::vector<JobEnd> ends;
  for (int k = 0; k < 4; ++k)
    ends.push_back({parts[static_cast<std::size_t>(k)].lease(),
                    k == 1 ? JobState::kFailed : JobState::kSuccessful, answer_of_part(k)});
  ends[3].outcome.series = {"page"};
  const std::vector<bool> kept = store_->finish_all(ends, now_).value();
  EXPECT_EQ(kept, (std::vector<bool>{true, true, false, true}));
  EXPECT_EQ(get(id).parts.ended, 4);
  EXPECT_EQ(get(id).parts.failed, 2);
  EXPECT_DOUBLE_EQ(get(id).parts.cpu_s, 0.5 + 1.5 + 3.5);
  EXPECT_EQ(store_->outcome(parts[0].job.id).value(), answer_of_part(0).bytes);
  EXPECT_EQ(get(parts[1].job.id).state, JobState::kFailed);
  EXPECT_EQ(store_->series(parts[3].job.id, 1).value()->bytes, "page");
}

TEST_P(JobStores, WhatIsGivenBackCountsNoDeathAndALostLeaseIsPassedOver) {
  split_into(64);
  const std::vector<ClaimedJob> parts = claim_some("a", 4);
  ASSERT_EQ(parts.size(), 4U);
  ASSERT_TRUE(store_->finish(parts[1].lease(), JobState::kSuccessful, std::string("answer"), now_).value());
  EXPECT_EQ(store_->give_back({parts[1].lease(), parts[2].lease(), parts[3].lease()}).value(), 2);
  EXPECT_EQ(get(parts[1].job.id).state, JobState::kSuccessful);
  EXPECT_EQ(get(parts[0].job.id).state, JobState::kRunning);
  EXPECT_FALSE(store_->finish(parts[2].lease(), JobState::kSuccessful, std::string("late"), now_).value());
  const std::vector<ClaimedJob> again = claim_some("b", 4);
  ASSERT_EQ(again.size(), 3U) << "a sixteenth of 63 parts";
  EXPECT_EQ(again[0].job.part, 2);
  EXPECT_EQ(again[0].job.attempt, 2);
  EXPECT_EQ(again[0].job.deaths, 0);
}

TEST_P(JobStores, APartWithADeathBehindItIsClaimedAlone) {
  split_into(64);
  ASSERT_EQ(claim_some("a", 4).size(), 4U);
  ASSERT_EQ(store_->release("a", HandBack::kDied, "signal 9").value(), 4);
  for (int k = 0; k < 4; ++k) {
    const std::vector<ClaimedJob> alone = claim_some("a", 4);
    ASSERT_EQ(alone.size(), 1U) << "one of them may be what killed the worker";
    EXPECT_EQ(alone.front().job.part, k);
    EXPECT_EQ(alone.front().job.deaths, 1);
  }
  EXPECT_EQ(claim_some("a", 4).size(), 4U) << "of those that nobody died of";
  now_ += 2000;
  EXPECT_EQ(claim_some("b", 4).size(), 1U) << "a lease that has ended is a death too";
}

TEST_P(JobStores, ThreadsThatClaimInBatchesDoEveryPartOnce) {
  constexpr int kParts = 400;
  const std::string id = split_into(kParts);
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([this, t] {
      for (;;) {
        const auto parts = store_->claim_some(std::to_string(t), {}, now_, {now_, now_ + 100'000}, 8).value();
        if (parts.empty() || parts.front().job.whole.empty()) return;
        std::vector<JobEnd> ends;
        for (const ClaimedJob& part : parts)
          ends.push_back({part.lease(), JobState::kSuccessful, std::string("answer")});
        const std::vector<bool> kept = store_->finish_all(ends, now_).value();
        EXPECT_EQ(kept, std::vector<bool>(ends.size(), true));
      }
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(get(id).parts.ended, kParts);
  const std::vector<Job> parts = store_->parts(id).value();
  for (const Job& part : parts) EXPECT_EQ(part.attempt, 1) << part.part;
}

TEST_P(JobStores, ManyThreadsClaimEveryJobExactlyOnce) {
  constexpr int kThreads = 4;
  constexpr int kEach = 25;
  std::vector<std::thread> threads;
  threads.reserve(kThreads);
  for (int t = 0; t < kThreads; ++t) {
    threads.emplace_back([this] {
      for (int i = 0; i < kEach; ++i) EXPECT_TRUE(store_->append({new_job_id(), "plan", "{}"}, 1, {kMany}));
    });
  }
  for (std::thread& thread : threads) thread.join();
  threads.clear();
  std::mutex mutex;
  std::multiset<std::string> claimed;
  for (int t = 0; t < kThreads; ++t) {
    threads.emplace_back([&, t] {
      while (const auto job = store_->claim(std::to_string(t), kBoth, 2, 100).value()) {
        const std::scoped_lock lock(mutex);
        claimed.insert(job->job.id);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(claimed.size(), static_cast<std::size_t>(kThreads * kEach));
  EXPECT_EQ(std::set<std::string>(claimed.begin(), claimed.end()).size(), claimed.size());
}

}  // namespace
}  // namespace slipway::api
