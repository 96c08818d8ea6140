#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>

#include "core/progress.h"
#include "core/result.h"

namespace slipway::api {

struct UnpackLimits {
  std::size_t max_files = 20'000;
  std::size_t max_folders = 1000;
  std::int64_t max_bytes = std::int64_t{8} << 30;  // of all files, unpacked
  std::size_t max_depth = 8;                       // folders above a file
  std::size_t max_name = 100;                      // bytes of each part of a path
};

// Writes the files of an archive (tar, also gzipped, or zip) into a folder that is empty. Nothing but plain
// files and folders with plain relative paths is taken: a link, a device, "..", an absolute path, a name
// twice are faults, all of them together at /upload. Errors: invalid_request; storage, storage_full;
// cancelled.
Result<void> unpack(const std::filesystem::path& archive, const std::filesystem::path& into,
                    const UnpackLimits& limits, Progress& progress);

}  // namespace slipway::api
