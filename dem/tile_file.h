#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "core/file_descriptor.h"
#include "core/progress.h"
#include "dem/raster_tiles.h"

namespace slipway::dem {

// The tiles of a raster in one file, to which each is added when it is done: whatever ends the process, those
// that were added are there when the file is opened again. A tile that was cut off is not.
class TileFile final : public TileStore {
 public:
  // Opens the file, or makes it. `key` says what the tiles are of: a file of another key, or of tiles of
  // another size, is begun anew. Errors: unwritable_file; cancelled, with the file as it was.
  static Result<std::unique_ptr<TileFile>> open(const std::filesystem::path& path, const std::string& key,
                                                std::size_t tile_bytes, const Progress& progress);

  bool has(const TileIndex& tile) const override;
  Result<void> write(const TileIndex& tile, const std::vector<std::uint8_t>& bytes) override;
  Result<std::vector<std::uint8_t>> read(const TileIndex& tile) const override;
  std::size_t tiles() const { return places_.size(); }

 private:
  TileFile(std::filesystem::path path, FileDescriptor file, std::size_t tile_bytes)
      : path_(std::move(path)), file_(std::move(file)), tile_bytes_(tile_bytes) {}
  // Finds the whole tiles of a file that has this head; the end of the last one.
  void find_tiles(std::uint64_t from, std::uint64_t size, const Progress& progress);
  Result<void> put(std::uint64_t place, const void* bytes, std::size_t count) const;
  bool get(std::uint64_t place, void* bytes, std::size_t count) const;

  std::filesystem::path path_;
  FileDescriptor file_;
  std::size_t tile_bytes_;
  mutable std::mutex mutex_;
  std::map<TileIndex, std::uint64_t> places_;  // of the bytes
  std::uint64_t end_ = 0;
};

}  // namespace slipway::dem
