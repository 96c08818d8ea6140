// What clients send: terrains beside those that ship, and drive campaigns.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>

#include "api/files/campaign/drive_campaign_source.h"
#include "api/files/whole_file.h"
#include "api/json/faults.h"
#include "api/json/parse.h"
#include "api/json/strict_reader.h"
#include "api/requests/plan_request.h"
#include "api/service.h"

namespace slipway::api {
namespace {

namespace fs = std::filesystem;

const json::TextRule kUploadId{.most = 64, .is_name = true};

// The finished folders under this one, and when each was made.
std::string folders_in(const fs::path& folder) {
  std::vector<std::string> entries;
  std::error_code error, gone;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (is_unfinished(entry.path())) continue;
    const auto written = fs::last_write_time(entry.path(), gone);
    if (!gone)
      entries.push_back(
          fmt::format("{} {}\n", entry.path().filename().string(), written.time_since_epoch().count()));
  }
  std::sort(entries.begin(), entries.end());
  std::string all;
  for (const std::string& entry : entries) all += entry;
  return all;
}

Error no_uploads() {
  return {
      ErrorCode::kInvalidRequest, "this service takes no uploads: its operator starts it with --uploads", {}};
}

// An id that the request names must be that of a file.
void check_upload(const UploadFolder& uploads, const std::string& id, const std::string& pointer,
                  std::vector<Fault>& faults) {
  if (id.empty() || has_fault_under(faults, pointer) || uploads.find(id)) return;
  faults.push_back(
      {pointer, fmt::format("there is no upload {}: send the file to /v1/uploads first", in_quotes(id))});
}

}  // namespace

std::shared_ptr<const Catalogue> Service::catalogue() const {
  if (!options_.uploads) return catalogue_;
  const std::string folders = folders_in(options_.uploads->terrains());
  const std::lock_guard lock(sent_mutex_);
  if (!with_sent_ || folders != sent_terrains_) {
    with_sent_ =
        folders.empty()
            ? catalogue_
            : std::make_shared<const Catalogue>(with_terrains(*catalogue_, options_.uploads->root()));
    sent_terrains_ = folders;
  }
  return with_sent_;
}

bool Service::has_campaign(const std::string& name) const {
  return std::find(campaigns_.begin(), campaigns_.end(), name) != campaigns_.end() ||
         (options_.uploads && uploaded_campaign(*options_.uploads, name));
}

void Service::check_campaign(const std::string& name, const std::string& pointer,
                             std::vector<Fault>& faults) const {
  if (!has_fault_under(faults, pointer) && !has_campaign(name))
    faults.push_back({pointer, unknown_name("campaign", name, campaigns_)});
}

Result<gap::DriveCampaign> Service::drives_of(const std::string& name) const {
  for (const ShippedCampaign& campaign : shipped_)
    if (campaign.name == name) return load_drive_campaign(campaign.folder, *catalogue());
  if (has_campaign(name)) return load_uploaded_campaign(*options_.uploads, name, *catalogue());
  return fail(ErrorCode::kInvalidRequest, unknown_name("campaign", name, campaigns_),
              {{"/campaign", unknown_name("campaign", name, campaigns_)}});
}

