#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/json/strict_reader.h"
#include "api/json/writer.h"
#include "api/requests/plan_request.h"
#include "core/result.h"

namespace slipway::api::json {

// "model" of a request as it comes: {"diagnosis": JOB, "ground": [soils of the terrain that are the
// model's]}. Nothing where there was a fault.
std::optional<RequestedModel> read_model_reference(const JsonValue& value, std::vector<Fault>& faults);
void write_model_reference(Writer& w, const RequestedModel& model);

// The same with what a "diagnosis/1", or that of a "watch/1", offers in it, as a request is recorded. Errors:
// invalid_request where the document offers no model.
Result<std::string> whole_model(const RequestedModel& reference, std::string_view diagnosis_document);
// "model" of a recorded request. One that names a job and does not hold its model is a fault.
void read_whole_model(ObjectReader& reader, std::optional<RequestedModel>& model);

// The request again with this in the place of its "model", or without it.
std::string with_member_model(const JsonValue& request, const std::optional<std::string>& model);

}  // namespace slipway::api::json
