#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/result.h"

namespace slipway::api::json {

// Which routes to compare, by rank; empty: those that lie nearest to each other, and then the others.
struct ComparedRoutes {
  int a = 0, b = 0;
};

// Two answers side by side ("plan/1", "check/1" or "prediction/1", both of one format) as
// "answer-comparison/1": what differs in their requests, and for each pair of routes the figures of both,
// their differences (b less a) and, where the figures have 90 % intervals, whether these lie apart. The same
// answers give the same bytes. Errors: invalid_request at /a or /b where a document is no such answer or has
// no such route, and at /b where the formats differ.
Result<std::string> compare_answers(std::string_view a, std::string_view b,
                                    const std::optional<ComparedRoutes>& routes);

}  // namespace slipway::api::json