Result<CampaignOrder> Service::read_campaign(std::string_view bytes) const {
  const auto document = json::parse(bytes, {.bytes = RequestLimits::kBodyBytes});
  if (!document) return fail(document.error());
  if (!options_.uploads) return fail(no_uploads());
  std::vector<Fault> faults;
  CampaignOrder order;
  json::ObjectReader reader(*document, "", faults);
  if (reader.is_object()) {
    reader.text("upload", json::kOptional, kUploadId, order.upload);
    reader.text("follows", json::kOptional, kUploadId, order.follows);
    const json::JsonValue* const drives = reader.member("drives", json::kOptional);
    if (drives != nullptr) order.drives = *drives;
    reader.refuse_unknown();
    if (document->find("upload") == nullptr && document->find("follows") == nullptr)
      reader.fault("upload", "must be the id of an archive, or \"follows\" the name of a campaign");
    if (document->find("upload") != nullptr && document->find("follows") != nullptr)
      reader.fault("follows", "can't be given with \"upload\"");
    if ((drives != nullptr) != (document->find("follows") != nullptr))
      reader.fault("drives", "must be given where \"follows\" is, and only there");
    check_upload(*options_.uploads, order.upload, "/upload", faults);
    if (!order.follows.empty() && !has_fault_under(faults, "/follows") &&
        !uploaded_campaign(*options_.uploads, order.follows))
      faults.push_back(
          {"/follows", fmt::format("there is no campaign {} that was sent", in_quotes(order.follows))});
  }
  if (!faults.empty()) return fail(ErrorCode::kInvalidRequest, summary_of(faults), faults);
  return order;
}

Result<TerrainOrder> Service::read_terrain(std::string_view bytes) const {
  const auto document = json::parse(bytes, {.bytes = RequestLimits::kBodyBytes});
  if (!document) return fail(document.error());
  if (!options_.uploads) return fail(no_uploads());
  std::vector<Fault> faults;
  TerrainOrder order;
  TerrainImport& import = order.import;
  json::ObjectReader reader(*document, "", faults);
  if (reader.is_object()) {
    constexpr std::size_t kMaxWords = 2000;
    const json::TextRule words{.most = kMaxWords, .may_be_empty = true};
    reader.text("name", json::kRequired, {.most = 64, .is_name = true}, import.name);
    reader.text("elevation", json::kRequired, kUploadId, order.elevation);
    reader.text("soil", json::kOptional, kUploadId, order.soil);
    reader.text("legend", json::kOptional, kUploadId, order.legend);
    reader.text("crs", json::kOptional, {.most = kMaxWords}, import.crs);
    reader.text("property", json::kOptional, {.most = 64}, import.property);
    std::size_t coordinates = 0;
    if (reader.choice("soil_coordinates", json::kOptional, {"lonlat", "map"}, coordinates) &&
        coordinates == 1)
      import.coordinates = dem::PolygonCoordinates::kMap;
    reader.text("assumption", json::kOptional, words, import.assumption);
    reader.text("title", json::kOptional, words, import.title);
    reader.text("licence", json::kOptional, words, import.licence);
    reader.text("source", json::kOptional, words, import.source);
    reader.number("gravity_m_s2", json::kOptional, {"m/s^2", 0.0, 30.0, true}, import.gravity_m_s2);
    reader.boolean("fix", json::kOptional, import.fix);
    reader.refuse_unknown();
    if (!order.legend.empty() && order.soil.empty()) reader.fault("legend", "needs \"soil\"");
    check_upload(*options_.uploads, order.elevation, "/elevation", faults);
    check_upload(*options_.uploads, order.soil, "/soil", faults);
    check_upload(*options_.uploads, order.legend, "/legend", faults);
    // One that was made of this map is no stranger: a worker that died may have to make it again.
    const auto known = read_origin(options_.uploads->terrains() / import.name);
    if (!has_fault_under(faults, "/name") && catalogue()->terrains.contains(import.name) &&
        (!known || known->from != order.elevation))
      faults.push_back({"/name", fmt::format("there is a terrain {} already", in_quotes(import.name))});
  }
  if (!faults.empty()) return fail(ErrorCode::kInvalidRequest, summary_of(faults), faults);
  return order;
}

Result<CampaignTaken> Service::take_campaign(const CampaignOrder& order, Progress& progress) const {
  return api::take_campaign(*options_.uploads, order, *catalogue(), progress);
}

Result<TerrainImportReport> Service::take_terrain(const TerrainOrder& order, Progress& progress) const {
  return api::take_terrain(*options_.uploads, order, *catalogue(), progress);
}

}  // namespace slipway::api
