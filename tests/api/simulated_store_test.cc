// The store of jobs in a file, on a disk that fails.
#include <gtest/gtest.h>
#include <malloc.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <sstream>
#include <string>
#include <utility>

#include "api/jobs/sqlite_job_store.h"
#include "simulated_disk.h"
#include "simulated_jobs.h"
#include "small_world.h"

namespace slipway::api {
namespace {

class DiskWorld final : public testing::SimulatedWorld {
 public:
  DiskWorld(std::uint64_t seed, std::string path) : path_(std::move(path)), disk_(seed) {}
  int begin_process() override { return disk_.begin_process(); }
  Result<std::unique_ptr<JobStore>> open(int /*process*/, bool is_service) override {
    return open_sqlite_job_store(path_, is_service ? StoreCheck::kWhole : StoreCheck::kSchema);
  }
  void arm(int mishap, int after) override {
    disk_.arm(static_cast<testing::SimulatedDisk::Mishap>(1 + mishap), after);
  }
  void rest() override { static_cast<void>(disk_.rest()); }
  bool is_dead(int process) const override { return disk_.is_dead(process); }
  void die(int process) override { disk_.die(process); }
  void lose_power() override { disk_.lose_power(); }
  bool rot() override {
    disk_.rot(path_);
    return true;
  }

 private:
  std::string path_;
  testing::SimulatedDisk disk_;
};

// The marker and the reserve are beside SQLite's files, on the real disk.
class SimulatedStore : public ::testing::TestWithParam<int> {
 protected:
  void SetUp() override {
    constexpr int kNever =
        1 << 30;  // a third of the time would go to giving memory back and getting it again
    ::mallopt(M_TRIM_THRESHOLD, kNever);
    ::mallopt(M_MMAP_THRESHOLD, kNever);
  }
  std::string found(std::uint64_t seed) {
    testing::write_file(path_, "here is a store");
    DiskWorld world(seed, path_.string());
    return testing::simulate_jobs(seed, world);
  }
  testing::ScratchFolder folder_;
  std::filesystem::path path_ = folder_.path() / "jobs.sqlite";
};

// 10,000 seeds, in parts that run side by side; SLIPWAY_SEEDS="FIRST COUNT" runs others in each.
TEST_P(SimulatedStore, KeepsItsPromisesWhateverHappens) {
  constexpr std::uint64_t kSeeds = 10'000, kParts = 4;
  std::uint64_t first = static_cast<std::uint64_t>(GetParam()) * (kSeeds / kParts), count = kSeeds / kParts;
  if (const char* const given = std::getenv("SLIPWAY_SEEDS")) std::istringstream(given) >> first >> count;
  for (std::uint64_t seed = first; seed < first + count; ++seed) ASSERT_EQ(found(seed), "");
}
INSTANTIATE_TEST_SUITE_P(All, SimulatedStore, ::testing::Range(0, 4));

}  // namespace
}  // namespace slipway::api
