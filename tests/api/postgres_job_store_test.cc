// What only the store on a database server does. The promises that all stores keep are in job_store_test.cc.
#include "api/jobs/postgres_job_store.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <future>
#include <optional>
#include <thread>
#include <utility>

#include "api/jobs/postgres_connection.h"
#include "postgres_schema.h"

namespace slipway::api {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using std::chrono::steady_clock;
using testing::PostgresSchema;

class PostgresJobStoreTest : public ::testing::Test {
 protected:
  void SetUp() override {
    schema_ = PostgresSchema::make();
    if (!schema_) GTEST_SKIP() << testing::kNoPostgres;
    store_ = open();
  }
  void TearDown() override { store_.reset(); }

  std::unique_ptr<JobStore> open(milliseconds deadline = seconds(5)) const {
    auto opened = open_postgres_job_store(schema_->address(), {.deadline = deadline});
    EXPECT_TRUE(opened) << opened.error().detail;
    return std::move(*opened);
  }
  static NewJob new_job(std::optional<std::string> key = {}) {
    return {.id = new_job_id(), .kind = "plan", .request = "{}", .owner = "a", .key = std::move(key)};
  }
  ClaimedJob claim(const std::string& worker = "w") const {
    return store_->claim(worker, {}, 1000, 2000).value().value();
  }
  static bool comes_true(const std::function<bool()>& condition) {
    const auto until = steady_clock::now() + seconds(10);
    while (!condition() && steady_clock::now() < until) std::this_thread::sleep_for(milliseconds(5));
    return condition();
  }

  std::unique_ptr<PostgresSchema> schema_;
  std::unique_ptr<JobStore> store_;
};

TEST_F(PostgresJobStoreTest, ARowOfAnUnknownStateHidesItselfAlone) {
  const auto bad = store_->append(new_job(), 1, {}), good = store_->append(new_job(), 2, {});
  ASSERT_TRUE(bad && good);
  schema_->run("ALTER TABLE slipway_jobs DROP CONSTRAINT slipway_jobs_state_check");
  schema_->run("UPDATE slipway_jobs SET state = 'lost' WHERE id = '" + bad->id + "'");
  const auto listed = store_->list(10);
  ASSERT_TRUE(listed) << listed.error().detail;
  ASSERT_EQ(listed->size(), 1U);
  EXPECT_EQ(listed->front().id, good->id);
  EXPECT_EQ(store_->counts().value().size(), 1U);
  const auto one = store_->get(bad->id);
  ASSERT_FALSE(one);
  EXPECT_EQ(one.error().code, ErrorCode::kDamagedStore);
  EXPECT_NE(one.error().detail.find(bad->id), std::string::npos);
}

TEST_F(PostgresJobStoreTest, SeveralProcessesMayOpenItAtOnce) {
  schema_->run("DROP TABLE slipway_jobs, slipway_series, slipway_schema");
  std::vector<std::future<bool>> opened;
  for (int k = 0; k < 4; ++k)
    opened.push_back(std::async(std::launch::async,
                                [&] { return open_postgres_job_store(schema_->address()).has_value(); }));
  for (auto& each : opened) EXPECT_TRUE(each.get());
}

TEST_F(PostgresJobStoreTest, TablesOfANewerProgramAreRefusedWithWhatToDo) {
  schema_->run("UPDATE slipway_schema SET version = 77");
  const auto refused = open_postgres_job_store(schema_->address());
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().detail.find("newer program (version 77"), std::string::npos)
      << refused.error().detail;
  EXPECT_NE(refused.error().detail.find("--jobs"), std::string::npos);
}

TEST_F(PostgresJobStoreTest, TablesThatDoNotSayTheirVersionAreRefused) {
  schema_->run("DELETE FROM slipway_schema");
  const auto refused = open_postgres_job_store(schema_->address());
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().detail.find("--jobs"), std::string::npos) << refused.error().detail;
}

TEST_F(PostgresJobStoreTest, WhatTheServerSaysOfItsDiskIsToldAsThat) {
  schema_->run(
      "CREATE FUNCTION refuse() RETURNS trigger LANGUAGE plpgsql AS "
      "$$ BEGIN RAISE EXCEPTION 'refused' USING ERRCODE = NEW.kind; END $$");
  schema_->run("CREATE TRIGGER refuses BEFORE INSERT ON slipway_jobs FOR EACH ROW EXECUTE FUNCTION refuse()");
  for (const auto& [sqlstate, code] :
       {std::pair{"53100", ErrorCode::kStorageFull}, std::pair{"XX001", ErrorCode::kDamagedStore},
        std::pair{"XX002", ErrorCode::kDamagedStore}, std::pair{"22000", ErrorCode::kStorage}}) {
    const auto refused = store_->append({new_job_id(), sqlstate, "{}"}, 1, {});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, code) << sqlstate;
  }
}

