#include "api/uploads/upload_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <set>
#include <system_error>
#include <utility>

#include "api/files/whole_file.h"
#include "api/json/parse.h"
#include "api/json/strict_reader.h"
#include "api/json/writer.h"
#include "core/file_descriptor.h"
#include "core/largest_exact_whole.h"
#include "core/sha256.h"

namespace slipway::api {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxName = 100;
constexpr std::size_t kIdDigits = 64;

tl::unexpected<Error> unstored(int error, std::string_view what) {
  const bool full = error == ENOSPC || error == EDQUOT;
  return fail(full ? ErrorCode::kStorageFull : ErrorCode::kStorage,
              fmt::format("{}: {}", what, std::strerror(error)));
}

bool is_file_name(const std::string& name) {
  return !name.empty() && name.size() <= kMaxName && name.front() != '.' && name != kOriginFile &&
         std::all_of(name.begin(), name.end(), [](char c) {
           return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' ||
                  c == '_' || c == '-';
         });
}

bool is_id(std::string_view id) {
  return id.size() == kIdDigits && id.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

Result<std::string> sha256_of_descriptor(int fd) {
  Sha256 hash;
  std::vector<char> piece(1U << 20U);
  for (std::int64_t at = 0;;) {
    const ssize_t read = ::pread(fd, piece.data(), piece.size(), at);
    if (read < 0 && errno == EINTR) continue;
    if (read < 0) return unstored(errno, "what was sent can't be read");
    if (read == 0) return hash.digest();
    hash.add({piece.data(), static_cast<std::size_t>(read)});
    at += read;
  }
}

// The name of the folder of an owner's upload. Before owners had their own it was the id.
std::string folder_name(const std::string& id, const std::string& owner) {
  constexpr std::size_t kOwnerDigits = 16;
  if (owner.empty()) return id;
  Sha256 hash;
  hash.add(owner);
  return fmt::format("{}.{}", id, hash.digest().substr(0, kOwnerDigits));
}

// Whether `a` stands for the uploads of the same bytes rather than `b`.
bool is_nearer(const Upload& a, const Upload& b, const Asker& asker) {
  const auto distance = [&](const Upload& upload) {
    if (upload.origin.owner == asker.name) return 0;
    return upload.origin.owner.empty() ? 1 : 2;
  };
  return std::pair(distance(a), a.folder) < std::pair(distance(b), b.folder);
}

std::optional<Upload> upload_in(const fs::path& folder) {
  Upload upload;
  upload.folder = folder.filename().string();
  upload.id = upload.folder.substr(0, kIdDigits);
  const bool is_owners = upload.folder.size() > kIdDigits;
  if (!is_id(upload.id) || (is_owners && upload.folder[kIdDigits] != '.')) return std::nullopt;
  auto origin = read_origin(folder, &upload.name);
  if (!origin || !is_file_name(upload.name)) return std::nullopt;
  upload.origin = *std::move(origin);
  std::error_code error;
  upload.bytes = static_cast<std::int64_t>(fs::file_size(folder / upload.name, error));
  if (error) return std::nullopt;
  return upload;
}

void sync(const fs::path& path) {
  const FileDescriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (file.is_open()) static_cast<void>(::fsync(file.fd()));
}

}  // namespace

std::string origin_document(const UploadOrigin& origin, std::string_view name) {
  json::Writer w;
  w.begin_object().text("name", name).text("owner", origin.owner).whole("at_ms", origin.at_ms);
  w.text("from", origin.from).text("follows", origin.follows).end_object();
  return w.take() + "\n";
}

Result<void> write_origin(const fs::path& folder, const UploadOrigin& origin, std::string_view name) {
  return write_whole_file(folder / kOriginFile, origin_document(origin, name));
}

std::optional<UploadOrigin> read_origin(const fs::path& folder, std::string* name) {
  std::ifstream in(folder / kOriginFile, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  const auto document = json::parse(bytes);
  if (!document) return std::nullopt;
  std::vector<Fault> faults;
  json::ObjectReader reader(*document, "", faults);
  if (!reader.is_object()) return std::nullopt;
  UploadOrigin origin;
  std::string named;
  const json::TextRule any{.most = 1000, .may_be_empty = true};
  reader.text("name", json::kRequired, any, named);
  reader.text("owner", json::kRequired, any, origin.owner);
  reader.whole("at_ms", json::kRequired, std::int64_t{0}, static_cast<std::int64_t>(kMaxExactWhole),
               origin.at_ms);
  reader.text("from", json::kRequired, any, origin.from);
  reader.text("follows", json::kRequired, any, origin.follows);
  if (!faults.empty()) return std::nullopt;
  if (name != nullptr) *name = named;
  return origin;
}

bool may_change(const std::optional<UploadOrigin>& origin, const Asker& asker) {
  if (asker.name.empty() || asker.is_admin) return true;
  return origin && (origin->owner.empty() || origin->owner == asker.name);
}

Result<bool> put_in_place(const fs::path& finished, const fs::path& place) {
  for (const auto& entry : fs::recursive_directory_iterator(finished)) sync(entry.path());
  sync(finished);
  // Fails where the name is that of a folder with something in it.
  if (::rename(finished.c_str(), place.c_str()) != 0) {
    if (errno == ENOTEMPTY || errno == EEXIST) return false;
    return unstored(errno, "what was sent could not be kept");
  }
  sync(place.parent_path());
  return true;
}

Result<bool> take_away(const fs::path& place) {
  const fs::path gone = unfinished_name(place);
  if (::rename(place.c_str(), gone.c_str()) != 0) {
    if (errno == ENOENT) return false;
    return unstored(errno, "it could not be removed");
  }
  sync(place.parent_path());
  std::error_code error;
  fs::remove_all(gone, error);
  return true;
}

Result<std::shared_ptr<UploadFolder>> UploadFolder::open(const fs::path& root, UploadLimits limits) {
  std::shared_ptr<UploadFolder> folder(new UploadFolder(root, limits));
  for (const fs::path& path : {folder->files(), folder->campaigns(), folder->terrains()})
    if (const auto made = make_folder(path); !made) return fail(made.error());
  return folder;
}

Result<Upload> UploadFolder::keep(int fd, const std::string& name, const UploadOrigin& origin) {
  if (!is_file_name(name))
    return fail(
        ErrorCode::kInvalidRequest, "the file's name can't be used",
        {{"/name", fmt::format("must be 1 to {} letters, digits, \".\", \"_\" or \"-\", and not begin "
                               "with \".\"",
                               kMaxName)}});
  remove_old(origin.at_ms);
  struct ::stat status {};
  if (::fstat(fd, &status) != 0) return unstored(errno, "what was sent can't be read");
  if (const auto room = check_room(status.st_size); !room) return fail(room.error());
  auto id = sha256_of_descriptor(fd);
  if (!id) return fail(id.error());
  const Asker owner{.name = origin.owner};
  const auto known = find(*id, owner);
  if (known && known->origin.owner == origin.owner) return *known;
  const fs::path place = files() / folder_name(*id, origin.owner);
  const WorkingFolder working(place);
  if (const auto made = make_folder(working.path()); !made)
    return fail(ErrorCode::kStorage, made.error().detail);
  const std::string open_file = fmt::format("/proc/self/fd/{}", fd);
  // What another owner has sent has these bytes, where it is what was sent.
  const auto others = known ? verified(*id, owner) : Result<fs::path>(fail(ErrorCode::kNotFound, ""));
  const std::string source = others ? others->string() : open_file;
  if (::linkat(AT_FDCWD, source.c_str(), AT_FDCWD, (working.path() / name).c_str(), AT_SYMLINK_FOLLOW) != 0)
    return unstored(errno, "what was sent could not be kept");
  const auto written = write_origin(working.path(), origin, name);
  auto placed = written ? put_in_place(working.path(), place) : Result<bool>(fail(written.error()));
  if (!placed) return fail(ErrorCode::kStorage, placed.error().detail);
  if (auto kept = upload_in(place)) return *kept;
  return fail(ErrorCode::kStorage, "what was sent is not there any more");
}

std::vector<Upload> UploadFolder::all() const {
  std::vector<Upload> uploads;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(files(), error))
    if (auto upload = upload_in(entry.path())) uploads.push_back(*std::move(upload));
  return uploads;
}

std::vector<Upload> UploadFolder::list(const Asker& asker) const {
  std::vector<Upload> uploads = all();
  std::sort(uploads.begin(), uploads.end(), [&](const Upload& a, const Upload& b) {
    return a.id == b.id ? is_nearer(a, b, asker) : a.id < b.id;
  });
  const auto same = [](const Upload& a, const Upload& b) { return a.id == b.id; };
  uploads.erase(std::unique(uploads.begin(), uploads.end(), same), uploads.end());
  return uploads;
}

std::optional<Upload> UploadFolder::find(std::string_view id, const Asker& asker) const {
  if (!is_id(id)) return std::nullopt;
  if (auto own = upload_in(files() / folder_name(std::string(id), asker.name));
      own && own->origin.owner == asker.name)
    return own;
  std::optional<Upload> nearest;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(files(), error)) {
    if (!entry.path().filename().string().starts_with(id)) continue;
    auto upload = upload_in(entry.path());
    if (upload && (!nearest || is_nearer(*upload, *nearest, asker))) nearest = std::move(upload);
  }
  return nearest;
}

