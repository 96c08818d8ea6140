#include "api/jobs/sqlite_connection.h"

#include <fmt/format.h>
#include <sqlite3.h>

namespace slipway::api {
namespace {

constexpr int kPrimaryCode = 0xff;  // the other bits tell kinds of it apart

// What to do about it.
std::string_view remedy_of(int code) {
  switch (code & kPrimaryCode) {
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
      return "; stop the service and restore a copy of the file, or move it away to begin an empty one";
    case SQLITE_FULL:
      return "; make room on its disk";
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return "; another process holds it: try again, or stop that one";
    case SQLITE_IOERR:
    case SQLITE_CANTOPEN:
    case SQLITE_READONLY:
    case SQLITE_PERM:
      return "; let the service read and write the file and its folder, and look whether their disk is sound";
    default:
      return "";
  }
}

[[noreturn]] void throw_failure(int code, const std::string& words) {
  switch (code & kPrimaryCode) {
    case SQLITE_FULL:
      throw SqliteFull(words);
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
      throw SqliteDamage(words);
    default:
      throw SqliteFailure(words);
  }
}

[[noreturn]] void throw_last_failure(sqlite3* database) {
  const char* const file = sqlite3_db_filename(database, "main");
  const std::string of = file == nullptr || *file == '\0' ? "" : fmt::format(" of {}", file);
  const int code = sqlite3_errcode(database);
  throw_failure(code, fmt::format("SQLite{}: {}{}", of, sqlite3_errmsg(database), remedy_of(code)));
}

}  // namespace

// What it holds is let go of here: a read that is not reset keeps the log from being emptied, and bound text
// may be a whole answer.
SqliteStatement::~SqliteStatement() {
  sqlite3_reset(statement_.get());
  sqlite3_clear_bindings(statement_.get());
  idle_ = std::move(statement_);
}

void SqliteStatement::Finaliser::operator()(sqlite3_stmt* statement) const {
  sqlite3_finalize(statement);
}

void SqliteStatement::check(int code) const {
  if (code != SQLITE_OK) throw_last_failure(database_);
}

SqliteStatement& SqliteStatement::bind(std::string_view text) {
  // A null pointer would bind NULL, and an empty text is not that.
  check(sqlite3_bind_text64(statement_.get(), ++bound_, text.data() == nullptr ? "" : text.data(),
                            text.size(), SQLITE_TRANSIENT, SQLITE_UTF8));
  return *this;
}

SqliteStatement& SqliteStatement::bind(std::int64_t number) {
  check(sqlite3_bind_int64(statement_.get(), ++bound_, number));
  return *this;
}

SqliteStatement& SqliteStatement::bind(double number) {
  check(sqlite3_bind_double(statement_.get(), ++bound_, number));
  return *this;
}

bool SqliteStatement::step() {
  const int code = sqlite3_step(statement_.get());
  if (code == SQLITE_ROW) return true;
  if (code == SQLITE_DONE) return false;
  throw_last_failure(database_);
}

std::string SqliteStatement::text(int column) const {
  const auto* const bytes = static_cast<const char*>(sqlite3_column_blob(statement_.get(), column));
  if (bytes == nullptr) return {};
  return {bytes, static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column))};
}

std::int64_t SqliteStatement::number(int column) const {
  return sqlite3_column_int64(statement_.get(), column);
}

std::optional<std::int64_t> SqliteStatement::optional_number(int column) const {
  if (sqlite3_column_type(statement_.get(), column) == SQLITE_NULL) return std::nullopt;
  return number(column);
}

double SqliteStatement::real(int column) const {
  return sqlite3_column_double(statement_.get(), column);
}

SqliteConnection::SqliteConnection(const std::filesystem::path& path, CommitKind kind) {
  sqlite3* database = nullptr;
  constexpr int kFlags = SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE | SQLITE_OPEN_NOMUTEX;
  const int code = sqlite3_open_v2(path.empty() ? ":memory:" : path.c_str(), &database, kFlags, nullptr);
  database_.reset(database);  // there is one to close even when opening failed
  if (code != SQLITE_OK) {
    throw SqliteFailure(
        fmt::format("SQLite can't open {}: {}{}", path.string(), sqlite3_errstr(code), remedy_of(code)));
  }
  constexpr int kBusy_ms = 5000;
  sqlite3_busy_timeout(database, kBusy_ms);
  execute("PRAGMA auto_vacuum=INCREMENTAL");  // first of all: it is fixed with the file's first page
  execute("PRAGMA journal_mode=WAL");
  execute(kind == CommitKind::kDurable ? "PRAGMA synchronous=FULL" : "PRAGMA synchronous=NORMAL");
}

void SqliteConnection::Closer::operator()(sqlite3* database) const {
  sqlite3_close_v2(database);
}

SqliteStatement SqliteConnection::prepare(std::string_view sql) {
  auto found = idle_.find(sql);
  if (found == idle_.end()) found = idle_.emplace(sql, nullptr).first;
  SqliteStatement::Prepared& idle = found->second;
  SqliteStatement::Prepared statement = std::move(idle);
  if (!statement) {
    sqlite3_stmt* compiled = nullptr;
    const int code = sqlite3_prepare_v3(database_.get(), sql.data(), static_cast<int>(sql.size()),
                                        SQLITE_PREPARE_PERSISTENT, &compiled, nullptr);
    statement.reset(compiled);
    if (code != SQLITE_OK) throw_last_failure(database_.get());
  }
  return {database_.get(), std::move(statement), idle};
}

void SqliteConnection::execute(const char* sql) {
  if (sqlite3_exec(database_.get(), sql, nullptr, nullptr, nullptr) != SQLITE_OK) {
    throw_last_failure(database_.get());
  }
}

int SqliteConnection::changes() const {
  return sqlite3_changes(database_.get());
}

SqliteTransaction::~SqliteTransaction() {
  if (!open_) return;
  try {
    connection_.execute("ROLLBACK");
  } catch (const SqliteFailure&) {
    // SQLite has rolled back by itself, as it does when the disk is full.
    open_ = false;
  }
}

void SqliteTransaction::commit() {
  connection_.execute("COMMIT");
  open_ = false;
}

}  // namespace slipway::api
