#pragma once

#include <string>
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
  static Result<AuditLog> open(const std::string& path);

  // Time, who, from where, method, address, the body's SHA-256, status, what was made (Location), the
  // request's id, and what the answer has for the log (HttpResponse::audit).
  void record(const AnsweredRequest& answered);

 private:
  explicit AuditLog(FileDescriptor file) : file_(std::move(file)) {}

  FileDescriptor file_;
};

}  // namespace slipway::server