Result<fs::path> UploadFolder::verified(const std::string& id, const Asker& asker) const {
  const auto upload = find(id, asker);
  if (!upload) return fail(ErrorCode::kNotFound, fmt::format("there is no upload {}", id));
  const fs::path path = files() / upload->folder / upload->name;
  const auto hash = sha256_of_file(path);
  if (!hash || *hash != id)
    return fail(ErrorCode::kDamagedStore, fmt::format("the upload {} is not what was sent any more", id));
  return path;
}

Result<bool> UploadFolder::remove(const Upload& upload) {
  return take_away(files() / upload.folder);
}

std::int64_t UploadFolder::bytes() const {
  std::int64_t sum = 0;
  std::set<std::pair<dev_t, ino_t>> counted;  // of files with several names
  std::error_code error;
  for (fs::recursive_directory_iterator it(root_, error), end; !error && it != end; it.increment(error)) {
    struct ::stat status {};
    if (::lstat(it->path().c_str(), &status) != 0 || !S_ISREG(status.st_mode)) continue;
    const bool is_coming = it->path().parent_path() == files();  // an upload is a folder there
    const bool is_known = status.st_nlink > 1 && !counted.emplace(status.st_dev, status.st_ino).second;
    if (!is_coming && !is_known) sum += status.st_size;
  }
  return sum;
}