TEST_F(PostgresJobStoreTest, NamesOfKindsMayHaveAnyCharacter) {
  const std::string kind = R"(a "kind", {of} \its\ own)";
  ASSERT_TRUE(store_->append({new_job_id(), kind, "{}"}, 1, {}));
  EXPECT_FALSE(store_->claim("w", {"plan"}, 1000, 2000).value());
  EXPECT_EQ(store_->claim("w", {"plan", kind}, 1000, 2000).value()->job.kind, kind);
}

TEST_F(PostgresJobStoreTest, AColumnThatIsNoBigintIsNotReadAsOne) {
  PostgresConnection connection(PostgresAddress(schema_->address()), CommitKind::kQuick);
  EXPECT_EQ(connection.run("SELECT 7::bigint").number(0, 0), 7);
  EXPECT_THROW(connection.run("SELECT 7::int").number(0, 0), PostgresFailure);
}

TEST_F(PostgresJobStoreTest, AlteredBytesAreNeverServed) {
  const NewJob job = new_job();
  ASSERT_TRUE(store_->append(job, 1, {}));
  ASSERT_TRUE(store_->finish(claim().lease(), JobState::kSuccessful, {"answer", {"page"}}, 3).value());
  schema_->run("UPDATE slipway_jobs SET outcome = 'another', request = '{ }'");
  schema_->run("UPDATE slipway_series SET bytes = 'other'");
  EXPECT_EQ(store_->outcome(job.id).error().code, ErrorCode::kDamagedStore);
  EXPECT_EQ(store_->request(job.id).error().code, ErrorCode::kDamagedStore);
  EXPECT_EQ(store_->series(job.id, 1).error().code, ErrorCode::kDamagedStore);
}

TEST_F(PostgresJobStoreTest, AnEndedJobIsToldAsItEndedOrNotAtAll) {
  const NewJob ended = new_job(), dismissed = new_job();
  ASSERT_TRUE(store_->append(ended, 1, {}));
  ASSERT_TRUE(store_->finish(claim().lease(), JobState::kSuccessful, {"answer"}, 3).value());
  ASSERT_TRUE(store_->append(dismissed, 4, {}));
  ASSERT_TRUE(store_->dismiss(dismissed.id, 5));
  for (const char* const altered : {"kind = 'check'", "owner = 'eve'", "state = 'failed'",
                                    "state = 'accepted'", "ended_ms = 9", "created_ms = 0", "attempt = 7"}) {
    schema_->run(
        "CREATE TABLE before AS SELECT id, kind, owner, state, ended_ms, created_ms, attempt FROM "
        "slipway_jobs");
    for (const std::string& id : {ended.id, dismissed.id}) EXPECT_TRUE(store_->get(id)) << altered;
    schema_->run("UPDATE slipway_jobs SET " + std::string(altered));
    for (const std::string& id : {ended.id, dismissed.id})
      EXPECT_EQ(store_->get(id).error().code, ErrorCode::kDamagedStore) << altered;
    EXPECT_FALSE(store_->claim_some("a", {}, 6, {6, 7}, 1).value().size()) << "no work again";
    schema_->run(
        "UPDATE slipway_jobs AS job SET kind = b.kind, owner = b.owner, state = b.state, ended_ms = "
        "b.ended_ms, created_ms = b.created_ms, attempt = b.attempt FROM before AS b WHERE b.id = job.id");
    schema_->run("DROP TABLE before");
  }
  schema_->run("ALTER TABLE slipway_jobs DROP COLUMN end_sha256");
  const auto again = open_postgres_job_store(schema_->address());
  ASSERT_TRUE(again) << again.error().detail;
  EXPECT_EQ((*again)->get(ended.id).value()->state, JobState::kSuccessful) << "of an older program";
}

// A crash of the server may take back a claim, which is not waited for.
TEST_F(PostgresJobStoreTest, AnAttemptThatIsGivenAgainIsOfAnotherWorker) {
  ASSERT_TRUE(store_->append(new_job(), 1, {}));
  const Lease lost = claim("worker 1").lease();
  schema_->run("UPDATE slipway_jobs SET state = 'accepted', attempt = 0, worker = NULL");
  const Lease held = claim("worker 2").lease();
  ASSERT_EQ(held.attempt, lost.attempt);
  EXPECT_FALSE(store_->report(lost, "s", 0.5, 3000).value());
  EXPECT_FALSE(store_->finish(lost, JobState::kSuccessful, std::string("late"), 5).value());
  EXPECT_TRUE(store_->finish(held, JobState::kSuccessful, std::string("answer"), 5).value());
}

TEST_F(PostgresJobStoreTest, ACompletionIsKnownWhenItIsRepeated) {
  const std::string id = store_->append(new_job(), 1, {})->id;
  const Lease lease = claim().lease();
  for (int k = 0; k < 2; ++k)
    EXPECT_TRUE(store_->finish(lease, JobState::kSuccessful, std::string("answer"), 5).value());
  EXPECT_FALSE(store_->finish(lease, JobState::kSuccessful, std::string("another"), 5).value());
  EXPECT_EQ(store_->outcome(id).value(), "answer");
}

