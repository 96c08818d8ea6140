#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
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
// and never changed. What nobody was let in to ask for has a line for each address and minute, with how often
// more it was asked. Thread-safe.
class AuditLog {
 public:
  ~AuditLog();
  // Errors: unwritable_file.
  static Result<std::unique_ptr<AuditLog>> open(const std::string& path);

  // Opens the file of that name anew, since a rotation has moved the old one. An error leaves the old one.
  Result<void> open_again();

  // Whether what a request of this method does can be recorded: what can't be must not be done. Room for
  // lines to come is kept on the disk, so that what frees a full one (DELETE) can still be asked for: what
  // changed nothing has no line where it would take of that. Errors: storage, storage_full.
  Result<void> can_record(std::string_view method);

  // Time, who, from where, method, address, the body's SHA-256, status, what was made (Location), the
  // request's id, and what the answer has for the log (HttpResponse::audit).
  void record(const AnsweredRequest& answered);

 private:
  explicit AuditLog(std::string path) : path_(std::move(path)) {}
  // Refusals of one kind to one address since its line.
  struct Repeated {
    std::int64_t since_ms = 0;
    std::int64_t more = 0;
  };

  Result<FileDescriptor> opened() const;
  void add(const std::string& line);
  void add_repeated(std::int64_t before_ms);
  bool is_repeated(const AnsweredRequest& answered, std::int64_t now);
  void record_line(const AnsweredRequest& answered);
  Result<void> write_pending();

  const std::string path_;
  std::mutex mutex_;
  FileDescriptor file_;
  std::string pending_;      // whole lines that the disk did not take
  std::size_t sent_ = 0;     // bytes of the first of them that it did
  std::int64_t unsaid_ = 0;  // lines of what changed nothing that a full disk had no room for
  std::map<std::pair<std::string, int>, Repeated> repeated_;  // by who was refused, and the status
};

}  // namespace slipway::server
