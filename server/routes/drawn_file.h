#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "core/file_descriptor.h"
#include "core/result.h"
#include "server/routes/byte_range.h"

namespace slipway::server {

// What is too large to be drawn in memory: a file on a disk without a name, which is gone with this.
// Thread-safe.
class DrawnFile {
 public:
  // `draw` writes the file at the path that it gets, which lies in a folder of its own inside `folder`.
  // Errors: those of draw; storage_full where the disk is full, storage.
  static Result<DrawnFile> make(const std::filesystem::path& folder,
                                const std::function<Result<void>(const std::filesystem::path&)>& draw);

  std::size_t size() const { return size_; }
  // The file as what is sent, with the tag of its bytes.
  static PagedBody body(std::shared_ptr<const DrawnFile> file);

 private:
  explicit DrawnFile(FileDescriptor file) : file_(std::move(file)) {}
  // The bytes from there on, of a piece at most. Errors: storage.
  Result<std::string> piece(std::size_t from) const;

  FileDescriptor file_;
  std::size_t size_ = 0;
  std::string tag_;
};

}  // namespace slipway::server
