#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/result.h"

namespace slipway::api {

// What a file is called until it is whole: its own name and this.
inline constexpr std::string_view kUnfinished = ".part";

// Writes a file that is under its name only when it is whole. Errors: unwritable_file.
Result<void> write_whole_file(const std::filesystem::path& path, const std::string& bytes);

// Makes a folder, and those above it, where there is none. Errors: unwritable_file.
Result<void> make_folder(const std::filesystem::path& path);

}  // namespace slipway::api
