#include "api/documents/watch_request.h"

#include <utility>

#include "api/documents/diagnosis_request.h"
#include "api/files/campaign/appended_drives.h"
#include "api/json/faults.h"
#include "api/json/parse.h"
#include "api/json/strict_reader.h"

namespace slipway::api::json {

Result<Reading<WatchRequest>> read_watch_request(std::string_view bytes, const ShippedDrives& shipped) {
  const auto document = parse(bytes, {.bytes = kMaxWatchBytes});
  if (!document) return fail(document.error());
  Reading<WatchRequest> reading;
  WatchRequest& request = reading.request;
  ObjectReader reader(*document, "", reading.faults);
  if (!reader.is_object()) return reading;
  if (reader.member("continues", kOptional) != nullptr)
    reader.fault("continues", "names a job, which only a service that runs knows");
  reader.number("alpha", kOptional, {"1", 1e-9, 0.5}, request.alpha);
  reader.boolean("diagnose", kOptional, request.diagnose);
  read_search_keys(reader, request.without, request.seed);
  if (reader.text("reference", kRequired, {.most = 64, .is_name = true}, request.reference)) {
    auto healthy = shipped(request.reference);
    if (!healthy && healthy.error().code != ErrorCode::kInvalidRequest) return fail(healthy.error());
    if (healthy) {
      request.healthy = std::make_shared<const gap::DriveCampaign>(*std::move(healthy));
      request.watched = read_appended_drives(reader, *request.healthy);
    } else {
      reader.fault("reference", healthy.error().detail);
    }
  }
  if (!request.healthy) reader.member("drives", kRequired);
  reader.refuse_unknown();
  return reading;
}

}  // namespace slipway::api::json
