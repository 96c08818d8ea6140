#include "server/routes/drawn_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include "api/files/whole_file.h"
#include "core/sha256.h"

namespace slipway::server {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kPiece = std::size_t{256} << 10;
constexpr const char* kFolder = "drawn";

// What can't be drawn on a full disk is no fault of the program's.
Error why_not(const fs::path& folder, Error error) {
  constexpr std::uintmax_t kFull = std::uintmax_t{1} << 20U;
  std::error_code failed;
  const fs::space_info disk = fs::space(folder, failed);
  if (failed || disk.available >= kFull) return error;
  return {ErrorCode::kStorageFull,
          fmt::format("the disk of {} is full: make room on it, and ask again", folder.string()),
          {}};
}

}  // namespace

Result<DrawnFile> DrawnFile::make(const fs::path& folder,
                                  const std::function<Result<void>(const fs::path&)>& draw) {
  api::remove_abandoned(folder, kFolder);
  const api::WorkingFolder working(folder / kFolder);
  if (const auto made = api::make_folder(working.path()); !made)
    return fail(why_not(folder, {ErrorCode::kStorage, made.error().detail, {}}));
  const fs::path path = working.path() / "file";
  if (auto drawn = draw(path); !drawn) return fail(why_not(folder, std::move(drawn.error())));
  DrawnFile file(FileDescriptor(::open(path.c_str(), O_RDONLY | O_CLOEXEC)));
  Sha256 hash;
  for (;;) {
    const auto piece = file.piece(file.size_);
    if (!piece) return fail(piece.error());
    if (piece->empty()) break;
    hash.add(*piece);
    file.size_ += piece->size();
  }
  constexpr std::size_t kTagDigits = 32;
  file.tag_ = fmt::format("\"{}\"", hash.digest().substr(0, kTagDigits));
  return file;
}

Result<std::string> DrawnFile::piece(std::size_t from) const {
  std::string bytes(kPiece, '\0');
  std::size_t got = 0;
  while (got < bytes.size()) {
    const ssize_t read =
        ::pread(file_.fd(), bytes.data() + got, bytes.size() - got, static_cast<off_t>(from + got));
    if (read < 0 && errno == EINTR) continue;
    if (read < 0)
      return fail(ErrorCode::kStorage, fmt::format("what was drawn can't be read: {}", std::strerror(errno)));
    if (read == 0) break;
    got += static_cast<std::size_t>(read);
  }
  bytes.resize(got);
  return bytes;
}

PagedBody DrawnFile::body(std::shared_ptr<const DrawnFile> file) {
  PagedBody body{{}, {}, file->tag_};
  for (std::size_t at = 0; at < file->size_; at += kPiece)
    body.page_bytes.push_back(std::min(kPiece, file->size_ - at));
  body.read = [file = std::move(file)](std::size_t page) { return file->piece(page * kPiece); };
  return body;
}

}  // namespace slipway::server
