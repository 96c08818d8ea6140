#include "api/uploads/artefact_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#include "api/files/whole_file.h"
#include "core/file_descriptor.h"
#include "core/sha256.h"

namespace slipway::api {
namespace {

namespace fs = std::filesystem;

std::string sha256_of(std::string_view bytes) {
  Sha256 hash;
  hash.add(bytes);
  return hash.digest();
}

tl::unexpected<Error> unwritten(const fs::path& path, int error) {
  const bool full = error == ENOSPC || error == EDQUOT;
  return fail(full ? ErrorCode::kStorageFull : ErrorCode::kStorage,
              fmt::format("the artefact {} can't be kept: {}", path.string(), std::strerror(error)));
}

bool write_all(int fd, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(fd, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

bool sync_folder(const fs::path& folder) {
  const FileDescriptor open_folder(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  return open_folder.is_open() && ::fsync(open_folder.fd()) == 0;
}

// Under its name once it is whole and, with its name, on the disk.
Result<void> write_durably(const fs::path& path, std::string_view bytes) {
  const fs::path unfinished = unfinished_name(path);
  const auto give_up = [&](int error) {
    ::unlink(unfinished.c_str());
    return unwritten(path, error);
  };
  {
    const FileDescriptor file(::open(unfinished.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0640));
    if (!file.is_open()) return unwritten(path, errno);
    if (!write_all(file.fd(), bytes) || ::fsync(file.fd()) != 0) return give_up(errno);
  }
  if (::rename(unfinished.c_str(), path.c_str()) != 0) return give_up(errno);
  if (!sync_folder(path.parent_path())) return unwritten(path, errno);
  return {};
}

std::optional<std::string> read_file(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) return std::nullopt;
  std::string bytes{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  return in.bad() ? std::nullopt : std::optional(std::move(bytes));
}

// So that it counts as used now.
void touch(const fs::path& path) {
  ::utimensat(AT_FDCWD, path.c_str(), nullptr, 0);
}

std::int64_t changed_ms(const struct stat& status) {
  return std::int64_t{status.st_mtim.tv_sec} * 1000 + status.st_mtim.tv_nsec / 1'000'000;
}

}  // namespace

Result<std::shared_ptr<ArtefactFolder>> ArtefactFolder::open(const fs::path& root, ArtefactCache cache) {
  if (const auto made = make_folder(root); !made) return fail(made.error());
  if (!cache.folder.empty())
    if (const auto made = make_folder(cache.folder); !made) return fail(made.error());
  return std::shared_ptr<ArtefactFolder>(new ArtefactFolder(root, std::move(cache)));
}

fs::path ArtefactFolder::place_of(const std::string& name) const {
  return root_ / name.substr(0, 2) / name;
}

Result<std::string> ArtefactFolder::put(std::string_view bytes) {
  std::string name = sha256_of(bytes);
  const fs::path place = place_of(name);
  std::error_code error;
  if (fs::create_directory(place.parent_path(), error); error) return unwritten(place, error.value());
  // It is there already where the same was put before: then it is as new. What was damaged meanwhile is
  // mended.
  const auto known = read_file(place);
  if (known && *known == bytes) {
    touch(place);
  } else if (auto written = write_durably(place, bytes); !written) {
    return fail(written.error());
  }
  if (!sync_folder(root_)) return unwritten(place, errno);
  return name;
}

Result<std::string> ArtefactFolder::get(const std::string& name) {
  if (!cache_.folder.empty()) {
    const fs::path copy = cache_.folder / name;
    auto bytes = read_file(copy);
    if (bytes && sha256_of(*bytes) == name) {
      touch(copy);
      return *std::move(bytes);
    }
  }
  auto bytes = read_file(place_of(name));
  if (!bytes) return fail(ErrorCode::kStorage, fmt::format("the artefact {} can't be read", name));
  if (sha256_of(*bytes) != name)
    return fail(ErrorCode::kDamagedStore, fmt::format("the artefact {} is not what was kept", name));
  keep_copy(name, *bytes);
  return *std::move(bytes);
}

// A copy that can't be kept is only slower.
void ArtefactFolder::keep_copy(const std::string& name, const std::string& bytes) {
  if (cache_.folder.empty() || static_cast<std::int64_t>(bytes.size()) > cache_.max_bytes) return;
  const std::scoped_lock lock(cache_mutex_);
  static_cast<void>(write_whole_file(cache_.folder / name, bytes));
  struct Copy {
    std::int64_t used_ms = 0, size = 0;
    fs::path path;
  };
  std::vector<Copy> copies;
  std::int64_t total = 0;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(cache_.folder, ignored)) {
    struct stat status {};
    if (::stat(entry.path().c_str(), &status) != 0 || !S_ISREG(status.st_mode)) continue;
    copies.push_back({changed_ms(status), status.st_size, entry.path()});
    total += status.st_size;
  }
  std::sort(copies.begin(), copies.end(), [](const Copy& a, const Copy& b) { return a.used_ms < b.used_ms; });
  for (const Copy& copy : copies) {
    if (total <= cache_.max_bytes) return;
    if (copy.path.filename() == name) continue;  // times have grains: what came last stays
    fs::remove(copy.path, ignored);
    total -= copy.size;
  }
}

int ArtefactFolder::forget_before(std::int64_t time_ms) {
  int forgotten = 0;
  std::error_code ignored;
  for (const auto& shelf : fs::directory_iterator(root_, ignored)) {
    if (!shelf.is_directory(ignored)) continue;
    for (const auto& entry : fs::directory_iterator(shelf.path(), ignored)) {
      struct stat status {};
      if (::stat(entry.path().c_str(), &status) != 0 || changed_ms(status) >= time_ms) continue;
      forgotten += fs::remove(entry.path(), ignored) ? 1 : 0;
    }
  }
  return forgotten;
}

}  // namespace slipway::api
