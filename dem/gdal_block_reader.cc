#include "dem/gdal_block_reader.h"

#include <sys/stat.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "dem/gdal_raster.h"

namespace slipway::dem {
namespace {

constexpr int kLeastSide = 64, kMostSide = 1024;  // of blocks that are worth keeping

GDALRasterBand& band_of(GDALDataset& dataset, int overview) {
  GDALRasterBand& band = *dataset.GetRasterBand(1);
  return overview == GdalBlockReader::kItself ? band : *band.GetOverview(overview);
}

bool has_blocks_of(int side, GDALRasterBand& band) {
  int columns = 0, rows = 0;
  band.GetBlockSize(&columns, &rows);
  return columns == side && rows == side;
}

}  // namespace

struct GdalBlockReader::Block {
  std::once_flag decoded;
  std::vector<float> heights_m;  // side by side, NaN where there is none; empty where it can't be read
};

// An opening of the file for one thread, which goes back to the others when it is done with.
class GdalBlockReader::Opening {
 public:
  explicit Opening(GdalBlockReader& reader) : reader_(reader) {
    {
      const std::lock_guard lock(reader_.mutex_);
      if (!reader_.idle_.empty()) {
        dataset_ = std::move(reader_.idle_.back());
        reader_.idle_.pop_back();
        return;
      }
    }
    const GdalSession session(reader_.path_);
    auto opened = open_raster(reader_.path_, session);
    if (opened && stamp_of(reader_.path_) == reader_.stamp_) dataset_ = std::move(*opened);
  }
  ~Opening() {
    if (!dataset_) return;
    const std::lock_guard lock(reader_.mutex_);
    reader_.idle_.push_back(std::move(dataset_));
  }
  Opening(const Opening&) = delete;
  Opening& operator=(const Opening&) = delete;

  GDALDataset* dataset() const { return dataset_.get(); }  // nullptr where the file is gone or another

 private:
  GdalBlockReader& reader_;
  GDALDatasetUniquePtr dataset_;
};

GdalBlockReader::GdalBlockReader(std::filesystem::path path, const HeightEncoding& encoding, int side,
                                 std::size_t most)
    : path_(std::move(path)), encoding_(encoding), side_(side), most_kept_(most), stamp_(stamp_of(path_)) {}

GdalBlockReader::~GdalBlockReader() = default;

std::unique_ptr<GdalBlockReader> GdalBlockReader::of(const std::filesystem::path& path, GDALDataset& dataset,
                                                     const HeightEncoding& encoding, std::size_t max_bytes) {
  const bool is_plain = encoding.is_float32 && !encoding.has_mask && encoding.alpha_band == 0 &&
                        !encoding.is_sparse && encoding.scale == 1.0 && encoding.offset_m == 0.0;
  GDALRasterBand& band = *dataset.GetRasterBand(1);
  int side = 0, rows = 0;
  band.GetBlockSize(&side, &rows);
  bool is_square = side >= kLeastSide && side <= kMostSide;
  for (int overview = kItself; overview < band.GetOverviewCount(); ++overview)
    is_square = is_square && has_blocks_of(side, band_of(dataset, overview));
  if (!is_plain || !is_square) return nullptr;
  const std::size_t block_bytes = static_cast<std::size_t>(side) * static_cast<std::size_t>(side) * 4;
  return std::unique_ptr<GdalBlockReader>(
      new GdalBlockReader(path, encoding, side, std::max<std::size_t>(1, max_bytes / block_bytes)));
}

GdalBlockReader::FileStamp GdalBlockReader::stamp_of(const std::filesystem::path& path) {
  struct stat file {};
  if (::stat(path.c_str(), &file) != 0) return {};
  return {file.st_dev, file.st_ino, file.st_size, file.st_mtim.tv_sec, file.st_mtim.tv_nsec};
}

std::vector<float> GdalBlockReader::decode(const Key& key) {
  const Opening opening(*this);
  if (opening.dataset() == nullptr) return {};
  const GdalSession session(path_);
  const auto [overview, row, column] = key;
  std::vector<float> heights(static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_));
  // Past GDAL's own store of blocks: this one is enough.
  if (band_of(*opening.dataset(), overview).ReadBlock(column, row, heights.data()) != CE_None) return {};
  for (float& height : heights)
    if (!encoding_.is_height(static_cast<double>(height))) height = std::numeric_limits<float>::quiet_NaN();
  return heights;
}

std::shared_ptr<GdalBlockReader::Block> GdalBlockReader::block(const Key& key) {
  std::shared_ptr<Block> found;
  {
    const std::lock_guard lock(mutex_);
    if (const auto place = places_.find(key); place != places_.end()) {
      kept_.splice(kept_.begin(), kept_, place->second);
    } else {
      kept_.emplace_front(key, std::make_shared<Block>());
      places_[key] = kept_.begin();
      if (kept_.size() > most_kept_) {
        places_.erase(kept_.back().first);
        kept_.pop_back();
      }
    }
    found = kept_.front().second;
  }
  // Who wants the block meanwhile waits here for the first one.
  std::call_once(found->decoded, [&] { found->heights_m = decode(key); });
  if (found->heights_m.empty()) forget(key);
  return found;
}

// What could not be read is tried again when it is next asked for.
void GdalBlockReader::forget(const Key& key) {
  const std::lock_guard lock(mutex_);
  const auto place = places_.find(key);
  if (place == places_.end() || !place->second->second->heights_m.empty()) return;
  kept_.erase(place->second);
  places_.erase(place);
}

bool GdalBlockReader::read(int overview, const CellWindow& window, float* heights_m, std::uint8_t* valid) {
  const int last_row = window.row + window.rows, last_column = window.column + window.columns;
  for (int block_row = window.row / side_; block_row * side_ < last_row; ++block_row) {
    for (int block_column = window.column / side_; block_column * side_ < last_column; ++block_column) {
      const auto held = block({overview, block_row, block_column});
      if (held->heights_m.empty()) return false;
      const int left = std::max(window.column, block_column * side_);
      const int right = std::min(last_column, (block_column + 1) * side_);
      const int top = std::max(window.row, block_row * side_);
      for (int row = top; row < std::min(last_row, (block_row + 1) * side_); ++row) {
        const float* const from =
            held->heights_m.data() +
            static_cast<std::size_t>(row - block_row * side_) * static_cast<std::size_t>(side_) +
            (left - block_column * side_);
        const std::size_t to =
            static_cast<std::size_t>(row - window.row) * static_cast<std::size_t>(window.columns) +
            static_cast<std::size_t>(left - window.column);
        for (int k = 0; k < right - left; ++k) {
          const bool has_height = from[k] == from[k];
          valid[to + static_cast<std::size_t>(k)] = has_height ? 1 : 0;
          heights_m[to + static_cast<std::size_t>(k)] = has_height ? from[k] : 0.0F;
        }
      }
    }
  }
  return true;
}

}  // namespace slipway::dem
