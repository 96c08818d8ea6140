#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "api/jobs/commit_kind.h"

struct pg_conn;
struct pg_result;

namespace slipway::api {

// Something that PostgreSQL refused, or did not answer in time.
class PostgresFailure : public std::runtime_error {
 public:
  explicit PostgresFailure(const std::string& words, std::string sqlstate = {})
      : std::runtime_error(words), sqlstate_(std::move(sqlstate)) {}

  // The code of the error [PostgreSQL 15, appendix A]; empty where there is none.
  const std::string& sqlstate() const { return sqlstate_; }
  // Whether the same call may succeed a moment later: the server starts, stops, crashed, has become a
  // standby, or has undone one transaction for the sake of another.
  bool may_pass() const;

 private:
  std::string sqlstate_;
};

// The connection was lost, or not made. Whether a commit that was under way took place is not known.
class PostgresLost : public PostgresFailure {
 public:
  using PostgresFailure::PostgresFailure;
};

// What is stored is not what was kept.
class PostgresDamage : public PostgresFailure {
 public:
  using PostgresFailure::PostgresFailure;
};

// Where the database is: "postgresql://USER@HOST,HOST:PORT/DATABASE?..." in libpq's form. Several hosts, a
// service file and a password file are libpq's own [PostgreSQL 15, 34.1].
class PostgresAddress {
 public:
  // Throws PostgresFailure, which repeats nothing of the text, where it is none.
  explicit PostgresAddress(std::string uri);

  const std::string& uri() const { return uri_; }  // with its password: never to be shown
  // The same without its password, which is empty where there was none.
  const std::string& shown() const { return shown_; }
  const std::string& password() const { return password_; }

 private:
  std::string uri_, shown_, password_;
};

// The values of a statement's $1, $2, ... Text and bytes are copied.
class PostgresValues {
 public:
  PostgresValues& text(std::string_view value);  // of a column of text or bytes
  PostgresValues& number(std::int64_t value);
  PostgresValues& real(double value);
  PostgresValues& list(const std::vector<std::string>& values);             // text[]
  PostgresValues& bytes_list(const std::vector<std::string_view>& values);  // bytea[]
  PostgresValues& nothing();                                                // NULL

 private:
  friend class PostgresConnection;
  struct Value {
    std::string bytes;
    bool binary = false, null = false;
  };
  std::vector<Value> values_;
};

// What a statement gave. Columns count from 0; whole numbers are of type bigint.
class PostgresRows {
 public:
  int count() const;
  std::string text(int row, int column) const;  // of text or bytes
  std::int64_t number(int row, int column) const;
  std::optional<std::int64_t> optional_number(int row, int column) const;
  double real(int row, int column) const;
  bool is_null(int row, int column) const;
  int changed() const;  // rows that were inserted, updated or deleted

 private:
  friend class PostgresConnection;
  struct Clearer {
    void operator()(pg_result* result) const;
  };
  std::unique_ptr<pg_result, Clearer> result_;
};

// A session with the server that takes writes. Used by one thread at a time. Throws PostgresLost and
// PostgresFailure.
class PostgresConnection {
 public:
  using Clock = std::chrono::steady_clock;

  PostgresConnection(const PostgresAddress& address, CommitKind kind);
  PostgresConnection(const PostgresConnection&) = delete;
  PostgresConnection& operator=(const PostgresConnection&) = delete;

  // Statements that have no answer by then are cancelled and end in PostgresLost.
  void set_deadline(Clock::time_point until) { until_ = until; }
  PostgresRows run(const std::string& sql, const PostgresValues& values = {});
  // Whether it can be used for another call.
  bool is_good() const;

  // Channels on which other sessions have notified this one [PostgreSQL 15, NOTIFY].
  std::vector<std::string> notifications();
  int socket() const;

 private:
  struct Closer {
    void operator()(pg_conn* connection) const;
  };
  void send(const std::string& sql, const PostgresValues& values);
  void wait(bool for_writing);
  void give_up();
  [[noreturn]] void throw_lost();

  std::unique_ptr<pg_conn, Closer> connection_;
  Clock::time_point until_;
  bool warned_ = false;  // the last statement was, see run()
  bool broken_ = false;
};

// A transaction that is undone unless committed.
class PostgresTransaction {
 public:
  explicit PostgresTransaction(PostgresConnection& connection) : connection_(connection) {
    connection_.run("BEGIN");
  }
  ~PostgresTransaction();
  PostgresTransaction(const PostgresTransaction&) = delete;
  PostgresTransaction& operator=(const PostgresTransaction&) = delete;
  void commit();

 private:
  PostgresConnection& connection_;
  bool open_ = true;
};

}  // namespace slipway::api
