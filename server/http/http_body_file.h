#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/file_descriptor.h"
#include "core/result.h"

namespace slipway::server {

// Requests whose bodies go into a file as they come, since they may be larger than what is held in memory.
struct LargeBodies {
  std::filesystem::path folder;                          // must exist; a file in it is gone with its request
  std::vector<std::string> paths;                        // POST to one of these, as sent, without the query
  std::int64_t max_bytes = std::int64_t{4} << 30;        // of one body
  std::int64_t max_total_bytes = std::int64_t{8} << 30;  // of all that are under way
  std::vector<std::string> media_types{
      "application/octet-stream", "application/gzip", "application/json", "application/geo+json",
      "application/x-tar",        "application/zip",  "image/tiff",       "text/csv"};
  std::shared_ptr<std::atomic<std::int64_t>> under_way = std::make_shared<std::atomic<std::int64_t>>(0);

  bool take(std::string_view method, std::string_view path) const;
};

// A body in a file that has no name, or where the file system has no such files (NFS) one that begins with a
// dot, which is gone with this.
class BodyFile {
 public:
  // Errors: storage, storage_full.
  static Result<std::unique_ptr<BodyFile>> make(const std::filesystem::path& folder,
                                                std::shared_ptr<std::atomic<std::int64_t>> total);
  ~BodyFile();
  BodyFile(const BodyFile&) = delete;
  BodyFile& operator=(const BodyFile&) = delete;

  // Errors: storage, storage_full.
  Result<void> append(std::string_view bytes);
  std::int64_t bytes() const { return bytes_; }
  // Open for reading and writing, wherever its end is; linkat() gives it a name that stays.
  int fd() const { return file_.fd(); }

 private:
  BodyFile(FileDescriptor file, std::string name, std::shared_ptr<std::atomic<std::int64_t>> total)
      : file_(std::move(file)), name_(std::move(name)), total_(std::move(total)) {}

  FileDescriptor file_;
  const std::string name_;  // its path, where it has one
  std::int64_t bytes_ = 0;
  std::shared_ptr<std::atomic<std::int64_t>> total_;  // bytes of all such files
};

}  // namespace slipway::server
