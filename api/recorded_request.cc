#include "api/recorded_request.h"

#include <fmt/format.h>

#include "api/json/faults.h"
#include "api/json/parse.h"
#include "api/json/writer.h"
#include "api/requests/batch_request.h"

namespace slipway::api {
namespace {

constexpr char kMark = '#';  // no JSON begins with it, nor does the line before a part's request
constexpr std::string_view kAskedBy = "asked_by", kIsAdmin = "is_admin", kTerrains = "terrains";

std::string version_now(const Service& service, const std::string& terrain) {
  const auto catalogue = service.catalogue();
  const auto site = catalogue->terrains.find(terrain);
  return site == catalogue->terrains.end() ? std::string() : site->second->version();
}

}  // namespace

std::string request_head(const Service& service, const Asker& asker,
                         const std::vector<std::string>& terrains) {
  std::map<std::string, std::string> versions;
  for (const std::string& terrain : terrains) versions[terrain] = version_now(service, terrain);
  json::Writer w;
  w.begin_object().text(kAskedBy, asker.name).boolean(kIsAdmin, asker.is_admin);
  w.key(kTerrains).begin_object();
  for (const auto& [terrain, version] : versions) w.text(terrain, version);
  w.end_object().end_object();
  return kMark + w.take() + '\n';
}

RecordedRequest taken_apart(std::string_view recorded) {
  RecordedRequest request;
  request.body = recorded;
  const std::size_t end = recorded.find('\n');
  if (!recorded.starts_with(kMark) || end == std::string_view::npos) return request;
  const auto head = json::parse(recorded.substr(1, end - 1), {.keys = kMaxBatchRequests});
  if (!head) return request;  // no program wrote it: the reader of the body says what is wrong
  request.head = recorded.substr(0, end + 1);
  request.body = recorded.substr(end + 1);
  if (const auto* name = head->find(kAskedBy)) request.asker.name = name->text;
  if (const auto* admin = head->find(kIsAdmin)) request.asker.is_admin = admin->boolean;
  if (const auto* terrains = head->find(kTerrains))
    for (std::size_t i = 0; i < terrains->keys.size(); ++i)
      request.terrains[terrains->keys[i]] = terrains->elements[i].text;
  return request;
}

std::optional<Error> changed_ground(const Service& service, const RecordedRequest& request) {
  const auto catalogue = service.catalogue();
  std::vector<Fault> faults;
  for (const auto& [terrain, version] : request.terrains) {
    if (const auto same = terrain_at(*catalogue, terrain, version); !same)
      faults.push_back({"/terrain", same.error().detail});
  }
  if (faults.empty()) return std::nullopt;
  return Error{ErrorCode::kConflict, summary_of(faults), faults};
}

}  // namespace slipway::api
