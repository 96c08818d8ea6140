#include "api/service_uploads.h"

#include <fmt/format.h>

#include <utility>

#include "api/json/faults.h"
#include "api/json/parse.h"
#include "api/json/strict_reader.h"
#include "api/requests/plan_request.h"
#include "dem/crs/crs_text.h"

namespace slipway::api {
namespace {

const json::TextRule kUploadId{.most = 64, .is_name = true};

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

Result<CampaignOrder> read_campaign(const Service& service, std::string_view bytes) {
  const auto document = json::parse(bytes, {.bytes = RequestLimits::kBodyBytes});
  if (!document) return fail(document.error());
  if (!service.uploads()) return fail(no_uploads());
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
    check_upload(*service.uploads(), order.upload, "/upload", faults);
    if (!order.follows.empty() && !has_fault_under(faults, "/follows") &&
        !uploaded_campaign(*service.uploads(), order.follows))
      faults.push_back(
          {"/follows", fmt::format("there is no campaign {} that was sent", in_quotes(order.follows))});
  }
  if (!faults.empty()) return fail(ErrorCode::kInvalidRequest, summary_of(faults), faults);
  return order;
}

Result<TerrainOrder> read_terrain(const Service& service, std::string_view bytes) {
  const auto document = json::parse(bytes, {.bytes = RequestLimits::kBodyBytes});
  if (!document) return fail(document.error());
  if (!service.uploads()) return fail(no_uploads());
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
    if (reader.text("crs", json::kOptional, {.most = kMaxWords}, import.crs) && !import.crs.empty())
      if (const auto fault = dem::fault_of_crs_text(import.crs)) reader.fault("crs", "crs " + *fault);
    reader.text("unit", json::kOptional, {.most = 64}, import.unit);
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
    check_upload(*service.uploads(), order.elevation, "/elevation", faults);
    check_upload(*service.uploads(), order.soil, "/soil", faults);
    check_upload(*service.uploads(), order.legend, "/legend", faults);
    if (!has_fault_under(faults, "/name") && service.ships(import.name))
      faults.push_back({"/name", fmt::format("{} is the name of a terrain that ships with the service",
                                             in_quotes(import.name))});
  }
  if (!faults.empty()) return fail(ErrorCode::kInvalidRequest, summary_of(faults), faults);
  return order;
}

}  // namespace slipway::api
