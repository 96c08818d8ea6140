#include "dem/tile_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>

#include "core/digest.h"

namespace slipway::dem {
namespace {

// Before each tile: where it belongs and a sum of its bytes.
struct TileHead {
  std::int32_t level = 0, row = 0, column = 0, reserved = 0;
  std::uint64_t sum = 0;
};

// Over words of eight bytes: it tells a whole tile from one that was cut off.
std::uint64_t sum_of(const std::vector<std::uint8_t>& bytes) {
  std::uint64_t sum = kFnvBasis;
  for (std::size_t i = 0; i + sizeof(std::uint64_t) <= bytes.size(); i += sizeof(std::uint64_t)) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data() + i, sizeof word);
    sum = fnv1a(sum, word);
  }
  return sum;
}

std::string head_of(const std::string& key, std::size_t tile_bytes) {
  return fmt::format("slipway-tiles/1 {} {}\n", key, tile_bytes);
}

tl::unexpected<Error> unwritable(const std::filesystem::path& path, const std::string& what) {
  return fail(ErrorCode::kUnwritableFile, fmt::format("{} {}: {}", what, path.filename().string(),
                                                      std::system_category().message(errno)));
}

}  // namespace

Result<void> TileFile::put(std::uint64_t place, const void* bytes, std::size_t count) const {
  const auto* from = static_cast<const char*>(bytes);
  while (count > 0) {
    const ssize_t written = ::pwrite(file_.fd(), from, count, static_cast<off_t>(place));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return unwritable(path_, "cannot write");
    from += written;
    place += static_cast<std::uint64_t>(written);
    count -= static_cast<std::size_t>(written);
  }
  return {};
}

bool TileFile::get(std::uint64_t place, void* bytes, std::size_t count) const {
  auto* to = static_cast<char*>(bytes);
  while (count > 0) {
    const ssize_t got = ::pread(file_.fd(), to, count, static_cast<off_t>(place));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    to += got;
    place += static_cast<std::uint64_t>(got);
    count -= static_cast<std::size_t>(got);
  }
  return true;
}

void TileFile::find_tiles(std::uint64_t from, std::uint64_t size, const Progress& progress) {
  std::vector<std::uint8_t> bytes(tile_bytes_);
  for (end_ = from; end_ + sizeof(TileHead) + tile_bytes_ <= size; end_ += sizeof(TileHead) + tile_bytes_) {
    if (progress.cancelled()) return;
    TileHead head;
    const std::uint64_t place = end_ + sizeof head;
    if (!get(end_, &head, sizeof head) || !get(place, bytes.data(), bytes.size()) ||
        head.sum != sum_of(bytes))
      return;
    places_[{head.level, head.row, head.column}] = place;
  }
}

Result<std::unique_ptr<TileFile>> TileFile::open(const std::filesystem::path& path, const std::string& key,
                                                 std::size_t tile_bytes, const Progress& progress) {
  FileDescriptor descriptor(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644));
  if (!descriptor.is_open()) return unwritable(path, "cannot open");
  struct stat status {};
  if (::fstat(descriptor.fd(), &status) != 0 || !S_ISREG(status.st_mode))
    return fail(ErrorCode::kUnwritableFile, path.filename().string() + " is no regular file");
  std::unique_ptr<TileFile> file(new TileFile(path, std::move(descriptor), tile_bytes));
  const std::string head = head_of(key, tile_bytes);
  std::string found(head.size(), '\0');
  if (file->get(0, found.data(), found.size()) && found == head) {
    file->find_tiles(head.size(), static_cast<std::uint64_t>(status.st_size), progress);
    if (progress.cancelled()) return fail(ErrorCode::kCancelled, "the map was given up");
  } else {
    if (const auto written = file->put(0, head.data(), head.size()); !written) return fail(written.error());
    file->end_ = head.size();
  }
  if (::ftruncate(file->file_.fd(), static_cast<off_t>(file->end_)) != 0)
    return unwritable(path, "cannot write");
  return file;
}

bool TileFile::has(const TileIndex& tile) const {
  const std::lock_guard lock(mutex_);
  return places_.contains(tile);
}

Result<void> TileFile::write(const TileIndex& tile, const std::vector<std::uint8_t>& bytes) {
  const TileHead head{tile.level, tile.row, tile.column, 0, sum_of(bytes)};
  const std::lock_guard lock(mutex_);
  if (const auto written = put(end_, &head, sizeof head); !written) return written;
  if (const auto written = put(end_ + sizeof head, bytes.data(), bytes.size()); !written) return written;
  places_[tile] = end_ + sizeof head;
  end_ += sizeof head + bytes.size();
  return {};
}

Result<std::vector<std::uint8_t>> TileFile::read(const TileIndex& tile) const {
  const std::lock_guard lock(mutex_);
  const auto found = places_.find(tile);
  if (found == places_.end()) return fail(ErrorCode::kInternal, "a tile of the raster is missing");
  std::vector<std::uint8_t> bytes(tile_bytes_);
  if (!get(found->second, bytes.data(), bytes.size())) return unwritable(path_, "cannot read");
  return bytes;
}

}  // namespace slipway::dem
