#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>

#include "core/result.h"

namespace slipway::api {

// Where a machine keeps copies of what it has read, so that it is not fetched again.
struct ArtefactCache {
  std::filesystem::path folder = {};               // empty: no copies; a folder of this machine alone
  std::int64_t max_bytes = std::int64_t{2} << 30;  // of all copies: those not used for longest go
};

// Bytes under the name of their SHA-256, in a folder that machines share (NFS, Lustre, GPFS). A file is there
// under its name only when it is whole and on the disk, never changes, and is looked at again whenever it is
// read. Several processes may use it at once. Thread-safe.
class ArtefactFolder {
 public:
  // Makes the folders where there are none. Errors: unwritable_file.
  static Result<std::shared_ptr<ArtefactFolder>> open(const std::filesystem::path& root,
                                                      ArtefactCache cache = {});

  // The name of the bytes, once they survive a loss of power. Errors: storage, storage_full.
  Result<std::string> put(std::string_view bytes);
  // Errors: storage where there are none or they can't be read; damaged_store where they are not what was
  // put.
  Result<std::string> get(const std::string& name);
  // Removes what nobody has put since then; returns how many. Copies in caches go by themselves.
  int forget_before(std::int64_t time_ms);

 private:
  ArtefactFolder(std::filesystem::path root, ArtefactCache cache)
      : root_(std::move(root)), cache_(std::move(cache)) {}
  std::filesystem::path place_of(const std::string& name) const;
  void keep_copy(const std::string& name, const std::string& bytes);

  const std::filesystem::path root_;
  const ArtefactCache cache_;
  std::mutex cache_mutex_;
};

}  // namespace slipway::api
