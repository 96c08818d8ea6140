#include "api/jobs/job_store.h"

#include <gtest/gtest.h>

#include <chrono>
#include <mutex>
#include <set>
#include <thread>

#include "job_store_fixture.h"

namespace slipway::api {
namespace {

using testing::kBoth;
using testing::kJobStores;
using testing::kMany;

class JobStores : public testing::JobStoreTest {};

TEST_P(JobStores, WhatARunningJobHasFoundIsToldUntilItIsClaimedAnew) {
  const std::string id = accept();
  const Lease lease = claim().lease();
  EXPECT_TRUE(store_->report(lease, "s", 0.5, now_ + 1, "{\"cost\":1}").value());
  EXPECT_EQ(get(id).best_so_far, "{\"cost\":1}");
  EXPECT_TRUE(store_->report(lease, "s", 0.6, now_ + 1, "").value());
  EXPECT_EQ(get(id).best_so_far, "{\"cost\":1}") << "until it finds another";
  now_ += 10;
  const Lease anew = claim().lease();
  EXPECT_FALSE(store_->report(lease, "s", 0.7, now_ + 1, "{\"cost\":2}").value());
  EXPECT_EQ(get(id).best_so_far, "") << "of the attempt before";
  EXPECT_TRUE(store_->report(anew, "s", 0.1, now_ + 1, "{\"cost\":3}").value());
  EXPECT_EQ(get(id).best_so_far, "{\"cost\":3}");
}

TEST_P(JobStores, WhoTakesEveryKindIsWaitedForBehindAll) {
  accept("prediction");
  const std::string id = accept("plan");
  EXPECT_EQ(store_->place_in_queue(id, {}).value()->ahead, 1);
  EXPECT_EQ(store_->place_in_queue(id, {"plan"}).value()->ahead, 0);
}

TEST_P(JobStores, AnIdThatIsTakenIsRefused) {
  const std::string id = accept();
  const auto again = store_->append({id, "plan", "{}"}, now_, {kMany});
  ASSERT_FALSE(again);
  EXPECT_EQ(again.error().code, ErrorCode::kStorage);
  EXPECT_EQ(store_->list(kMany).value().size(), 1U);
}

TEST_P(JobStores, WhoHoldsNoLeaseDividesNothing) {
  const std::string id = accept();
  Lease lease = claim().lease();
  ++lease.attempt;
  EXPECT_FALSE(store_->split(lease, {"a", "b"}, now_).value());
  EXPECT_EQ(store_->give_back({lease}).value(), 0);
  EXPECT_TRUE(store_->parts(id).value().empty());
}

INSTANTIATE_TEST_SUITE_P(Each, JobStores, ::testing::ValuesIn(kJobStores),
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

TEST_P(JobStores, AClockThatIsSetFarAheadMakesNoJobTooOldHoweverOften) {
  constexpr std::int64_t kDay = std::int64_t{24} * 3600 * 1000;
  for (const std::int64_t most_age : {90 * kDay, 7 * kDay}) {
    const Retention kept{.most_age_ms = most_age};
    std::vector<std::string> ids;
    for (int start = 0; start < 3; ++start) {
      ids.push_back(accept());
      ASSERT_TRUE(store_->finish(claim().lease(), JobState::kSuccessful, {"answer"}, now_).value());
      now_ += 400 * kDay;
      EXPECT_EQ(store_->forget_ended(kept, now_).value(), 0) << start;
    }
    for (const std::string& id : ids) EXPECT_TRUE(store_->get(id).value().has_value());
    now_ -= 400 * kDay;  // it is set right again
    EXPECT_EQ(store_->forget_ended(kept, now_).value(), 0);
    for (int day = 0; day < 100; ++day) {
      now_ += kDay;
      accept();
      ASSERT_TRUE(store_->finish(claim().lease(), JobState::kSuccessful, {"answer"}, now_).value());
    }
    EXPECT_EQ(store_->forget_ended(kept, now_).value(), static_cast<int>(3 + 100 - most_age / kDay));
    for (const std::string& id : ids) EXPECT_EQ(store_->get(id).value(), std::nullopt);
    ASSERT_GT(store_->forget_ended({.most = 0}, now_).value(), 0);
  }
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
