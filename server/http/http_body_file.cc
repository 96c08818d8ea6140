#include "server/http/http_body_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <utility>

namespace slipway::server {
namespace {

tl::unexpected<Error> unwritten(int error) {
  const bool full = error == ENOSPC || error == EDQUOT;
  return fail(full ? ErrorCode::kStorageFull : ErrorCode::kStorage,
              std::string("the body could not be kept: ") + std::strerror(error));
}

}  // namespace

bool LargeBodies::take(std::string_view method, std::string_view path) const {
  return !folder.empty() && method == "POST" && std::find(paths.begin(), paths.end(), path) != paths.end();
}

Result<std::unique_ptr<BodyFile>> BodyFile::make(const std::filesystem::path& folder,
                                                 std::shared_ptr<std::atomic<std::int64_t>> total) {
  FileDescriptor file(::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600));
  std::string name;
  // What file systems say that have none: their own, or as if the flag's other half, O_DIRECTORY, were all.
  if (!file.is_open() && (errno == EOPNOTSUPP || errno == EISDIR || errno == EINVAL)) {
    name = (folder / ".body-XXXXXX").string();
    file = FileDescriptor(::mkostemp(name.data(), O_CLOEXEC));
  }
  if (!file.is_open()) return unwritten(errno);
  return std::unique_ptr<BodyFile>(new BodyFile(std::move(file), std::move(name), std::move(total)));
}

BodyFile::~BodyFile() {
  if (!name_.empty()) static_cast<void>(::unlink(name_.c_str()));
  *total_ -= bytes_;
}

Result<void> BodyFile::append(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(file_.fd(), bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return unwritten(errno);
    bytes.remove_prefix(static_cast<std::size_t>(written));
    bytes_ += written;
    *total_ += written;
  }
  return {};
}

}  // namespace slipway::server
