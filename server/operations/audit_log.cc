#include "server/operations/audit_log.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string_view>

#include "api/jobs/job.h"
#include "api/json/writer.h"
#include "core/sha256.h"
#include "core/utc.h"
#include "server/operations/log.h"

namespace slipway::server {

Result<AuditLog> AuditLog::open(const std::string& path) {
  constexpr int kOwnersAlone = 0600;
  FileDescriptor file(::open(path.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, kOwnersAlone));
  if (!file.is_open())
    return fail(ErrorCode::kUnwritableFile,
                fmt::format("the audit log {} can't be written: {}", path, std::strerror(errno)));
  return AuditLog(std::move(file));
}

void AuditLog::record(const AnsweredRequest& answered) {
  const HttpRequest& request = answered.request;
  if (only_reads(request.method)) return;
  Sha256 body;
  body.add(request.body);
  api::json::Writer w;
  w.begin_object()
      .text("time", utc_text(now_ms()))
      .text("who", request.principal)
      .text("address", request.remote_address);
  w.text("method", request.method).text("path", request.path).text("body_sha256", body.digest());
  w.whole("status", answered.response.status);
  w.text("location", answered.response.header("Location").value_or(""));
  w.text("id", request.id);
  if (!answered.response.audit.empty()) w.key("what").raw(answered.response.audit);
  w.end_object();
  const std::string line = w.take() + "\n";
  // One write to a file that only grows: lines of several threads do not mix.
  if (::write(file_.fd(), line.data(), line.size()) != static_cast<ssize_t>(line.size()))
    log_event(LogLevel::kError, "audit_log_not_written", {{"reason", std::string(std::strerror(errno))}});
}

}  // namespace slipway::server
