#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <random>
#include <string>
#include <vector>

namespace slipway::api::testing {

struct OpenFile;

// What SimulatedDisk holds under one name.
struct DiskFile {
  // A write, or a new length, that was not synced.
  struct Change {
    std::size_t at = 0;
    std::string bytes;
    bool cuts = false;  // the file ends at `at`
  };

  void change(Change change);
  void sync();
  // What is left of it when the power is gone.
  void lose(std::mt19937_64& chance);

  std::string now, durable;
  std::vector<Change> unsynced;
  using Pages = std::vector<std::unique_ptr<std::array<char, 32768>>>;
  void forget_shared_memory();
  Pages shared_memory;  // of processes that live
  Pages forgotten;      // to which dead ones still point
  std::vector<OpenFile*> open;
};

}  // namespace slipway::api::testing
