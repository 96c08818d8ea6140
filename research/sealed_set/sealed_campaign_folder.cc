#include "research/sealed_set/sealed_campaign_folder.h"

#include <fmt/format.h>

#include <map>
#include <mutex>
#include <system_error>
#include <utility>

#include "api/files/drive_table/campaign_documents.h"
#include "api/files/file_lock.h"
#include "api/files/terrain_site.h"
#include "api/files/whole_file.h"
#include "api/json/writer.h"
#include "campaign/drive_csv.h"
#include "campaign/run_campaign.h"
#include "core/version.h"
#include "dem/geotiff.h"

namespace slipway::api {
namespace {

namespace fs = std::filesystem;
using campaign::SealedCampaign;

std::string made_document(const SealedSet& folder) {
  json::Writer w;
  w.begin_object().text("format", "sealed-campaigns/1").text("set", folder.set);
  w.whole("seed", static_cast<std::int64_t>(folder.seed)).text("version", version()).end_object();
  return w.take() + "\n";
}

// Empty, or begun by the same call.
Result<void> claim(const SealedSet& folder) {
  const fs::path mark = folder.path / "made.json";
  std::error_code error;
  if (fs::is_empty(folder.path, error)) return write_whole_file(mark, made_document(folder));
  const auto bytes = fs::exists(mark, error) ? read_data_file(mark) : Result<std::string>(std::string());
  if (bytes && *bytes == made_document(folder)) return {};
  return fail(ErrorCode::kConflict,
              fmt::format("{} holds something else than campaigns of set {} and seed {} of this version; "
                          "give another folder",
                          folder.path.string(), folder.set, folder.seed));
}

bool is_kept(const campaign::MadeDrive& made) {
  constexpr std::size_t kMinRows = 5;
  if (!made.drive || made.readings.size() < kMinRows) return false;
  return made.drive->end != sim::DriveEnd::kSlid && made.drive->end != sim::DriveEnd::kTipped;
}

Result<std::size_t> make_campaign(const fs::path& folder, const SealedCampaign& sealed, std::size_t threads,
                                  Progress& progress) {
  if (const auto made = make_folder(folder); !made) return fail(made.error());
  const std::vector<campaign::TableDrive> drives = campaign::expand(sealed.driven);
  std::map<std::string, campaign::DriveRecord> records;
  std::mutex mutex;
  const auto take = [&](const campaign::TableDrive& drive, const campaign::MadeDrive& made) -> Result<void> {
    if (!is_kept(made)) return {};
    campaign::CsvOptions options = sealed.recorded;
    options.motor_temp_c = campaign::motor_temp_c(sealed.believed, sealed.believed.entries[drive.entry]);
    const std::string file = drive.id + ".csv";
    const auto written =
        write_whole_file(folder / file, campaign::drive_csv(*sealed.believed.rover, made.readings, options));
    if (!written) return written;
    const std::lock_guard lock(mutex);
    records.emplace(drive.id, campaign::record_of(sealed.driven, drive, made, "", {file}));
    return {};
  };
  if (const auto ran = campaign::run_campaign(sealed.driven, drives, {.threads = threads}, take, progress);
      !ran)
    return fail(ran.error());
  for (const campaign::TableTerrain& terrain : sealed.believed.terrains) {
    const auto raster = dem::encode_geotiff(*terrain.ground, terrain.crs_wkt);
    if (!raster) return fail(raster.error());
    if (const auto written = write_whole_file(folder / (terrain.name + ".tif"), *raster); !written)
      return fail(written.error());
  }
  const auto written =
      write_whole_file(folder / "campaign.json", json::campaign_document(sealed.believed, drives, records));
  if (!written) return fail(written.error());
  return records.size();
}

std::string answers_document(std::span<const SealedCampaign> campaigns) {
  json::Writer w;
  w.begin_object();
  for (const SealedCampaign& sealed : campaigns) {
    w.key(sealed.name).begin_object().text("fidelity", "L0").text("kind", sealed.kind);
    w.exact("size", sealed.size).text("nominal", sealed.nominal).text("soil", sealed.soil);
    w.key("effects").begin_object();
    for (const sim::EffectSetting& effect : sealed.hidden) {
      w.key(effect.name).begin_object();
      for (const auto& [name, value] : effect.parameters) w.exact(name, value);
      w.end_object();
    }
    w.end_object();
    if (sealed.place) {
      w.key("place").begin_object().exact("x_m", sealed.place->x_m).exact("y_m", sealed.place->y_m);
      w.exact("radius_m", sealed.place->radius_m).end_object();
    }
    std::vector<std::string> missing;
    if (!sealed.recorded.sinkage) missing.emplace_back("sinkage");
    if (!sealed.believed.entries[0].motor_temp_c) missing.emplace_back("motor temperature");
    w.texts("missing", missing).end_object();
  }
  w.end_object();
  return w.take() + "\n";
}

}  // namespace

Result<void> make_sealed_folder(const SealedSet& folder, std::span<const campaign::SealedCampaign> campaigns,
                                std::size_t threads, const SealedTaker& taker, Progress& progress) {
  if (const auto made = make_folder(folder.path); !made) return made;
  const auto lock = FileLock::take(folder.path);
  if (!lock) return fail(lock.error());
  if (const auto claimed = claim(folder); !claimed) return claimed;
  std::error_code error;
  std::size_t count = 0;
  for (const SealedCampaign& sealed : campaigns) {
    const fs::path own = folder.path / sealed.name;
    ++count;
    if (fs::exists(own / "campaign.json", error)) continue;
    const auto drives = make_campaign(own, sealed, threads, progress);
    if (!drives) return fail(drives.error());
    taker(sealed.name, *drives, count);
  }
  return write_whole_file(folder.path / "answers.json", answers_document(campaigns));
}

}  // namespace slipway::api
