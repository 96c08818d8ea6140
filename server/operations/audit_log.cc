#include "server/operations/audit_log.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string_view>
#include <utility>
#include <vector>

#include "api/jobs/job.h"
#include "api/json/writer.h"
#include "core/sha256.h"
#include "core/utc.h"
#include "server/operations/log.h"

namespace slipway::server {

namespace {

// Of a body in memory or in a file; empty where none was read, or the file can't be.
std::string body_sha256(const HttpRequest& request) {
  if (request.body.empty() && !request.body_file) return {};
  Sha256 hash;
  hash.add(request.body);
  if (!request.body_file) return hash.digest();
  std::vector<char> piece(std::size_t{1} << 20U);
  for (std::int64_t at = 0;;) {
    const ssize_t read = ::pread(request.body_file->fd(), piece.data(), piece.size(), at);
    if (read < 0 && errno == EINTR) continue;
    if (read < 0) return {};
    if (read == 0) return hash.digest();
    hash.add({piece.data(), static_cast<std::size_t>(read)});
    at += read;
  }
}

// Keeps blocks of the disk behind the file's end, which what is appended then takes. A file system that can't
// keep any is none that is full.
bool has_room_behind(int fd) {
  constexpr std::int64_t kRoom_bytes = std::int64_t{1} << 19U, kBlock_bytes = 512;
  struct ::stat status {};
  if (::fstat(fd, &status) != 0 || !S_ISREG(status.st_mode)) return true;
  if (kBlock_bytes * status.st_blocks >= status.st_size + kRoom_bytes / 2) return true;
  return ::fallocate(fd, FALLOC_FL_KEEP_SIZE, status.st_size, kRoom_bytes) == 0 ||
         (errno != ENOSPC && errno != EDQUOT);
}

bool is_same_file(const FileDescriptor& a, const FileDescriptor& b) {
  struct ::stat first {
  }, second{};
  return a.is_open() && ::fstat(a.fd(), &first) == 0 && ::fstat(b.fd(), &second) == 0 &&
         first.st_dev == second.st_dev && first.st_ino == second.st_ino;
}

// Whether a process that died has left the end of a line away.
bool ends_in_a_line(const std::string& path) {
  const FileDescriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  struct ::stat status {};
  char last = '\n';
  return file.is_open() && ::fstat(file.fd(), &status) == 0 && S_ISREG(status.st_mode) &&
         status.st_size > 0 && ::pread(file.fd(), &last, 1, status.st_size - 1) == 1 && last != '\n';
}

}  // namespace

Result<FileDescriptor> AuditLog::opened() const {
  constexpr int kOwnersAlone = 0600;
  FileDescriptor file(::open(path_.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, kOwnersAlone));
  if (!file.is_open())
    return fail(ErrorCode::kUnwritableFile,
                fmt::format("the audit log {} can't be written: {}", path_, std::strerror(errno)));
  return file;
}

Result<std::unique_ptr<AuditLog>> AuditLog::open(const std::string& path) {
  std::unique_ptr<AuditLog> log(new AuditLog(path));
  if (const auto done = log->open_again(); !done) return fail(done.error());
  return log;
}

AuditLog::~AuditLog() {
  const std::scoped_lock lock(mutex_);
  add_repeated(std::numeric_limits<std::int64_t>::max());
  static_cast<void>(write_pending());
}

Result<void> AuditLog::open_again() {
  auto file = opened();
  if (!file) return fail(file.error());
  const std::scoped_lock lock(mutex_);
  if (!is_same_file(file_, *file)) {
    sent_ = 0;  // a line that is half in the old file is in the new one whole
    if (ends_in_a_line(path_)) pending_.insert(0, "\n");
  }
  file_ = *std::move(file);
  return {};
}

void AuditLog::add(const std::string& line) {
  pending_ += with_hidden_escaped(line) + "\n";
}

Result<void> AuditLog::write_pending() {
  while (!pending_.empty()) {
    const ssize_t written = ::write(file_.fd(), pending_.data() + sent_, pending_.size() - sent_);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      const bool full = errno == ENOSPC || errno == EDQUOT;
      return fail(
          full ? ErrorCode::kStorageFull : ErrorCode::kStorage,
          fmt::format("the audit log {} can't be written ({}), and nothing is changed without it: {}", path_,
                      std::strerror(errno), full ? "make room on its disk" : "see to its file and disk"));
    }
    sent_ += static_cast<std::size_t>(written);
    const std::size_t whole = sent_ == 0 ? std::string::npos : pending_.rfind('\n', sent_ - 1);
    if (whole == std::string::npos) continue;
    pending_.erase(0, whole + 1);
    sent_ -= whole + 1;
  }
  return {};
}