TEST_F(PostgresJobStoreTest, LostConnectionsAreMadeAgain) {
  for (int k = 0; k < 3; ++k) {
    ASSERT_TRUE(store_->append(new_job(), 1, {}));
    schema_->run(
        "SELECT pg_terminate_backend(pid) FROM pg_stat_activity "
        "WHERE pid <> pg_backend_pid() AND application_name = current_setting('application_name')");
  }
  EXPECT_EQ(store_->list(10).value().size(), 3U);
}

// Like a commit whose standby is lost, a lock is held for as long as its holder likes.
TEST_F(PostgresJobStoreTest, WhatTheServerHoldsUpIsRefusedInTimeAndOneJobWhenAskedAgain) {
  const auto impatient = open(milliseconds(500));
  PostgresConnection other(PostgresAddress(schema_->address()), CommitKind::kQuick);
  other.run("BEGIN");
  other.run("LOCK TABLE slipway_jobs IN EXCLUSIVE MODE");
  const NewJob job = new_job("key");
  const auto begun = steady_clock::now();
  const auto refused = impatient->append(job, 1, {});
  EXPECT_LT(steady_clock::now() - begun, seconds(3));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kStorage);
  other.run("COMMIT");
  NewJob again = job;
  again.id = new_job_id();
  ASSERT_TRUE(impatient->append(again, 2, {}));
  ASSERT_TRUE(impatient->append(job, 3, {}));
  EXPECT_EQ(store_->list(10).value().size(), 1U);
}

TEST_F(PostgresJobStoreTest, ADivisionHasMoreTimeThanWhatClientsWaitFor) {
  const auto impatient = open(milliseconds(500));
  ASSERT_TRUE(store_->append(new_job(), 1, {}));
  const Lease lease = claim().lease();
  PostgresConnection other(PostgresAddress(schema_->address()), CommitKind::kQuick);
  other.run("BEGIN");
  other.run("LOCK TABLE slipway_jobs IN EXCLUSIVE MODE");
  auto division = std::async(std::launch::async, [&] { return impatient->split(lease, {"a", "b"}, 2); });
  std::this_thread::sleep_for(milliseconds(1000));
  other.run("COMMIT");
  const auto divided = division.get();
  ASSERT_TRUE(divided) << divided.error().detail;
  EXPECT_TRUE(*divided);
}

TEST_F(PostgresJobStoreTest, OtherProcessesHearOfWorkAndOfEnds) {
  const auto service = open();
  std::atomic<int> accepted{0}, ended{0};
  store_->listen(StoreNews::kAccepted, [&] { ++accepted; });
  service->listen(StoreNews::kEnded, [&] { ++ended; });
  ASSERT_TRUE(comes_true([&] { return accepted == 1 && ended == 1; })) << "each looks as it begins";
  ASSERT_TRUE(service->append(new_job(), 1, {}));
  EXPECT_TRUE(comes_true([&] { return accepted == 2; }));
  ASSERT_TRUE(store_->finish(claim().lease(), JobState::kSuccessful, std::string("answer"), 5).value());
  EXPECT_TRUE(comes_true([&] { return ended == 2; }));
  store_->listen(StoreNews::kAccepted, {});
  service->listen(StoreNews::kEnded, {});
}

TEST(PostgresAddress, IsShownWithoutItsPassword) {
  const auto shown = [](const char* uri) { return PostgresAddress(uri).shown(); };
  EXPECT_EQ(shown("postgresql://me:s%40cret@a,b:5433/db?connect_timeout=3"),
            "postgresql://me@a,b:5433/db?connect_timeout=3");
  EXPECT_EQ(shown("postgresql://me@a/db?password=secret&sslmode=require"),
            "postgresql://me@a/db?sslmode=require");
  EXPECT_EQ(shown("postgresql://me@a/db?sslmode=require&password=secret"),
            "postgresql://me@a/db?sslmode=require");
  EXPECT_EQ(shown("postgresql:///db?service=team"), "postgresql:///db?service=team");
  EXPECT_EQ(PostgresAddress("postgresql://me:s%40cret@a/db").password(), "s@cret");
}

TEST(PostgresAddress, AKeysPasswordBelongsIntoAServiceFile) {
  EXPECT_THROW(PostgresAddress("postgresql://me@a/db?sslpassword=secret"), PostgresFailure);
}

TEST(PostgresAddress, AFaultyOneIsRefusedWithoutRepeatingIt) {
  for (const char* const uri : {"postgresql://me:secret@a:port/db", "postgresql://me:secret@[a/db",
                                "postgresql://me@a/db?secret", "postgresql://me:secret@127.0.0.1:1/db"}) {
    const auto refused = open_postgres_job_store(uri, {.deadline = milliseconds(100)});
    ASSERT_FALSE(refused) << uri;
    EXPECT_EQ(refused.error().code, ErrorCode::kStorage);
    EXPECT_EQ(refused.error().detail.find("secret"), std::string::npos) << refused.error().detail;
  }
}

}  // namespace
}  // namespace slipway::api
