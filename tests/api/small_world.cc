#include "small_world.h"

#include <unistd.h>

#include <atomic>
#include <fstream>
#include <iterator>
#include <memory>
#include <stdexcept>

namespace slipway::api::testing {
namespace fs = std::filesystem;

ScratchFolder::ScratchFolder() {
  static std::atomic<int> count{0};
  path_ = fs::temp_directory_path() /
          ("slipway_api_" + std::to_string(::getpid()) + "_" + std::to_string(++count));
  fs::remove_all(path_);
  fs::create_directories(path_);
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

void copy_small_world(const fs::path& to) {
  fs::copy(fs::path(SLIPWAY_DATA_FOLDER) / "rovers", to / "rovers", fs::copy_options::recursive);
  fs::copy(fs::path(SLIPWAY_DATA_FOLDER) / "soils", to / "soils", fs::copy_options::recursive);
  fs::copy(fs::path(SLIPWAY_API_TEST_FOLDER) / "small_world" / "terrains", to / "terrains",
           fs::copy_options::recursive);
}

const Service& small_world() {
  static const ScratchFolder folder;
  static const std::unique_ptr<Service> service = [] {
    copy_small_world(folder.path());
    auto opened = Service::open({.data = folder.path(), .threads = 2});
    if (!opened) throw std::runtime_error(opened.error().detail);
    return std::move(*opened);
  }();
  return *service;
}

void write_file(const fs::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

std::string file_bytes(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw std::runtime_error("no file " + path.string());
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

std::string example(const std::string& name) {
  return file_bytes(fs::path(SLIPWAY_API_TEST_FOLDER) / "requests" / name);
}

}  // namespace slipway::api::testing
