#pragma once

#include <filesystem>
#include <string>

#include "core/progress.h"
#include "core/result.h"

namespace slipway::api {

// Writes a file that is under its name only when it is whole: a process that is killed, or a disk that is
// full, leaves what was there before. What is no regular file (a pipe, /dev/stdout) is written to as it is.
// Of several writers of one file the last one wins. Errors: unwritable_file.
Result<void> write_whole_file(const std::filesystem::path& path, const std::string& bytes);

// Whether a file of this name can only be the unfinished part of one that write_whole_file() was killed in.
bool is_unfinished(const std::filesystem::path& path);

// A name for an unfinished file or folder beside the one that it is to become: is_unfinished(), and of this
// process and call alone.
std::filesystem::path unfinished_name(const std::filesystem::path& path);
// The path of a folder in the making, beside the one that it is to become: unfinished_name(). What is still
// under that name when this ends is removed.
class WorkingFolder {
 public:
  explicit WorkingFolder(const std::filesystem::path& place) : path_(unfinished_name(place)) {}
  ~WorkingFolder();
  WorkingFolder(const WorkingFolder&) = delete;
  WorkingFolder& operator=(const WorkingFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};
// Removes what processes that are no more left unfinished of this name.
void remove_abandoned(const std::filesystem::path& folder, const std::string& name);

// The SHA-256 of a file's bytes, which are read piece by piece. Errors: unreadable_data; cancelled.
Result<std::string> sha256_of_file(const std::filesystem::path& path,
                                   const Progress& progress = NoProgress());

// Makes a folder, and those above it, where there is none. Errors: unwritable_file.
Result<void> make_folder(const std::filesystem::path& path);

}  // namespace slipway::api
