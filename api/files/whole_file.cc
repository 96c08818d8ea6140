#include "api/files/whole_file.h"

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <fstream>
#include <string_view>
#include <system_error>
#include <vector>

#include "core/sha256.h"

namespace slipway::api {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kUnfinished = ".slipway-part";

tl::unexpected<Error> unwritable(const fs::path& path, const std::string& why) {
  return fail(ErrorCode::kUnwritableFile, why.empty()
                                              ? fmt::format("cannot write {}", path.string())
                                              : fmt::format("cannot write {}: {}", path.string(), why));
}

bool written(const fs::path& path, const std::string& bytes) {
  std::ofstream stream(path, std::ios::binary);
  stream << bytes << std::flush;
  stream.close();
  return !stream.fail();
}

}  // namespace

Result<void> write_whole_file(const fs::path& given, const std::string& bytes) {
  std::error_code error;
  // Through a link the file that it leads to is written, and the link stays.
  const fs::path path = fs::is_symlink(given, error) ? fs::weakly_canonical(given, error) : given;
  const fs::file_status before = fs::status(path, error);
  if (fs::is_directory(before)) return unwritable(given, "it is a folder");
  if (fs::exists(before) && !fs::is_regular_file(before)) {
    if (!written(path, bytes)) return unwritable(given, "");
    return {};
  }
  const fs::path unfinished = unfinished_name(path);
  if (!written(unfinished, bytes)) {
    fs::remove(unfinished, error);
    return unwritable(given, "");
  }
  if (fs::exists(before)) fs::permissions(unfinished, before.permissions(), error);
  fs::rename(unfinished, path, error);
  if (!error) return {};
  const std::string why = error.message();
  fs::remove(unfinished, error);
  return unwritable(given, why);
}

bool is_unfinished(const fs::path& path) {
  const std::string name = path.filename().string();
  return name.starts_with('.') && name.ends_with(kUnfinished);
}

fs::path unfinished_name(const fs::path& path) {
  static std::atomic<unsigned> calls{0};
  return path.parent_path() /
         fmt::format(".{}.{}-{}{}", path.filename().string(), ::getpid(), ++calls, kUnfinished);
}

WorkingFolder::~WorkingFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

void remove_abandoned(const fs::path& folder, const std::string& name) {
  std::error_code error;
  std::vector<fs::path> abandoned;
  const std::string start = "." + name + ".";
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const std::string file = it->path().filename().string();
    if (!is_unfinished(it->path()) || !file.starts_with(start)) continue;
    const int process = std::atoi(file.c_str() + start.size());
    if (process > 0 && ::kill(process, 0) != 0 && errno == ESRCH) abandoned.push_back(it->path());
  }
  for (const fs::path& path : abandoned) fs::remove_all(path, error);
}

Result<std::string> sha256_of_file(const fs::path& path, const Progress& progress) {
  std::ifstream stream(path, std::ios::binary);
  Sha256 hash;
  std::vector<char> piece(1U << 20U);
  while (stream) {
    if (progress.cancelled()) return fail(ErrorCode::kCancelled, "reading was given up");
    stream.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    hash.add({piece.data(), static_cast<std::size_t>(stream.gcount())});
  }
  if (!stream.eof())
    return fail(ErrorCode::kUnreadableData, fmt::format("{} can't be read", path.filename().string()));
  return hash.digest();
}

Result<void> make_folder(const fs::path& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (error)
    return fail(ErrorCode::kUnwritableFile,
                fmt::format("cannot make {}: {}", path.string(), error.message()));
  return {};
}

}  // namespace slipway::api
