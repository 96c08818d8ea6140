#include "api/model_reference.h"

#include <fmt/format.h>

#include <optional>
#include <utility>
#include <vector>

#include "api/documents/model_object.h"
#include "api/job_kinds.h"
#include "api/json/faults.h"
#include "api/json/parse.h"
#include "api/requests/plan_request.h"

namespace slipway::api {
namespace {

// The document of the diagnosis, or why there is none.
Result<std::string> document_of(const std::string& id, JobStore& jobs) {
  const auto refused = [](std::string why) { return fail(ErrorCode::kInvalidRequest, std::move(why)); };
  const auto job = jobs.get(id);
  if (!job) return fail(job.error());
  if (!*job) return refused("there is no job of this id");
  const Job& found = **job;
  if (found.kind != kDiagnosisKind && found.kind != kWatchKind)
    return refused(fmt::format("the job is a {}: only a diagnosis, or a watch that made one, offers a model",
                               found.kind));
  if (!has_ended(found.state))
    return refused(fmt::format("the {} is {}: it offers no model yet", found.kind, describe(found.state)));
  if (found.state != JobState::kSuccessful)
    return refused(fmt::format("the {} ended as {}: it offers no model", found.kind, describe(found.state)));
  const auto outcome = jobs.outcome(id);
  if (!outcome) return fail(outcome.error());
  if (!*outcome) return refused(fmt::format("the result of the {} is no longer kept", found.kind));
  return std::string(parts_of(**outcome).document);
}

// The model that the value names, as a member of a recorded request; nothing where there were faults.
Result<std::optional<std::string>> model_named(const json::JsonValue& value, JobStore& jobs,
                                               std::vector<Fault>& faults) {
  const auto reference = json::read_model_reference(value, faults);
  if (!reference) return std::nullopt;
  auto model = document_of(reference->diagnosis, jobs);
  if (model) model = json::whole_model(*reference, *model);
  if (model) return *std::move(model);
  if (model.error().code != ErrorCode::kInvalidRequest) return fail(model.error());
  faults.push_back({"/model/diagnosis", model.error().detail});
  return std::nullopt;
}

}  // namespace

Result<std::string> recordable_request(std::string_view request, JobStore& jobs,
                                       const RequestFaults& faults_of) {
  std::string recorded(request);
  std::vector<Fault> faults;
  const auto document = json::parse(request, {.bytes = RequestLimits::kBodyBytes});
  // What is no document is the reader's to refuse.
  if (const json::JsonValue* const named = document ? document->find("model") : nullptr) {
    const auto model = model_named(*named, jobs, faults);
    if (!model) return fail(model.error());
    recorded = json::with_member_model(*document, *model);
  }
  const std::optional<Error> error = faults_of(recorded);
  if (error && faults.empty()) return fail(*error);
  if (faults.empty()) return recorded;
  if (error) faults.insert(faults.begin(), error->faults.begin(), error->faults.end());
  return fail(ErrorCode::kInvalidRequest, summary_of(faults), faults);
}

}  // namespace slipway::api
