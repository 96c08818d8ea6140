#pragma once

#include <filesystem>
#include <string>

#include "core/result.h"

namespace slipway::api {

// Writes a file that is under its name only when it is whole: a process that is killed, or a disk that is
// full, leaves what was there before. What is no regular file (a pipe, /dev/stdout) is written to as it is.
// Of several writers of one file the last one wins. Errors: unwritable_file.
Result<void> write_whole_file(const std::filesystem::path& path, const std::string& bytes);

// Whether a file of this name can only be the unfinished part of one that write_whole_file() was killed in.
bool is_unfinished(const std::filesystem::path& path);

// Makes a folder, and those above it, where there is none. Errors: unwritable_file.
Result<void> make_folder(const std::filesystem::path& path);

}  // namespace slipway::api
