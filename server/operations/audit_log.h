#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>

#include "core/file_descriptor.h"
#include "core/result.h"
#include "server/http/http_options.h"

namespace slipway::server {

// Who asked for what: one JSON object a line for every request that is not one to read, appended to a file
// and never changed. Thread-safe.
class AuditLog {
 public:
  // Errors: unwritable_file.
  static Result<std::unique_ptr<AuditLog>> open(const std::string& path);

  // Opens the file of that name anew, since a rotation has moved the old one. An error leaves the old one.
  Result<void> open_again();

  // Whether what a request of this method does can be recorded: what can't be must not be done. Room for
  // lines to come is kept on the disk, so that what frees a full one (DELETE) can still be asked for. Errors:
  // storage, storage_full.
  Result<void> can_record(std::string_view method);

  // Time, who, from where, method, address, the body's SHA-256, status, what was made (Location), the
  // request's id, and what the answer has for the log (HttpResponse::audit).
  void record(const AnsweredRequest& answered);

 private:
  explicit AuditLog(std::string path) : path_(std::move(path)) {}
  Result<FileDescriptor> opened() const;
  Result<void> write_pending();

  const std::string path_;
  std::mutex mutex_;
  FileDescriptor file_;
  std::string pending_;  // lines, or the end of one, that the disk did not take
};

}  // namespace slipway::server
