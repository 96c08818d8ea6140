#pragma once

#include <string>
#include <string_view>

#include "api/json/json_value.h"
#include "core/result.h"

namespace slipway::api::json {

// A TOML text as the value that the same tables, lists, numbers and texts are in JSON, so that one reader
// checks both; dates become texts. `file` is its name in messages. Errors: unreadable_data with line and
// column for anything but TOML 1.0; payload_too_large for more than a mebibyte.
Result<JsonValue> parse_toml(std::string_view bytes, const std::string& file);

}  // namespace slipway::api::json
