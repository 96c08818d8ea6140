#pragma once

#include <map>
#include <string>
#include <string_view>

#include "api/requests/check_request.h"
#include "core/result.h"

namespace slipway::api::json {

// `rules` are the sets that a request may name; what it says itself goes before them. Errors only where the
// bytes are no JSON document; everything else is a fault in the reading.
Result<Reading<CheckRequest>> read_check_request(std::string_view bytes,
                                                 const std::map<std::string, RuleSet, std::less<>>& rules);

// Whole, with every default filled in.
std::string write_check_request(const CheckRequest& request);

}  // namespace slipway::api::json
