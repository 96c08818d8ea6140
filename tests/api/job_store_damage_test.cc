// A store that was damaged, lost, replaced or left by another program: never a changed answer, and a refusal
// that says what to do.
#include <gtest/gtest.h>

#include <filesystem>

#include "api/jobs/sqlite_connection.h"
#include "api/jobs/sqlite_job_store.h"
#include "core/random.h"
#include "small_world.h"

namespace slipway::api {
namespace {

namespace fs = std::filesystem;
using testing::file_bytes;
using testing::ScratchFolder;
using testing::write_file;

const std::vector<std::string> kPlans{"plan"};

std::string answer_of(int k) {
  std::string answer;
  for (std::uint64_t i = 0; i < 900; ++i)
    answer += static_cast<char>('a' + random_key(static_cast<std::uint64_t>(k), i) % 26);
  return answer;
}

// A store with twelve jobs: eight successful, four waiting. Their ids.
std::vector<std::string> fill(const fs::path& path) {
  const auto store = open_sqlite_job_store(path);
  EXPECT_TRUE(store) << store.error().detail;
  std::vector<std::string> ids;
  for (int k = 0; k < 12; ++k) {
    ids.push_back(new_job_id());
    EXPECT_TRUE((*store)->append({ids.back(), "plan", answer_of(100 + k)}, 1 + k, {100}));
    if (k >= 8) continue;
    const auto claimed = (*store)->claim("a", kPlans, 2, 3);
    EXPECT_TRUE((*store)->finish(claimed.value()->lease(), JobState::kSuccessful, answer_of(k), 4).value());
  }
  return ids;
}

void expect_refusal(const fs::path& path, const std::vector<std::string>& parts) {
  const auto store = open_sqlite_job_store(path);
  ASSERT_FALSE(store);
  for (const std::string& part : parts)
    EXPECT_NE(store.error().detail.find(part), std::string::npos)
        << store.error().detail << " lacks " << part;
}

TEST(JobStoreDamage, AnAlteredAnswerIsAnErrorAndAnAlteredRequestIsNotRun) {
  const ScratchFolder folder;
  const fs::path path = folder.path() / "jobs.sqlite";
  const std::vector<std::string> ids = fill(path);
  {
    SqliteConnection connection(path, CommitKind::kQuick);
    connection.prepare("UPDATE jobs SET outcome = replace(outcome, 'a', 'b') WHERE id = ?")
        .bind(ids[0])
        .step();
    connection.prepare("UPDATE jobs SET outcome = (SELECT outcome FROM jobs WHERE id = ?) WHERE id = ?")
        .bind(ids[2])
        .bind(ids[1])
        .step();
    connection.prepare("UPDATE jobs SET state = 'failed' WHERE id = ?").bind(ids[3]).step();
    connection.prepare("UPDATE jobs SET kind = 'diagnosis' WHERE id = ?").bind(ids[8]).step();
  }
  const auto store = open_sqlite_job_store(path).value();
  for (const int k : {0, 1, 3}) {
    const auto outcome = store->outcome(ids[static_cast<std::size_t>(k)]);
    ASSERT_FALSE(outcome) << k;
    EXPECT_EQ(outcome.error().code, ErrorCode::kDamagedStore);
  }
  EXPECT_EQ(store->outcome(ids[2]).value(), answer_of(2));
  EXPECT_TRUE(store->claim("a", {}, 5, 6).value()->damaged);
  EXPECT_FALSE(store->claim("a", {}, 5, 6).value()->damaged);
}

TEST(JobStoreDamage, AnEndedJobIsToldAsItEndedOrNotAtAll) {
  for (const char* const altered :
       {"kind = 'check'", "owner = 'eve'", "state = 'dismissed'", "state = 'accepted', ended_ms = NULL",
        "ended_ms = ended_ms + 1", "started_ms = 1", "created_ms = 0", "attempt = 7"}) {
    const ScratchFolder folder;
    const fs::path path = folder.path() / "jobs.sqlite";
    const std::vector<std::string> ids = fill(path);
    const auto store = open_sqlite_job_store(path).value();
    ASSERT_TRUE(store->dismiss(ids[8], 5));
    for (const std::string& id : {ids[0], ids[8]}) {
      ASSERT_TRUE(store->get(id)) << altered;
      SqliteConnection(path, CommitKind::kQuick)
          .prepare("UPDATE jobs SET " + std::string(altered) + " WHERE id = ?")
          .bind(id)
          .step();
      if (id == ids[8] && std::string_view(altered).starts_with("state = 'dismissed'")) continue;
      const auto job = store->get(id);
      ASSERT_FALSE(job) << altered;
      EXPECT_EQ(job.error().code, ErrorCode::kDamagedStore);
      EXPECT_EQ(store->dismiss(id, 6).error().code, ErrorCode::kDamagedStore) << altered;
    }
    EXPECT_TRUE(store->get(ids[1])) << "the others are as they were";
  }
}

TEST(JobStoreDamage, JobsThatEndedInAnOlderProgramAreReadAsTheyAre) {
  const ScratchFolder folder;
  const fs::path path = folder.path() / "jobs.sqlite";
  const std::vector<std::string> ids = fill(path);
  SqliteConnection(path, CommitKind::kQuick).execute("DROP TRIGGER ends_go; DROP TABLE ends;");
  const auto store = open_sqlite_job_store(path).value();
  EXPECT_EQ(store->get(ids[0]).value()->state, JobState::kSuccessful);
  EXPECT_EQ(store->list(20).value().size(), ids.size());
}

TEST(JobStoreDamage, AFileThatIsNoLongerThereTakesNoWork) {
  const ScratchFolder folder;
  const fs::path path = folder.path() / "jobs.sqlite";
  const auto store = open_sqlite_job_store(path).value();
  ASSERT_TRUE(store->in_place());
  fs::rename(path, path.string() + ".away");
  const auto refused = store->append({new_job_id(), "plan", "{}"}, 1, {100});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kStorage);
  EXPECT_EQ(store->in_place().error().code, ErrorCode::kStorage);
  fs::copy_file(path.string() + ".away", path);
  EXPECT_FALSE(store->in_place()) << "a copy is another file";
  fs::rename(path.string() + ".away", path);
  EXPECT_TRUE(store->append({new_job_id(), "plan", "{}"}, 1, {100}));
}

TEST(JobStoreDamage, AnAlteredRequestAndAnAlteredPageAreErrors) {
  const ScratchFolder folder;
  const fs::path path = folder.path() / "jobs.sqlite";
  const auto store = open_sqlite_job_store(path).value();
  const std::string id = store->append({new_job_id(), "plan", "{}"}, 1, {100})->id;
  const Lease lease = store->claim("a", kPlans, 2, 3).value()->lease();
  ASSERT_TRUE(store->finish(lease, JobState::kSuccessful, {"answer", {"page"}}, 4).value());
  EXPECT_EQ(store->request(id).value(), "{}");
  EXPECT_EQ(store->series(id, 1).value()->bytes, "page");
  SqliteConnection connection(path, CommitKind::kQuick);
  connection.execute("UPDATE jobs SET request = '{ }'");
  connection.execute("UPDATE series SET bytes = 'other'");
  EXPECT_EQ(store->request(id).error().code, ErrorCode::kDamagedStore);
  EXPECT_EQ(store->series(id, 1).error().code, ErrorCode::kDamagedStore);
}

TEST(JobStoreDamage, ARowOfAnUnknownStateHidesItselfAlone) {
  const ScratchFolder folder;
  const fs::path path = folder.path() / "jobs.sqlite";
  const auto store = open_sqlite_job_store(path).value();
  const std::string bad = store->append({new_job_id(), "plan", "{}"}, 1, {100})->id;
  const std::string good = store->append({new_job_id(), "plan", "{}"}, 2, {100})->id;
  SqliteConnection(path, CommitKind::kQuick)
      .prepare("UPDATE jobs SET state = 'lost' WHERE id = ?")
      .bind(bad)
      .step();
  ASSERT_EQ(store->list(10).value().size(), 1U);
  EXPECT_EQ(store->list(10).value().front().id, good);
  EXPECT_EQ(store->counts().value().size(), 1U);
  EXPECT_EQ(store->get(bad).error().code, ErrorCode::kDamagedStore);
}

TEST(JobStoreDamage, APartWhoseJobIsGoneIsNoWork) {
  const ScratchFolder folder;
  const fs::path path = folder.path() / "jobs.sqlite";
  const auto store = open_sqlite_job_store(path).value();
  ASSERT_TRUE(store->append({new_job_id(), "plan", "{}"}, 1, {100}));
  ASSERT_TRUE(store->split(store->claim("a", kPlans, 2, 3).value()->lease(), {"{}", "{}"}, 2).value());
  SqliteConnection connection(path, CommitKind::kQuick);
  connection.execute("DROP TRIGGER parts_go");
  connection.execute("DELETE FROM jobs WHERE whole IS NULL");
  const auto claimed = store->claim_some("a", kPlans, 3, {3, 4}, 2);
  ASSERT_FALSE(claimed);
  EXPECT_EQ(claimed.error().code, ErrorCode::kDamagedStore);
}

TEST(JobStoreDamage, NoRandomDamageChangesAnAnswer) {
  const ScratchFolder folder;
  const fs::path path = folder.path() / "jobs.sqlite";
  const std::vector<std::string> ids = fill(path);
  const std::string whole = file_bytes(path);
  ASSERT_GT(whole.size(), 20'000u);
  int refused = 0, unread = 0, good = 0;
  for (std::uint64_t trial = 0; trial < 120; ++trial) {
    std::string bytes = whole;
    if (trial % 10 == 9) {
      bytes.resize(random_key(trial, 0) % whole.size());
    } else {
      for (std::uint64_t k = 0; k < 1 + trial % 8; ++k)
        bytes[random_key(trial, 2 * k) % bytes.size()] =
            static_cast<char>(random_key(trial, 2 * k + 1) & 0xff);
    }
    const fs::path copy = folder.path() / ("copy" + std::to_string(trial) + ".sqlite");
    write_file(copy, bytes);
    write_file(copy.string() + ".marker", "here was a store");
    const auto store = open_sqlite_job_store(copy);
    if (!store) {
      ++refused;
      const std::string& why = store.error().detail;
      EXPECT_NE(why.find(copy.string()), std::string::npos) << why;
      bool has_remedy = false;
      for (const char* const remedy : {"move it away", "restore a copy", "put the store back", "name another",
                                       "use that program", "let the service read"})
        has_remedy = has_remedy || why.find(remedy) != std::string::npos;
      EXPECT_TRUE(has_remedy) << why;
      EXPECT_EQ(why.find("ry again"), std::string::npos) << why;
      continue;
    }
    for (int k = 0; k < 8; ++k) {
      const auto outcome = (*store)->outcome(ids[static_cast<std::size_t>(k)]);
      if (!outcome || !*outcome) {
        ++unread;
        continue;
      }
      ++good;
      ASSERT_EQ(**outcome, answer_of(k)) << "trial " << trial;
    }
    for (int k = 0; k < 4; ++k) {
      const auto claimed = (*store)->claim("a", {}, 5, 6);
      if (!claimed || !*claimed || (*claimed)->damaged) continue;
      bool known = false;
      for (int job = 0; job < 12; ++job) known = known || (*claimed)->request == answer_of(100 + job);
      ASSERT_TRUE(known) << "trial " << trial;
    }
  }
  EXPECT_GT(refused, 10);
  EXPECT_GT(unread, 10) << "some damage must have been met when it was read";
  EXPECT_GT(good, 200);
}

TEST(JobStoreDamage, AStoreThatVanishedOrWasEmptiedIsNotTakenForANewOne) {
  const ScratchFolder folder;
  const fs::path path = folder.path() / "jobs.sqlite";
  fill(path);
  write_file(path, "");
  expect_refusal(path, {"is missing or empty", path.string() + ".marker", "put the store back"});
  fs::remove(path);
  expect_refusal(path, {"is missing or empty"});
  fs::remove(path.string() + ".marker");
  EXPECT_TRUE(open_sqlite_job_store(path)) << "as the refusal says";
}

TEST(JobStoreDamage, WhatIsNoStoreOfThisProgramIsRefusedWithWhatToDo) {
  const ScratchFolder folder;
  const fs::path foreign = folder.path() / "foreign.sqlite", newer = folder.path() / "newer.sqlite",
                 altered = folder.path() / "altered.sqlite";
  SqliteConnection(foreign, CommitKind::kQuick).execute("CREATE TABLE notes (text TEXT)");
  expect_refusal(foreign, {foreign.string(), "holds other tables", "name another with --jobs"});
  fill(newer);
  SqliteConnection(newer, CommitKind::kQuick).execute("PRAGMA user_version = 77");
  expect_refusal(newer, {newer.string(), "written by a newer program (version 77"});
  fill(altered);
  SqliteConnection(altered, CommitKind::kQuick).execute("ALTER TABLE jobs DROP COLUMN stage");
  expect_refusal(altered, {altered.string(), "other columns", "move it away"});
}

const std::vector<std::string> kOfVersion4{"cpu_s",       "whole",        "part",       "parts",
                                           "parts_ended", "parts_failed", "parts_cpu_s"};
const std::vector<std::string> kOfVersion3{"last_death", "owner", "idempotency_key", "urgency"};

void drop_parts(SqliteConnection& connection) {
  connection.execute("DROP INDEX jobs_parts");
  connection.execute("DROP TRIGGER parts_go");
  for (const std::string& column : kOfVersion4)
    connection.execute(("ALTER TABLE jobs DROP COLUMN " + column).c_str());
}

void drop_columns(SqliteConnection& connection, const std::vector<std::string>& columns) {
  connection.execute("DROP INDEX IF EXISTS jobs_keys");
  connection.execute("DROP TRIGGER IF EXISTS series_go");
  connection.execute("DROP TABLE IF EXISTS series");
  for (const std::string& column : columns)
    connection.execute(("ALTER TABLE jobs DROP COLUMN " + column).c_str());
}

// The store of an older version as it is opened now, with the answers that it had.
std::unique_ptr<JobStore> brought_up(const fs::path& path, const std::vector<std::string>& ids) {
  auto store = open_sqlite_job_store(path);
  EXPECT_TRUE(store) << store.error().detail;
  if (!store) return nullptr;
  for (int k = 0; k < 8; ++k)
    EXPECT_EQ((*store)->outcome(ids[static_cast<std::size_t>(k)]).value(), answer_of(k));
  return std::move(*store);
}

TEST(JobStoreDamage, AStoreOfVersionThreeIsCopiedAndGoesOn) {
  const ScratchFolder folder;
  const fs::path path = folder.path() / "jobs.sqlite";
  const std::vector<std::string> ids = fill(path);
  {
    SqliteConnection connection(path, CommitKind::kQuick);
    drop_parts(connection);
    connection.execute("PRAGMA user_version = 3");
  }
  const std::unique_ptr<JobStore> store = brought_up(path, ids);
  ASSERT_TRUE(store);
  const Lease whole = store->claim("a", {}, 5, 6).value()->lease();
  EXPECT_TRUE(store->split(whole, {"{}", "{}"}, 6).value());
  EXPECT_EQ(store->parts(whole.id).value().size(), 2U);
  EXPECT_TRUE(fs::exists(path.string() + ".version-3"));
}

TEST(JobStoreDamage, AnEarlierCopyOfAStoreIsKeptBesideTheNewOne) {
  const ScratchFolder folder;
  const fs::path path = folder.path() / "jobs.sqlite", copy = path.string() + ".version-3";
  const std::vector<std::string> ids = fill(path);
  {
    SqliteConnection connection(path, CommitKind::kQuick);
    drop_parts(connection);
    connection.execute("PRAGMA user_version = 3");
  }
  write_file(copy, "an earlier copy");
  ASSERT_TRUE(brought_up(path, ids));
  EXPECT_EQ(file_bytes(copy), "an earlier copy");
  int copies = 0;
  for (const auto& entry : fs::directory_iterator(folder.path()))
    if (entry.path().string().starts_with(copy.string())) ++copies;
  EXPECT_EQ(copies, 2);
}

TEST(JobStoreDamage, AStoreOfVersionTwoIsCopiedAndGoesOn) {
  const ScratchFolder folder;
  const fs::path path = folder.path() / "jobs.sqlite";
  const std::vector<std::string> ids = fill(path);
  {
    SqliteConnection connection(path, CommitKind::kQuick);
    drop_parts(connection);
    drop_columns(connection, kOfVersion3);
    connection.execute("PRAGMA user_version = 2");
  }
  const std::unique_ptr<JobStore> store = brought_up(path, ids);
  ASSERT_TRUE(store);
  EXPECT_EQ(store->claim("a", {}, 5, 6).value()->job.urgency, kUsualUrgency);
  EXPECT_TRUE(fs::exists(path.string() + ".version-2"));
}

TEST(JobStoreDamage, AStoreOfVersionOneIsCopiedAndGoesOn) {
  const ScratchFolder folder;
  const fs::path path = folder.path() / "jobs.sqlite";
  const std::vector<std::string> ids = fill(path);
  {
    SqliteConnection connection(path, CommitKind::kQuick);
    drop_parts(connection);
    drop_columns(connection, kOfVersion3);
    drop_columns(connection, {"deaths", "request_sha256", "outcome_sha256"});
    connection.execute("PRAGMA user_version = 1");
  }
  fs::remove(path.string() + ".marker");
  const std::unique_ptr<JobStore> store = brought_up(path, ids);
  ASSERT_TRUE(store);
  EXPECT_EQ(store->claim("a", {}, 5, 6).value()->request, answer_of(108));
  EXPECT_TRUE(fs::exists(path.string() + ".version-1"));
  EXPECT_TRUE(fs::exists(path.string() + ".marker"));
}

TEST(JobStoreDamage, TheFileShrinksWhenJobsAreForgotten) {
  const ScratchFolder folder;
  const fs::path path = folder.path() / "jobs.sqlite";
  {
    const auto store = open_sqlite_job_store(path).value();
    for (int k = 0; k < 10; ++k) {
      ASSERT_TRUE(store->append({new_job_id(), "plan", "{}"}, 1, {100}));
      const auto claimed = store->claim("a", kPlans, 2, 3);
      ASSERT_TRUE(store->finish(claimed.value()->lease(), JobState::kSuccessful, std::string(100'000, 'x'), 4)
                      .value());
    }
  }
  const auto before = fs::file_size(path);
  EXPECT_GT(before, 1'000'000u);
  EXPECT_EQ(open_sqlite_job_store(path).value()->forget_ended({.most = 1}, 5).value(), 9);
  EXPECT_LT(fs::file_size(path), before / 5);
}

}  // namespace
}  // namespace slipway::api
