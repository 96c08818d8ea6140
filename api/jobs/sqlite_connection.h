#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "api/jobs/commit_kind.h"

struct sqlite3;
struct sqlite3_stmt;

namespace slipway::api {

// Something that SQLite refused; caught by the store, where it becomes a `storage` error.
class SqliteFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The disk is full.
class SqliteFull : public SqliteFailure {
 public:
  using SqliteFailure::SqliteFailure;
};

// The file is no database, or a damaged one.
class SqliteDamage : public SqliteFailure {
 public:
  using SqliteFailure::SqliteFailure;
};

// One statement, bound. Text is copied when bound. It does not outlive its connection.
class SqliteStatement {
 public:
  ~SqliteStatement();
  SqliteStatement(const SqliteStatement&) = delete;
  SqliteStatement& operator=(const SqliteStatement&) = delete;

  SqliteStatement& bind(std::string_view text);  // the next "?"
  SqliteStatement& bind(std::int64_t number);
  SqliteStatement& bind(double number);
  // True: a row is there to be read. False: done.
  bool step();

  std::string text(int column) const;
  std::int64_t number(int column) const;
  std::optional<std::int64_t> optional_number(int column) const;
  double real(int column) const;

 private:
  friend class SqliteConnection;
  struct Finaliser {
    void operator()(sqlite3_stmt* statement) const;
  };
  using Prepared = std::unique_ptr<sqlite3_stmt, Finaliser>;
  // `idle` is where the statement waits for its next use.
  SqliteStatement(sqlite3* database, Prepared statement, Prepared& idle)
      : database_(database), statement_(std::move(statement)), idle_(idle) {}

  void check(int code) const;

  sqlite3* database_;
  Prepared statement_;
  Prepared& idle_;
  int bound_ = 0;
};

// A connection to a database in WAL mode, whose deleted pages can be given back to the disk (PRAGMA
// incremental_vacuum). Where the path is empty the database is in memory, has no log and is this connection's
// alone. Used by one thread at a time.
class SqliteConnection {
 public:
  SqliteConnection(const std::filesystem::path& path, CommitKind kind);

  // A statement is compiled once and kept, for compiling takes longer than most of them run: its text is the
  // program's own, and values are bound.
  SqliteStatement prepare(std::string_view sql);
  void execute(const char* sql);
  // Rows that the last statement changed.
  int changes() const;

 private:
  struct Closer {
    void operator()(sqlite3* database) const;
  };
  std::unique_ptr<sqlite3, Closer> database_;
  std::map<std::string, SqliteStatement::Prepared, std::less<>> idle_;  // by text; null while it is used
};

// A transaction that is undone unless committed.
class SqliteTransaction {
 public:
  explicit SqliteTransaction(SqliteConnection& connection) : connection_(connection) {
    connection_.execute("BEGIN IMMEDIATE");
  }
  ~SqliteTransaction();
  SqliteTransaction(const SqliteTransaction&) = delete;
  SqliteTransaction& operator=(const SqliteTransaction&) = delete;
  void commit();

 private:
  SqliteConnection& connection_;
  bool open_ = true;
};

}  // namespace slipway::api
