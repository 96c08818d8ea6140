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

}  // namespace slipway::api::json