Result<void> AuditLog::can_record(std::string_view method) {
  if (only_reads(method)) return {};
  const std::scoped_lock lock(mutex_);
  if (const auto written = write_pending(); !written) return written;
  if (!has_room_behind(file_.fd()) && method != "DELETE")
    return fail(ErrorCode::kStorageFull,
                fmt::format("the disk of the audit log {} is full, and nothing is made without it: make room "
                            "there, or DELETE what is not needed",
                            path_));
  return {};
}

// Those whose line is older.
void AuditLog::add_repeated(std::int64_t before_ms) {
  for (const auto& [whose, refused] : repeated_) {
    if (refused.since_ms >= before_ms || refused.more == 0) continue;
    api::json::Writer w;
    w.begin_object().text("time", utc_text(now_ms())).text("who", whose.first).whole("status", whose.second);
    w.whole("more", refused.more).text("since", utc_text(refused.since_ms)).end_object();
    add(w.take());
  }
  std::erase_if(repeated_, [&](const auto& entry) { return entry.second.since_ms < before_ms; });
}

// Whoever asks without being let in does not fill the disk: one line a minute, and from then on a count.
bool AuditLog::is_repeated(const AnsweredRequest& answered, std::int64_t now) {
  constexpr int kUnauthorized = 401, kTooManyRequests = 429;
  constexpr std::size_t kMostAddresses = 1000;
  const int status = answered.response.status;
  if (status != kUnauthorized && status != kTooManyRequests) return false;
  std::pair whose{answered.request.principal, status};
  if (repeated_.size() >= kMostAddresses && !repeated_.contains(whose)) whose.first = "others";
  const auto [place, is_first] = repeated_.try_emplace(whose, Repeated{now, 0});
  if (!is_first) ++place->second.more;
  return !is_first;
}

void AuditLog::record(const AnsweredRequest& answered) {
  if (only_reads(answered.request.method)) return;
  constexpr int kLeastRefusal = 400;
  constexpr std::int64_t kMinute_ms = 60'000;
  const std::int64_t now = now_ms();
  const bool changed = answered.response.status < kLeastRefusal && !answered.response.changed_nothing;
  const std::scoped_lock lock(mutex_);
  if (is_repeated(answered, now)) return;
  if (changed || has_room_behind(file_.fd())) {
    add_repeated(now - kMinute_ms);
    record_line(answered);
  } else {
    ++unsaid_;
  }
  if (const auto written = write_pending(); !written)
    log_event(LogLevel::kError, "audit_log_not_written", {{"reason", written.error().detail}});
}

void AuditLog::record_line(const AnsweredRequest& answered) {
  const HttpRequest& request = answered.request;
  api::json::Writer w;
  w.begin_object()
      .text("time", utc_text(now_ms()))
      .text("who", request.principal)
      .text("address", request.remote_address);
  w.text("method", request.method).text("path", request.path);
  if (const std::string hash = body_sha256(request); !hash.empty()) w.text("body_sha256", hash);
  w.whole("status", answered.response.status);
  w.text("location", answered.response.header("Location").value_or(""));
  w.text("id", request.id);
  if (unsaid_ > 0) w.whole("unsaid_before", std::exchange(unsaid_, 0));
  if (!answered.response.audit.empty()) w.key("what").raw(answered.response.audit);
  w.end_object();
  add(w.take());
}

}  // namespace slipway::server
