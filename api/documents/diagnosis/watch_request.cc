#include "api/documents/diagnosis/watch_request.h"

#include <fmt/format.h>

#include <optional>
#include <string>
#include <utility>

#include "api/documents/diagnosis/diagnosis_request.h"
#include "api/files/campaign/appended_drives.h"
#include "api/json/faults.h"
#include "api/json/parse.h"
#include "api/json/strict_reader.h"

namespace slipway::api::json {
namespace {

// Nothing where there are none of this name, which is a fault of the reader's at `key`.
Result<std::optional<gap::DriveCampaign>> drives_of(const std::string& name, std::string_view key,
                                                    const ShippedDrives& shipped, ObjectReader& reader) {
  auto drives = shipped(name);
  if (drives) return std::optional(*std::move(drives));
  if (drives.error().code != ErrorCode::kInvalidRequest) return fail(drives.error());
  reader.fault(key, drives.error().detail);
  return std::optional<gap::DriveCampaign>();
}

// The drives of a campaign in the place of those of a request.
Result<void> read_campaign(ObjectReader& reader, const ShippedDrives& shipped, WatchRequest& request) {
  auto watched = drives_of(request.campaign, "campaign", shipped, reader);
  if (!watched) return fail(watched.error());
  if (*watched) request.watched = **std::move(watched);
  if (reader.member("drives", kOptional) != nullptr)
    reader.fault("drives", "are those of the campaign: leave out the one or the other");
  const bool is_given = reader.member("learn", kOptional) != nullptr;
  const bool is_count = reader.whole("learn", kOptional, gap::kFewestLearnt, gap::kMostLearnt, request.learn);
  if (is_count && !request.reference.empty()) reader.fault("learn", "is of a watch without a reference");
  const std::size_t all = request.watched.drives.size();
  if ((is_count || !is_given) && *watched && request.reference.empty() &&
      static_cast<std::size_t>(request.learn) >= all)
    reader.fault("learn", fmt::format("is {}, must be below {}, the number of drives of {}: one at least is "
                                      "left to watch",
                                      request.learn, all, request.campaign));
  if (request.reference == request.campaign)
    reader.fault("reference",
                 "must be other drives than those that are watched; without it the first are learnt");
  return {};
}

}  // namespace

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
  const bool of_campaign =
      reader.text("campaign", kOptional, {.most = 64, .is_name = true}, request.campaign);
  const auto need = of_campaign ? kOptional : kRequired;
  if (reader.text("reference", need, {.most = 64, .is_name = true}, request.reference)) {
    auto healthy = drives_of(request.reference, "reference", shipped, reader);
    if (!healthy) return fail(healthy.error());
    if (*healthy) request.healthy = std::make_shared<const gap::DriveCampaign>(**std::move(healthy));
  }
  if (of_campaign) {
    if (auto read = read_campaign(reader, shipped, request); !read) return fail(read.error());
  } else {
    if (request.healthy)
      request.watched = read_appended_drives(reader, *request.healthy);
    else
      reader.member("drives", kRequired);
    if (reader.member("learn", kOptional) != nullptr)
      reader.fault("learn", "is of the first drives of a campaign: name it");
  }
  reader.refuse_unknown();
  return reading;
}

}  // namespace slipway::api::json
