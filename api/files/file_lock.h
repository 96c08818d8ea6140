#pragma once

#include <filesystem>

#include "core/result.h"

namespace slipway::api {

// The exclusive right of one process to a file or folder. It ends with this object, and with the process
// however that ends.
class FileLock {
 public:
  // Locks a file, which is made where it is not there and stays when the lock ends, or a folder. Does not
  // wait. Errors: conflict where another process holds the lock; unwritable_file.
  static Result<FileLock> take(const std::filesystem::path& path);

  FileLock(FileLock&& other) noexcept;
  FileLock& operator=(FileLock&& other) noexcept;
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;
  ~FileLock();

 private:
  explicit FileLock(int descriptor) : descriptor_(descriptor) {}

  int descriptor_;
};

}  // namespace slipway::api
