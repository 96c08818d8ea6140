#include <gtest/gtest.h>

#include <thread>

#include "api/jobs/job_store.h"
#include "job_store_fixture.h"

namespace slipway::api {
namespace {

using testing::kJobStores;

using testing::Divided;

// Jobs divided into parts.
class JobStoreParts : public testing::JobStoreTest {};

INSTANTIATE_TEST_SUITE_P(Each, JobStoreParts, ::testing::ValuesIn(kJobStores),
                         [](const auto& instance) { return instance.param; });

TEST_P(JobStoreParts, AJobInPartsIsAcceptedAgainWithTheEndOfTheLast) {
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

TEST_P(JobStoreParts, AJobInPartsIsNobodysAndPartsAreNobodyElsesBusiness) {
  const Divided job = divide();
  EXPECT_EQ(store_->list(10).value().size(), 1U) << "parts are not listed";
  EXPECT_TRUE(store_->append({new_job_id(), "plan", "{}"}, now_, {2})) << "nor do they fill the queue";
  EXPECT_EQ(store_->release("a", HandBack::kDied, "no").value(), 3) << "the parts that a holds";
  EXPECT_EQ(get(job.id).deaths, 0);
  EXPECT_EQ(store_->parts(new_job_id()).value().size(), 0U);
  EXPECT_EQ(store_->parts("").value().size(), 0U);
}

TEST_P(JobStoreParts, TheLeaseOfADividedJobIsGone) {
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

TEST_P(JobStoreParts, ADismissalStopsTheParts) {
  const Divided job = divide();
  ASSERT_TRUE(store_->finish(job.parts[0].lease(), JobState::kSuccessful, answer_of_part(0), now_).value());
  EXPECT_EQ(store_->dismiss(job.id, now_).value()->state, JobState::kDismissed);
  EXPECT_FALSE(store_->report(job.parts[1].lease(), "s", 0.5, now_ + 10).value());
  EXPECT_FALSE(store_->finish(job.parts[2].lease(), JobState::kSuccessful, answer_of_part(2), now_).value());
  EXPECT_EQ(get(job.parts[0].job.id).state, JobState::kSuccessful);
  EXPECT_EQ(get(job.parts[1].job.id).state, JobState::kDismissed);
  EXPECT_EQ(store_->claim("b", {}, now_ + 500'000, now_ + 500'001).value(), std::nullopt);
}

TEST_P(JobStoreParts, AFailedAndADismissedPartAreCounted) {
  const Divided job = divide();
  ASSERT_TRUE(store_->finish(job.parts[0].lease(), JobState::kFailed, std::string("{}"), now_).value());
  ASSERT_TRUE(store_->dismiss(job.parts[1].job.id, now_));
  ASSERT_TRUE(store_->dismiss(job.parts[1].job.id, now_));
  EXPECT_EQ(get(job.id).state, JobState::kRunning);
  ASSERT_TRUE(store_->finish(job.parts[2].lease(), JobState::kSuccessful, answer_of_part(2), now_).value());
  EXPECT_EQ(get(job.id).state, JobState::kAccepted);
  EXPECT_EQ(get(job.id).parts.failed, 2);
}

TEST_P(JobStoreParts, PartsGoWithTheirJobAndCountForItsBytes) {
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

TEST_P(JobStoreParts, OfPartsThatEndTogetherOneIsTheLast) {
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

TEST_P(JobStoreParts, PartsOfOneJobAreClaimedTogetherAndOthersAlone) {
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

TEST_P(JobStoreParts, NoPartIsClaimedTogetherWithOnesOfAnotherJobOrUrgency) {
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

TEST_P(JobStoreParts, EndsAreKeptTogetherAndEachHearsWhetherItsLeaseHeld) {
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

TEST_P(JobStoreParts, WhatIsGivenBackCountsNoDeathAndALostLeaseIsPassedOver) {
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

TEST_P(JobStoreParts, APartWithADeathBehindItIsClaimedAlone) {
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

TEST_P(JobStoreParts, ThreadsThatClaimInBatchesDoEveryPartOnce) {
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

}  // namespace
}  // namespace slipway::api
