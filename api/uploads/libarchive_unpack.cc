#include <archive.h>
#include <archive_entry.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "api/json/faults.h"
#include "api/uploads/unpack.h"
#include "core/file_descriptor.h"

namespace slipway::api {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kReadAtOnce = std::size_t{1} << 16U;
constexpr std::size_t kMaxFaults = 50;

struct FreeArchive {
  void operator()(archive* a) const { archive_read_free(a); }
};

// Why a path is not taken.
std::optional<std::string> fault_of(const fs::path& path, const UnpackLimits& limits) {
  if (path.empty()) return "has no name";
  if (path.is_absolute()) return "must be a relative path";
  std::size_t parts = 0;
  for (const fs::path& part : path) {
    const std::string& name = part.native();
    if (name.empty() || name == ".") continue;
    ++parts;
    if (name == "..") return "must not contain \"..\"";
    if (name.size() > limits.max_name)
      return fmt::format("has a part of more than {} bytes", limits.max_name);
    const bool plain = std::all_of(name.begin(), name.end(), [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' ||
             c == '_' || c == '-' || c == '+' || c == ' ';
    });
    if (!plain) return "may have letters, digits, blanks, \".\", \"_\", \"-\" and \"+\" only";
  }
  if (parts > limits.max_depth + 1) return fmt::format("lies in more than {} folders", limits.max_depth);
  return std::nullopt;
}

class Unpacking {
 public:
  Unpacking(archive* from, const fs::path& into, const UnpackLimits& limits, Progress& progress)
      : from_(from), into_(into), limits_(limits), progress_(progress) {}

  Result<void> run() {
    archive_entry* entry = nullptr;
    for (;;) {
      if (progress_.cancelled()) return fail(ErrorCode::kCancelled, "The unpacking was given up.");
      const int next = archive_read_next_header(from_, &entry);
      if (next == ARCHIVE_EOF) break;
      if (next != ARCHIVE_OK && next != ARCHIVE_WARN) {
        add(fmt::format("the archive can't be read after {} files: {}", files_, words()));
        break;
      }
      if (const auto taken = take(entry); !taken) return taken;
      if (given_up_) break;
    }
    if (files_ == 0 && faults_.empty()) add("the archive holds no file");
    if (faults_.empty()) return {};
    return fail(ErrorCode::kInvalidRequest, summary_of(faults_), faults_);
  }

 private:
  void add(std::string what) {
    if (faults_.size() < kMaxFaults) faults_.push_back({"/upload", std::move(what)});
  }
  std::string words() const {
    const char* const text = archive_error_string(from_);
    return text == nullptr ? "it is damaged" : text;
  }

  Result<void> take(archive_entry* entry) {
    const char* const raw = archive_entry_pathname(entry);
    const std::string name = raw == nullptr ? "" : raw;
    const fs::path path(name);
    const bool link = archive_entry_hardlink(entry) != nullptr || archive_entry_symlink(entry) != nullptr;
    const auto type = archive_entry_filetype(entry);
    if (const auto fault = fault_of(path, limits_)) {
      add(fmt::format("{} {}", in_quotes(name), *fault));
    } else if (link || (type != AE_IFREG && type != AE_IFDIR)) {
      add(fmt::format("{} is no plain file", in_quotes(name)));
    } else if (type == AE_IFDIR) {
      const std::size_t before = folders_;
      make_folders(path);
      if (folders_ == before) ++folders_;  // one that is there already costs a look too
    } else if (++files_ > limits_.max_files) {
      add(fmt::format("the archive has more than {} files", limits_.max_files));
      given_up_ = true;
    } else {
      if (!make_folders(path.parent_path())) return {};
      return write(into_ / path, name);
    }
    return {};
  }

  // The folder with those above it. False: the archive has more than it may, and is given up. One that can't
  // be made is found by the file that is to lie in it.
  bool make_folders(const fs::path& folder) {
    fs::path at = into_;
    for (const fs::path& part : folder) {
      at /= part;
      std::error_code error;
      if (fs::create_directory(at, error)) ++folders_;
    }
    if (folders_ <= limits_.max_folders) return true;
    add(fmt::format("the archive has more than {} folders", limits_.max_folders));
    given_up_ = true;
    return false;
  }

  Result<void> write(const fs::path& path, const std::string& name) {
    const FileDescriptor file(
        ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600));
    if (!file.is_open()) {
      add(fmt::format("{} is there twice, or as a file and a folder", in_quotes(name)));
      return {};
    }
    std::vector<char> piece(kReadAtOnce);
    for (;;) {
      const la_ssize_t read = archive_read_data(from_, piece.data(), piece.size());
      if (read == 0) return {};
      if (read < 0) {
        add(fmt::format("{} can't be read: {}", in_quotes(name), words()));
        given_up_ = true;
        return {};
      }
      bytes_ += read;
      if (bytes_ > limits_.max_bytes) {
        add(
            fmt::format("the archive's files have more than {} bytes, which is what there is room for: "
                        "delete uploads, or send less",
                        limits_.max_bytes));
        given_up_ = true;
        return {};
      }
      if (::write(file.fd(), piece.data(), static_cast<std::size_t>(read)) != read)
        return fail(errno == ENOSPC ? ErrorCode::kStorageFull : ErrorCode::kStorage,
                    fmt::format("the archive's files could not be written: {}", std::strerror(errno)));
      if (progress_.cancelled()) return fail(ErrorCode::kCancelled, "The unpacking was given up.");
    }
  }

  archive* from_;
  const fs::path& into_;
  const UnpackLimits& limits_;
  Progress& progress_;
  std::size_t files_ = 0, folders_ = 0;
  std::int64_t bytes_ = 0;
  bool given_up_ = false;
  std::vector<Fault> faults_;
};

}  // namespace

Result<void> unpack(const fs::path& path, const fs::path& into, const UnpackLimits& limits,
                    Progress& progress) {
  const std::unique_ptr<archive, FreeArchive> from(archive_read_new());
  if (!from) return fail(ErrorCode::kInternal, "no archive can be read");
  archive_read_support_format_tar(from.get());
  archive_read_support_format_zip(from.get());
  archive_read_support_filter_gzip(from.get());
  if (archive_read_open_filename(from.get(), path.c_str(), kReadAtOnce) != ARCHIVE_OK) {
    const std::vector<Fault> faults{
        {"/upload", fmt::format("is no archive: tar, tar.gz or zip ({})", archive_error_string(from.get()))}};
    return fail(ErrorCode::kInvalidRequest, summary_of(faults), faults);
  }
  return Unpacking(from.get(), into, limits, progress).run();
}

}  // namespace slipway::api
