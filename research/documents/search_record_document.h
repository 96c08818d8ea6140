#pragma once

#include <string>
#include <string_view>

#include "core/result.h"
#include "gap/diagnosis/decide/search_record.h"
#include "gap/diagnosis/result/result.h"

namespace slipway::api::json {

// A diagnosis's search record and what was decided from it: some 4 KB, by which decisions are judged again
// without a diagnosis.
std::string search_record_document(const gap::Diagnosis& diagnosis);
// What a decision needs of it; probabilities are not in it (see decide/posterior.h). Errors: malformed_json,
// invalid_request, in `file`.
Result<gap::SearchRecord> read_search_record(std::string_view bytes, std::string_view file);

}  // namespace slipway::api::json
