#include "api/continued_request.h"

#include <fmt/format.h>

#include <charconv>
#include <utility>
#include <vector>

#include "api/documents/diagnosis/watch_request.h"
#include "api/json/faults.h"
#include "api/json/parse.h"
#include "api/json/strict_reader.h"
#include "api/json/writer.h"
#include "api/recorded_request.h"
#include "api/requests/plan_request.h"

namespace slipway::api {
namespace {

constexpr std::string_view kDrives = "drives", kContinues = "continues";

// The request of the job that is continued, or why it can't be.
Result<std::string> request_of(const std::string& id, std::string_view kind, JobStore& jobs) {
  const auto refused = [](std::string why) { return fail(ErrorCode::kInvalidRequest, std::move(why)); };
  const auto job = jobs.get(id);
  if (!job) return fail(job.error());
  if (!*job) return refused("there is no job of this id");
  if ((*job)->kind != kind) return refused(fmt::format("the job is a {}, not a {}", (*job)->kind, kind));
  if ((*job)->state == JobState::kFailed || (*job)->state == JobState::kDismissed)
    return refused(
        fmt::format("the {} ended as {}: continue the one before it", kind, describe((*job)->state)));
  const auto request = jobs.request(id);
  if (!request) return fail(request.error());
  if (!*request) return refused("the job is no longer kept");
  return std::string(taken_apart(**request).body);
}

// The earlier request with the drives of the new one behind its own, and how many its own are.
std::string with_drives(const json::JsonValue& earlier, const json::JsonValue* more, std::size_t& before) {
  json::Writer w;
  w.begin_object();
  for (std::size_t i = 0; i < earlier.keys.size(); ++i) {
    w.key(earlier.keys[i]);
    if (earlier.keys[i] != kDrives) {
      json::write_value(w, earlier.elements[i]);
      continue;
    }
    before = earlier.elements[i].elements.size();
    w.begin_array();
    for (const json::JsonValue& drive : earlier.elements[i].elements) json::write_value(w, drive);
    if (more != nullptr)
      for (const json::JsonValue& drive : more->elements) json::write_value(w, drive);
    w.end_array();
  }
  w.end_object();
  return w.take();
}

// "/drives/12/csv" -> "/drives/2/csv" where ten stood before.
std::string as_counted_in_request(const std::string& pointer, std::size_t before) {
  const std::string list = fmt::format("/{}/", kDrives);
  if (!pointer.starts_with(list)) return pointer;
  std::size_t index = 0;
  const char* const first = pointer.data() + list.size();
  const auto [end, error] = std::from_chars(first, pointer.data() + pointer.size(), index);
  if (error != std::errc() || index < before) return pointer;
  return fmt::format("{}{}{}", list, index - before, end);
}

}  // namespace

Result<std::string> continued_request(std::string_view request, std::string_view kind, JobStore& jobs,
                                      const RequestFaults& faults_of) {
  const auto document = json::parse(request, {.bytes = RequestLimits::kBodyBytes});
  if (!document) return fail(document.error());
  const auto checked = [&](std::string recorded) -> Result<std::string> {
    if (auto fault = faults_of(recorded)) return fail(*std::move(fault));
    return recorded;
  };
  if (document->find(kContinues) == nullptr) return checked(std::string(request));
  std::vector<Fault> faults;
  json::ObjectReader reader(*document, "", faults);
  std::string id;
  reader.text(kContinues, json::kRequired, {.most = 32, .is_name = true}, id);
  reader.list(kDrives, json::kRequired, {1, RequestLimits::kBodyBytes});
  for (const std::string& key : document->keys)
    if (key != kContinues && key != kDrives)
      faults.push_back(
          {json::child_pointer("", key), fmt::format("is that of the {} that is continued", kind)});
  Result<std::string> earlier = std::string();
  if (!id.empty()) earlier = request_of(id, kind, jobs);
  if (!earlier && earlier.error().code != ErrorCode::kInvalidRequest) return fail(earlier.error());
  if (!earlier) faults.push_back({json::child_pointer("", kContinues), earlier.error().detail});
  if (!faults.empty()) return fail(ErrorCode::kInvalidRequest, summary_of(faults), faults);
  const auto before_it = json::parse(*earlier, {.bytes = json::kMaxWatchBytes});
  if (!before_it) return fail(ErrorCode::kInternal, "a request that was kept can't be read");
  if (before_it->find(kDrives) == nullptr)
    faults.push_back({json::child_pointer("", kContinues),
                      fmt::format("the {} is of a campaign: append the drives to this one", kind)});
  if (!faults.empty()) return fail(ErrorCode::kInvalidRequest, summary_of(faults), faults);
  std::size_t before = 0;
  auto recorded = checked(with_drives(*before_it, document->find(kDrives), before));
  if (recorded) return recorded;
  Error error = recorded.error();
  for (Fault& fault : error.faults) fault.pointer = as_counted_in_request(fault.pointer, before);
  if (!error.faults.empty()) error.detail = summary_of(error.faults);
  return fail(std::move(error));
}

}  // namespace slipway::api