std::int64_t UploadFolder::room() const {
  constexpr std::int64_t kLeftForOthers = std::int64_t{64} << 20U;
  std::error_code error;
  const fs::space_info disk = fs::space(root_, error);
  const std::int64_t allowed = limits_.max_total_bytes - bytes();
  const std::int64_t there = error ? allowed : static_cast<std::int64_t>(disk.available) - kLeftForOthers;
  return std::max<std::int64_t>(0, std::min(allowed, there));
}

Result<void> UploadFolder::check_room(std::int64_t more) const {
  if (const std::int64_t now = bytes(); now + more > limits_.max_total_bytes)
    return fail(ErrorCode::kStorageFull,
                fmt::format("{} bytes more would make {} of uploads, and {} are allowed: delete some", more,
                            now + more, limits_.max_total_bytes));
  return {};
}

void UploadFolder::remove_old(std::int64_t now_ms) {
  for (const Upload& upload : all())
    if (now_ms - upload.origin.at_ms > limits_.max_age_ms) static_cast<void>(remove(upload));
  // What a service that died has left of bodies under way.
  constexpr auto kDay = std::chrono::hours(24);
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(files(), error)) {
    std::error_code gone;
    const bool is_old = fs::file_time_type::clock::now() - entry.last_write_time(gone) > kDay;
    if (!gone && is_old && entry.is_regular_file(gone)) fs::remove(entry.path(), gone);
  }
}

}  // namespace slipway::api
