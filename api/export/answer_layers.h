#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "dem/vector_file.h"

namespace slipway::api::json {

// The table of all stations in pages, one after the other, nothing after the last; put together they are one.
using TablePages = std::function<Result<std::optional<std::string>>()>;
TablePages in_one_page(std::string table);
// The layers routes and stations of a "check/1", "prediction/1" or "plan/1" document, and of the first two
// where a rule trips and where slip is checked, in map metres. `stations`: all of them, where the document
// has but some; empty: its own. They are read as the layer is. Errors: no_data where it has none; those of
// `stations`.
Result<std::vector<dem::VectorLayer>> answer_layers(std::string_view answer, TablePages stations);

}  // namespace slipway::api::json
