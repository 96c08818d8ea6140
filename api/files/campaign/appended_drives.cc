#include "api/files/campaign/appended_drives.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>
#include <set>
#include <utility>

#include "api/files/campaign/drive_campaign_file.h"
#include "api/files/campaign/drive_campaign_source.h"
#include "api/files/campaign/drive_series_csv.h"
#include "api/json/faults.h"
#include "core/digest.h"

namespace slipway::api {
namespace {

constexpr std::size_t kMaxRows = 200'000;          // of all drives of a request
constexpr std::size_t kMaxCsvBytes = 16UL << 20U;  // of one drive

class AppendedReader {
 public:
  explicit AppendedReader(const gap::DriveCampaign& setting) : campaign_(setting) {
    campaign_.drives.clear();
    campaign_.notes.clear();
    digest_ = fnv1a(setting.fingerprint);
    for (const sim::WheelModel& wheel : setting.rover->wheels) wheels_.push_back(wheel.name);
    for (const gap::CampaignTerrain& terrain : setting.terrains) terrains_.push_back(terrain.name);
  }

  gap::DriveCampaign read(json::ObjectReader& reader) {
    for (const json::Element& element : reader.list("drives", json::kRequired, {1, kMaxAppendedDrives}))
      read_drive(reader.object(element));
    for (std::size_t d = 0; d < campaign_.drives.size(); ++d)
      if (const auto& other = campaign_.drives[d].repeat_of;
          other && (!first_with_.contains(*other) || *other == campaign_.drives[d].id))
        reader.faults().push_back(
            {fmt::format("/drives/{}/repeat_of", d),
             fmt::format("repeat_of = {}, there is no other drive of this id", in_quotes(*other))});
    if (!passed_over_.empty())
      campaign_.notes.push_back(fmt::format("columns that the format does not have were passed over: {}",
                                            fmt::join(passed_over_, ", ")));
    for (const std::string& words : missing_noise(campaign_.measurement_std, campaign_.drives))
      reader.faults().push_back({"/drives", "measurement_std of the reference: " + words});
    campaign_.fingerprint = fmt::format("{:016x}", digest_);
    if (reader.faults().empty()) take_as_recorded(campaign_);
    return std::move(campaign_);
  }

 private:
  void read_drive(json::ObjectReader object) {
    gap::MeasuredDriveSeries& drive = campaign_.drives.emplace_back();
    if (!object.is_object()) return;
    const std::size_t index = campaign_.drives.size() - 1;
    if (object.text("id", json::kRequired, {}, drive.id))
      if (const auto [first, is_new] = first_with_.emplace(drive.id, index); !is_new)
        object.fault("id",
                     fmt::format("id = {} is that of drive {} of the watch as well, counted from its first",
                                 in_quotes(drive.id), first->second + 1));
    json::read_drive_facts(object, campaign_.rover.get(), terrains_, drive);
    std::string csv;
    if (object.text("csv", json::kRequired, {.most = kMaxCsvBytes}, csv)) read_rows(object, csv, drive);
    object.refuse_unknown();
    const sim::DriveCommand& command = drive.command;
    digest_ = fnv1a(
        fmt::format("{}\n{}\n{} {} {} {} {} {} {}\n{}\n", drive.id, terrains_[drive.terrain],
                    command.speed_m_s, command.curvature_1_m, command.turn_rate_rad_s, command.crab_rad,
                    command.turn_in_place, drive.duration_s, drive.final_only, drive.repeat_of.value_or("")),
        digest_);
    digest_ = fnv1a(csv, digest_);
  }

  void read_rows(json::ObjectReader& object, const std::string& csv, gap::MeasuredDriveSeries& drive) {
    DriveSeries series = read_drive_series(csv, drive.id, wheels_, kMaxRows - rows_);
    rows_ += series.samples.size();
    for (const Fault& fault : series.faults) object.fault("csv", fault.message);
    passed_over_.merge(series.passed_over);
    drive.samples = std::move(series.samples);
    take_ends_of_final_only(campaign_, drive);
  }

  gap::DriveCampaign campaign_;
  std::uint64_t digest_ = 0;
  std::vector<std::string> wheels_, terrains_;
  std::map<std::string, std::size_t> first_with_;
  std::set<std::string> passed_over_;
  std::size_t rows_ = 0;
};

}  // namespace

gap::DriveCampaign read_appended_drives(json::ObjectReader& reader, const gap::DriveCampaign& setting) {
  return AppendedReader(setting).read(reader);
}

}  // namespace slipway::api
