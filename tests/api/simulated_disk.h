#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <random>
#include <set>
#include <string>

#include "simulated_disk_file.h"

namespace slipway::api::testing {

// SQLite's disk while this lives: files in memory, whose every call can fail, be the last of its process, or
// the last before a loss of power. One thread alone; all that is random follows from the seed.
class SimulatedDisk {
 public:
  explicit SimulatedDisk(std::uint64_t seed);
  ~SimulatedDisk();
  SimulatedDisk(const SimulatedDisk&) = delete;
  SimulatedDisk& operator=(const SimulatedDisk&) = delete;

  enum class Mishap {
    kNone,
    kError,  // this call alone
    kFull,   // this and the writes after it, until rest()
    kDeath,  // of the process that calls
    kPower,  // of all, and what was not synced is lost, kept or torn, each write by itself
  };
  // What befalls the call after so many others.
  void arm(Mishap fault, int after);
  // No more faults. What has struck since arm(); kNone: nothing.
  Mishap rest();

  // Who opens files from now on.
  int begin_process() { return process_ = ++last_process_; }
  bool is_dead(int process) const { return dead_.contains(process); }
  void die(int process);
  void lose_power();
  // Changes a byte of the file, as a bad disk does.
  void rot(const std::string& path);

  // Of SimulatedDiskFile. False: the call fails.
  bool may_call(int process, bool writes, bool& full);
  std::shared_ptr<DiskFile> find(const std::string& path, bool make);
  bool exists(const std::string& path) const { return files_.contains(path); }
  void remove(const std::string& path) { files_.erase(path); }
  int process() const { return process_; }
  std::mt19937_64& chance() { return chance_; }

 private:
  std::mt19937_64 chance_;
  std::map<std::string, std::shared_ptr<DiskFile>> files_;
  Mishap armed_ = Mishap::kNone, struck_ = Mishap::kNone;
  int calls_left_ = 0;
  int process_ = 0, last_process_ = 0;
  std::set<int> dead_;
};

}  // namespace slipway::api::testing
