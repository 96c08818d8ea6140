#include "api/jobs/postgres_connection.h"

#include <endian.h>
#include <fmt/format.h>
#include <libpq-fe.h>
#include <poll.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <thread>

namespace slipway::api {
namespace {

using std::chrono::milliseconds;

constexpr int kBinary = 1;

// libpq ends its messages with a line's end, and has several lines where it tried several hosts.
std::string in_one_line(const char* message) {
  std::string words = message == nullptr ? "" : message;
  while (!words.empty() && words.back() == '\n') words.pop_back();
  for (std::size_t at = 0; (at = words.find('\n', at)) != std::string::npos;) words.replace(at, 1, "; ");
  return words;
}

std::string without_password(std::string uri) {
  const std::size_t authority = uri.find("://") + 3;
  const std::size_t end = std::min(uri.find_first_of("/?", authority), uri.size());
  const std::size_t user_end = uri.substr(0, end).rfind('@');
  const std::size_t colon = uri.find(':', authority);
  if (user_end != std::string::npos && user_end >= authority && colon < user_end)
    uri.erase(colon, user_end - colon);
  for (const std::string_view key : {"?password=", "&password="})
    for (std::size_t at = 0; (at = uri.find(key)) != std::string::npos;) {
      const std::size_t next = uri.find('&', at + 1);
      uri.erase(at + 1, next == std::string::npos ? next : next - at);
    }
  while (uri.ends_with('?') || uri.ends_with('&')) uri.pop_back();
  return uri;
}

// A warning is all that tells of a commit whose wait for the standby was cancelled: it holds here alone.
void note_warning(void* warned, const PGresult* notice) {
  const char* const severity = PQresultErrorField(notice, PG_DIAG_SEVERITY_NONLOCALIZED);
  if (severity != nullptr && std::string_view(severity) == "WARNING") *static_cast<bool*>(warned) = true;
}

const char* cell(const pg_result* result, int row, int column) {
  return PQgetvalue(result, row, column);
}

}  // namespace

bool PostgresFailure::may_pass() const {
  // Of these classes: connection, too many of them, rolled back, a standby that refuses writes, shut down.
  constexpr std::array kPassing{"08", "40", "25006", "53300", "57P", "55P03"};
  return dynamic_cast<const PostgresLost*>(this) != nullptr ||
         std::any_of(kPassing.begin(), kPassing.end(),
                     [&](const char* code) { return sqlstate_.starts_with(code); });
}

PostgresAddress::PostgresAddress(std::string uri) : uri_(std::move(uri)) {
  // What libpq says of a faulty address repeats parts of it, which may be its password.
  const std::unique_ptr<PQconninfoOption, decltype(&PQconninfoFree)> options(
      PQconninfoParse(uri_.c_str(), nullptr), &PQconninfoFree);
  if (!options)
    throw PostgresFailure(
        "the address of the database is not of the form postgresql://USER@HOST:PORT/DATABASE");
  for (const PQconninfoOption* option = options.get(); option->keyword != nullptr; ++option) {
    if (option->val == nullptr) continue;
    const std::string_view key = option->keyword;
    if (key == "password") password_ = option->val;
    if (key == "sslpassword")
      throw PostgresFailure("sslpassword belongs into a service file, not into the address");
  }
  shown_ = without_password(uri_);
}

PostgresValues& PostgresValues::text(std::string_view value) {
  values_.push_back({std::string(value), true, false});
  return *this;
}

PostgresValues& PostgresValues::number(std::int64_t value) {
  values_.push_back({fmt::format("{}", value)});
  return *this;
}

PostgresValues& PostgresValues::real(double value) {
  values_.push_back({fmt::format("{}", value)});
  return *this;
}

PostgresValues& PostgresValues::list(const std::vector<std::string>& values) {
  std::string array = "{";
  for (const std::string& value : values) {
    if (array.size() > 1) array += ',';
    array += '"';
    for (const char c : value) {
      if (c == '"' || c == '\\') array += '\\';
      array += c;
    }
    array += '"';
  }
  values_.push_back({array + "}"});
  return *this;
}

PostgresValues& PostgresValues::bytes_list(const std::vector<std::string_view>& values) {
  // The binary form of an array [PostgreSQL 15, array_recv()]: dimensions, whether any is NULL, the type of
  // its elements; then the size and the first index of the one dimension; then each with its length.
  constexpr std::uint32_t kBytea = 17;
  std::string array;
  const auto append = [&array](std::uint32_t number) {
    const std::uint32_t big_endian = htobe32(number);
    array.append(reinterpret_cast<const char*>(&big_endian),
                 sizeof big_endian);  // NOLINT(*-reinterpret-cast)
  };
  for (const std::uint32_t number : {1U, 0U, kBytea, static_cast<std::uint32_t>(values.size()), 1U})
    append(number);
  for (const std::string_view value : values) {
    append(static_cast<std::uint32_t>(value.size()));
    array += value;
  }
  values_.push_back({std::move(array), true, false});
  return *this;
}

PostgresValues& PostgresValues::nothing() {
  values_.push_back({.bytes = {}, .binary = false, .null = true});
  return *this;
}

void PostgresRows::Clearer::operator()(pg_result* result) const {
  PQclear(result);
}

int PostgresRows::count() const {
  return PQntuples(result_.get());
}

std::string PostgresRows::text(int row, int column) const {
  return {cell(result_.get(), row, column),
          static_cast<std::size_t>(PQgetlength(result_.get(), row, column))};
}

std::int64_t PostgresRows::number(int row, int column) const {
  std::uint64_t big_endian = 0;
  if (PQgetlength(result_.get(), row, column) != sizeof big_endian)
    throw PostgresFailure(fmt::format("column {} is no bigint", column));
  std::memcpy(&big_endian, cell(result_.get(), row, column), sizeof big_endian);
  return static_cast<std::int64_t>(be64toh(big_endian));
}

std::optional<std::int64_t> PostgresRows::optional_number(int row, int column) const {
  if (is_null(row, column)) return std::nullopt;
  return number(row, column);
}

double PostgresRows::real(int row, int column) const {
  return std::bit_cast<double>(number(row, column));
}

bool PostgresRows::is_null(int row, int column) const {
  return PQgetisnull(result_.get(), row, column) != 0;
}

int PostgresRows::changed() const {
  return std::atoi(PQcmdTuples(result_.get()));
}

PostgresConnection::PostgresConnection(const PostgresAddress& address, CommitKind kind)
    : until_(Clock::now() + std::chrono::seconds(10)) {
  // What the address itself says goes before these. A host that does not answer is left for the next after
  // 2 s, and a connection on which nothing comes back is given up within 10 s.
  const std::array keys{"connect_timeout",
                        "target_session_attrs",
                        "tcp_user_timeout",
                        "client_encoding",
                        "fallback_application_name",
                        "dbname",
                        static_cast<const char*>(nullptr)};
  const std::array values{"2",
                          "read-write",
                          "10000",
                          "UTF8",
                          "slipway",
                          address.uri().c_str(),
                          static_cast<const char*>(nullptr)};
  connection_.reset(PQconnectdbParams(keys.data(), values.data(), 1));
  if (PQstatus(connection_.get()) != CONNECTION_OK) throw_lost();
  PQsetNoticeReceiver(connection_.get(), note_warning, &warned_);
  PQsetnonblocking(connection_.get(), 1);
  // Who has turned durable commits off for the whole server does not mean the jobs. Queues change faster than
  // what the planner knows of them: a job of thousands of parts that was just divided would be sorted by each
  // claim, where the index has the order; and what no longer can be sorted is no reason to compile it.
  constexpr std::string_view kAlways =
      "set_config('default_transaction_isolation', 'read committed', false), "
      "set_config('enable_sort', 'off', false), set_config('enable_bitmapscan', 'off', false), "
      "set_config('jit', 'off', false)";
  run(fmt::format("SELECT set_config('synchronous_commit', {}, false), {}",
                  kind == CommitKind::kQuick ? "'off'"
                                             : "CASE current_setting('synchronous_commit') WHEN 'off' THEN "
                                               "'on' ELSE current_setting('synchronous_commit') END",
                  kAlways));
}

void PostgresConnection::Closer::operator()(pg_conn* connection) const {
  PQfinish(connection);
}

void PostgresConnection::throw_lost() {
  broken_ = true;
  throw PostgresLost(fmt::format("PostgreSQL: {}", in_one_line(PQerrorMessage(connection_.get()))));
}

// The server may hold the answer back for ever, as it does with a commit whose standby is lost. The
// cancelling connection can take as long as any other, so nobody waits for it.
void PostgresConnection::give_up() {
  broken_ = true;
  if (PGcancel* const cancel = PQgetCancel(connection_.get()); cancel != nullptr)
    std::thread([cancel] {
      std::array<char, 256> why{};
      static_cast<void>(PQcancel(cancel, why.data(), static_cast<int>(why.size())));
      PQfreeCancel(cancel);
    }).detach();
  throw PostgresLost(
      "PostgreSQL did not answer in time; where it has a synchronous standby, that may be lost");
}

void PostgresConnection::wait(bool for_writing) {
  const auto left = std::chrono::ceil<milliseconds>(until_ - Clock::now()).count();
  if (left <= 0) give_up();
  pollfd polled{PQsocket(connection_.get()), static_cast<short>(for_writing ? POLLIN | POLLOUT : POLLIN), 0};
  ::poll(&polled, 1, static_cast<int>(std::min<std::int64_t>(left, 1000)));
  if (polled.revents != 0 && (polled.revents & POLLIN) != 0 && PQconsumeInput(connection_.get()) == 0)
    throw_lost();
  if ((polled.revents & (POLLERR | POLLHUP)) != 0 && PQconsumeInput(connection_.get()) == 0) throw_lost();
}

void PostgresConnection::send(const std::string& sql, const PostgresValues& values) {
  std::vector<const char*> bytes;
  std::vector<int> lengths, formats;
  for (const PostgresValues::Value& value : values.values_) {
    bytes.push_back(value.null ? nullptr : value.bytes.c_str());
    lengths.push_back(static_cast<int>(value.bytes.size()));
    formats.push_back(value.binary ? kBinary : 0);
  }
  if (PQsendQueryParams(connection_.get(), sql.c_str(), static_cast<int>(bytes.size()), nullptr, bytes.data(),
                        lengths.data(), formats.data(), kBinary) == 0)
    throw_lost();
  for (int left = 0; (left = PQflush(connection_.get())) != 0; wait(true))
    if (left < 0) throw_lost();
}

PostgresRows PostgresConnection::run(const std::string& sql, const PostgresValues& values) {
  warned_ = false;
  send(sql, values);
  PostgresRows rows;
  for (;;) {
    while (PQisBusy(connection_.get()) != 0) wait(false);
    PGresult* const next = PQgetResult(connection_.get());
    if (next == nullptr) break;
    rows.result_.reset(next);
  }
  const ExecStatusType status = PQresultStatus(rows.result_.get());
  if (status == PGRES_COMMAND_OK || status == PGRES_TUPLES_OK) {
    if (warned_) throw PostgresLost("PostgreSQL no longer waits for its synchronous standby");
    return rows;
  }
  if (PQstatus(connection_.get()) != CONNECTION_OK) throw_lost();
  const char* const code = PQresultErrorField(rows.result_.get(), PG_DIAG_SQLSTATE);
  const char* const words = PQresultErrorField(rows.result_.get(), PG_DIAG_MESSAGE_PRIMARY);
  throw PostgresFailure(fmt::format("PostgreSQL: {}", in_one_line(words)), code == nullptr ? "" : code);
}

bool PostgresConnection::is_good() const {
  return !broken_ && PQstatus(connection_.get()) == CONNECTION_OK &&
         PQtransactionStatus(connection_.get()) == PQTRANS_IDLE;
}

std::vector<std::string> PostgresConnection::notifications() {
  if (PQconsumeInput(connection_.get()) == 0) throw_lost();
  std::vector<std::string> channels;
  while (PGnotify* const heard = PQnotifies(connection_.get())) {
    if (heard->be_pid != PQbackendPID(connection_.get())) channels.emplace_back(heard->relname);
    PQfreemem(heard);
  }
  return channels;
}

int PostgresConnection::socket() const {
  return PQsocket(connection_.get());
}

PostgresTransaction::~PostgresTransaction() {
  if (!open_) return;
  try {
    connection_.run("ROLLBACK");
  } catch (const PostgresFailure&) {
    open_ = false;  // the connection is not used again, and the server rolls back by itself
  }
}

void PostgresTransaction::commit() {
  open_ = false;  // a commit that fails leaves nothing to undo, or nobody who could
  connection_.run("COMMIT");
}

}  // namespace slipway::api
