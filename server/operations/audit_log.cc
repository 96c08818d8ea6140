#include "server/operations/audit_log.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>
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

Result<void> AuditLog::open_again() {
  auto file = opened();
  if (!file) return fail(file.error());
  const std::scoped_lock lock(mutex_);
  file_ = *std::move(file);
  return {};
}

Result<void> AuditLog::write_pending() {
  while (!pending_.empty()) {
    const ssize_t written = ::write(file_.fd(), pending_.data(), pending_.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      const bool full = errno == ENOSPC || errno == EDQUOT;
      return fail(
          full ? ErrorCode::kStorageFull : ErrorCode::kStorage,
          fmt::format("the audit log {} can't be written ({}), and nothing is changed without it: {}", path_,
                      std::strerror(errno), full ? "make room on its disk" : "see to its file and disk"));
    }
    pending_.erase(0, static_cast<std::size_t>(written));
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

void AuditLog::record(const AnsweredRequest& answered) {
  const HttpRequest& request = answered.request;
  if (only_reads(request.method)) return;
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
  if (!answered.response.audit.empty()) w.key("what").raw(answered.response.audit);
  w.end_object();
  const std::scoped_lock lock(mutex_);
  pending_ += w.take() + "\n";
  if (const auto written = write_pending(); !written)
    log_event(LogLevel::kError, "audit_log_not_written", {{"reason", written.error().detail}});
}

}  // namespace slipway::server
