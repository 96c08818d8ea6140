#pragma once

#include <string>
#include <string_view>

#include "core/result.h"

namespace slipway::api::json {

// Two answers to one plan request ("plan/1"), by the nominal model and by a corrected one, as
// "plan-comparison/1": both documents, and their routes in pairs, the nearest to each other first, with the
// figures of both and what changed in words. A route without a partner was dropped, or is new. Errors:
// internal where a document is not a plan.
Result<std::string> compare_plans(std::string_view nominal, std::string_view corrected);

}  // namespace slipway::api::json
