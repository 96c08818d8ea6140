#pragma once

#include <gdal_priv.h>

#include <cstdint>
#include <filesystem>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <tuple>
#include <vector>

#include "dem/gdal_heights.h"
#include "dem/grid_geometry.h"

namespace slipway::dem {

// Reads a raster of plain Float32 metres in square blocks, as the import makes them, for the pictures of
// several threads at once: each thread has an opening of the file to itself (a GDAL dataset is for one thread
// at a time), and a block is decoded once for all who look at it as long as it is kept. Thread-safe.
class GdalBlockReader {
 public:
  static constexpr std::size_t kMaxBytes = 64'000'000;  // of decoded blocks that are kept

  // Nothing where the cells are stored in another way; they are then read through the dataset. dataset: an
  // opening of the file at `path`, which stays the caller's and is looked at only here.
  static std::unique_ptr<GdalBlockReader> of(const std::filesystem::path& path, GDALDataset& dataset,
                                             const HeightEncoding& encoding,
                                             std::size_t max_bytes = kMaxBytes);
  ~GdalBlockReader();

  // The window's heights (m), row by row, and which of its cells have one. overview: its number in the file,
  // or kItself. False where the file can't be read, or is no longer that which was opened first.
  static constexpr int kItself = -1;
  bool read(int overview, const CellWindow& window, float* heights_m, std::uint8_t* valid);

 private:
  struct Block;
  class Opening;
  using Key = std::tuple<int, int, int>;  // overview, row and column of the block
  using Kept = std::list<std::pair<Key, std::shared_ptr<Block>>>;
  // By which a file is known again: device, number, size, time of its last change.
  using FileStamp = std::tuple<std::uint64_t, std::uint64_t, std::int64_t, std::int64_t, std::int64_t>;

  GdalBlockReader(std::filesystem::path path, const HeightEncoding& encoding, int side, std::size_t most);

  static FileStamp stamp_of(const std::filesystem::path& path);
  std::shared_ptr<Block> block(const Key& key);
  void forget(const Key& key);
  std::vector<float> decode(const Key& key);

  const std::filesystem::path path_;
  const HeightEncoding encoding_;
  const int side_;               // of a block, cells
  const std::size_t most_kept_;  // blocks
  const FileStamp stamp_;
  std::mutex mutex_;
  Kept kept_;  // the last asked for first
  std::map<Key, Kept::iterator> places_;
  std::vector<GDALDatasetUniquePtr> idle_;  // openings that nobody uses
};

}  // namespace slipway::dem
