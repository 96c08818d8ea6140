// Statements that are kept between their uses.
#include "api/jobs/sqlite_connection.h"

#include <gtest/gtest.h>

#include <string>

#include "small_world.h"

namespace slipway::api {
namespace {

using testing::ScratchFolder;

constexpr std::string_view kAll = "SELECT number FROM numbers ORDER BY number";

struct Numbers {
  explicit Numbers(const std::filesystem::path& path) : connection(path, CommitKind::kQuick) {
    connection.execute("CREATE TABLE IF NOT EXISTS numbers (number INTEGER)");
  }
  void add(std::int64_t number) { connection.prepare("INSERT INTO numbers VALUES (?)").bind(number).step(); }
  SqliteConnection connection;
};

TEST(SqliteConnection, AStatementComesBackWithNothingBoundAndAtItsBeginning) {
  const ScratchFolder folder;
  Numbers numbers(folder.path() / "numbers.sqlite");
  constexpr std::string_view kEcho = "SELECT ?, coalesce(?, 'nothing')";
  {
    auto row = numbers.connection.prepare(kEcho);
    row.bind("first").bind("second");
    ASSERT_TRUE(row.step());
    EXPECT_EQ(row.text(1), "second");
  }
  auto row = numbers.connection.prepare(kEcho);
  row.bind("again");
  ASSERT_TRUE(row.step());
  EXPECT_EQ(row.text(0), "again");
  EXPECT_EQ(row.text(1), "nothing");
  EXPECT_FALSE(row.step());
}

TEST(SqliteConnection, OneTextMayBeReadInAnothersMidst) {
  const ScratchFolder folder;
  Numbers numbers(folder.path() / "numbers.sqlite");
  for (const std::int64_t number : {1, 2, 3}) numbers.add(number);
  std::string read;
  auto outer = numbers.connection.prepare(kAll);
  while (outer.step()) {
    read += std::to_string(outer.number(0)) + ":";
    auto inner = numbers.connection.prepare(kAll);
    while (inner.step()) read += std::to_string(inner.number(0));
    read += " ";
  }
  EXPECT_EQ(read, "1:123 2:123 3:123 ");
}

// Or the log would grow without end while a service runs.
TEST(SqliteConnection, AReadThatWasLeftInItsMidstHoldsNothingBack) {
  const ScratchFolder folder;
  const auto path = folder.path() / "numbers.sqlite";
  Numbers one(path), other(path);
  for (const std::int64_t number : {1, 2, 3}) one.add(number);
  EXPECT_TRUE(one.connection.prepare(kAll).step());
  other.add(4);
  auto checkpoint = other.connection.prepare("PRAGMA wal_checkpoint(TRUNCATE)");
  ASSERT_TRUE(checkpoint.step());
  EXPECT_EQ(checkpoint.number(0), 0) << "a reader keeps the log from being emptied";
}

TEST(SqliteConnection, AKeptStatementSeesWhatAnotherConnectionChanged) {
  const ScratchFolder folder;
  const auto path = folder.path() / "numbers.sqlite";
  Numbers one(path), other(path);
  const auto count = [&] {
    auto row = one.connection.prepare("SELECT count(*) FROM numbers");
    return row.step() ? row.number(0) : -1;
  };
  for (std::int64_t known = 0; known < 3; ++known) {
    EXPECT_EQ(count(), known);
    other.add(known);
  }
  other.connection.execute("ALTER TABLE numbers ADD COLUMN name TEXT");
  EXPECT_EQ(count(), 3);
}

TEST(SqliteConnection, WhatIsNoStatementIsRefusedEachTime) {
  const ScratchFolder folder;
  Numbers numbers(folder.path() / "numbers.sqlite");
  for (int k = 0; k < 2; ++k) EXPECT_THROW(numbers.connection.prepare("SELECT nonsense"), SqliteFailure);
}

std::string failure_of(SqliteConnection& connection, const char* sql) {
  try {
    connection.execute(sql);
  } catch (const SqliteFailure& failure) {
    return failure.what();
  }
  return "none";
}

TEST(SqliteConnection, AFailureSaysWhichFileAndWhatToDo) {
  const ScratchFolder folder;
  const auto path = folder.path() / "numbers.sqlite";
  Numbers one(path), other(path);
  const std::string of = "SQLite of " + path.string() + ": ";
  one.connection.execute("BEGIN IMMEDIATE");
  other.connection.execute("PRAGMA busy_timeout = 0");
  EXPECT_EQ(failure_of(other.connection, "BEGIN IMMEDIATE"),
            of + "database is locked; another process holds it: try again, or stop that one");
  one.connection.execute("PRAGMA query_only = 1");
  EXPECT_EQ(
      failure_of(one.connection, "INSERT INTO numbers VALUES (1)"),
      of +
          "attempt to write a readonly database; let the service read and write the file and its folder, and "
          "look whether their disk is sound");
  EXPECT_EQ(failure_of(one.connection, "SELECT nonsense"), of + "no such column: nonsense");
  SqliteConnection in_memory("", CommitKind::kQuick);
  EXPECT_EQ(failure_of(in_memory, "SELECT nonsense"), "SQLite: no such column: nonsense");
}

}  // namespace
}  // namespace slipway::api
