#pragma once

#include <filesystem>
#include <string>

#include "api/service.h"

namespace slipway::api::testing {

// A folder of its own, gone at the end.
class ScratchFolder {
 public:
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

// A data folder with the rovers and soils that ship and the terrains of tests/api/small_world.
void copy_small_world(const std::filesystem::path& to);

// A service over the small world: opened once, shared by all tests of the process.
const Service& small_world();

void write_file(const std::filesystem::path& path, const std::string& bytes);
std::string file_bytes(const std::filesystem::path& path);
// tests/api/requests/<name>
std::string example(const std::string& name);

}  // namespace slipway::api::testing
