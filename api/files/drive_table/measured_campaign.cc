#include "api/files/drive_table/measured_campaign.h"

#include "api/json/parse.h"
#include "api/json/strict_reader.h"

namespace slipway::api::json {
namespace {

constexpr ParseLimits kLimits{.bytes = std::size_t{64} << 20U, .values = 5'000'000};
constexpr std::size_t kMaxDrives = 200'000;

}  // namespace

Result<MeasuredCampaign> read_measured_campaign(std::string_view bytes) {
  const auto document = parse(bytes, kLimits);
  if (!document) return fail(document.error());
  std::vector<Fault> faults;
  ObjectReader reader(*document, "", faults);
  std::size_t format = 0;
  reader.choice("format", kRequired, {"drive-campaign/1"}, format);
  MeasuredCampaign campaign;
  for (const Element& element : reader.list("drives", kRequired, {0, kMaxDrives})) {
    ObjectReader drive(*element.value, element.pointer, faults);
    std::string id, file;
    if (!drive.text("id", kRequired, {}, id) || !drive.text("file", kRequired, {}, file)) continue;
    if (file.find("..") != std::string::npos || file.starts_with('/'))
      drive.fault("file", "\"" + file + "\" is not in the campaign's folder");
    else if (!campaign.files.emplace(id, file).second)
      drive.fault("id", id + " is given twice");
  }
  if (!faults.empty())
    return fail(ErrorCode::kInvalidRequest, "this is no drive-campaign/1", std::move(faults));
  return campaign;
}

}  // namespace slipway::api::json
