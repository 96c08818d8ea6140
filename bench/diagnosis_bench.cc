#include <benchmark/benchmark.h>

#include <filesystem>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

#include "api/files/campaign/drive_campaign_source.h"
#include "gap/diagnosis/diagnosis.h"
#include "gap/diagnosis/drive_watch.h"

// The practice campaigns: 44 drives of a minute each, without an effect (p01) and with slip sinkage (p03).
namespace slipway::gap {
namespace {

DriveCampaign practice(const char* name) {
  auto campaign = api::load_drive_campaign(
      std::filesystem::path(SLIPWAY_SOURCE_DIR) / "data/gap-practice" / name, api::Catalogue{});
  if (!campaign) throw std::runtime_error(campaign.error().detail);
  return std::move(*campaign);
}

// So many drives: the campaign's, and again under other names.
DriveCampaign with_drives(const DriveCampaign& campaign, std::size_t count) {
  std::vector<std::size_t> drives(std::min(count, campaign.drives.size()));
  std::iota(drives.begin(), drives.end(), std::size_t{0});
  DriveCampaign some = subset_of(campaign, drives);
  for (std::size_t d = some.drives.size(); d < count; ++d) {
    some.drives.push_back(campaign.drives[d % campaign.drives.size()]);
    some.drives.back().id += "-" + std::to_string(d);
  }
  return some;
}

void diagnose_drives(benchmark::State& state) {
  const DriveCampaign campaign = with_drives(practice("p03"), static_cast<std::size_t>(state.range(0)));
  NoProgress progress;
  for (auto _ : state) benchmark::DoNotOptimize(diagnose(campaign, {}, progress));
}
// What it learns from the 44 reference drives included.
void diagnose_drives_with_reference(benchmark::State& state) {
  const DriveCampaign reference = practice("p01");
  const DriveCampaign campaign = with_drives(practice("p03"), static_cast<std::size_t>(state.range(0)));
  NoProgress progress;
  for (auto _ : state) benchmark::DoNotOptimize(diagnose_since(reference, campaign, {}, progress));
}
void watch_drives_since_reference(benchmark::State& state) {
  const DriveCampaign reference = practice("p01");
  const DriveCampaign campaign = with_drives(practice("p02"), static_cast<std::size_t>(state.range(0)));
  WatchOptions watch;
  watch.diagnose = false;
  NoProgress progress;
  for (auto _ : state) benchmark::DoNotOptimize(watch_drives(campaign, &reference, watch, {}, progress));
}
BENCHMARK(diagnose_drives)
    ->Arg(20)
    ->Arg(40)
    ->Arg(80)
    ->Arg(160)
    ->UseRealTime()
    ->Iterations(1)
    ->Unit(benchmark::kSecond);
BENCHMARK(diagnose_drives_with_reference)->Arg(40)->UseRealTime()->Iterations(1)->Unit(benchmark::kSecond);
BENCHMARK(watch_drives_since_reference)->Arg(40)->UseRealTime()->Iterations(1)->Unit(benchmark::kSecond);

}  // namespace
}  // namespace slipway::gap
