#include "api/files/file_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

namespace slipway::api {

Result<FileLock> FileLock::take(const std::filesystem::path& path) {
  std::error_code not_there;
  const bool is_folder = std::filesystem::is_directory(path, not_there);
  constexpr int kMode = 0644;
  const int descriptor = is_folder ? ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)
                                   : ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, kMode);
  if (descriptor < 0)
    return fail(ErrorCode::kUnwritableFile,
                fmt::format("cannot open {}: {}", path.string(), std::system_category().message(errno)));
  FileLock lock(descriptor);
  // flock() belongs to the open file and ends with it: no process leaves a lock behind when it dies.
  if (::flock(descriptor, LOCK_EX | LOCK_NB) == 0) return lock;
  if (errno == EWOULDBLOCK)
    return fail(ErrorCode::kConflict, fmt::format("another process works with {}", path.string()));
  return fail(ErrorCode::kUnwritableFile,
              fmt::format("cannot lock {}: {}", path.string(), std::system_category().message(errno)));
}

FileLock::FileLock(FileLock&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}

FileLock& FileLock::operator=(FileLock&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

FileLock::~FileLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

}  // namespace slipway::api
