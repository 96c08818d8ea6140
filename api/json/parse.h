#pragma once

#include <cstddef>
#include <string_view>

#include "api/json/json_value.h"
#include "core/result.h"

namespace slipway::api::json {

// What a document may cost before it is refused.
struct ParseLimits {
  std::size_t bytes = std::size_t{1} << 20U;
  std::size_t values = 100'000;
  int depth = 64;
  std::size_t keys = 200;  // of one object; they are compared pairwise
};

// Bytes from outside -> a document. Refused, with line and column: anything but one JSON text, NaN and
// Infinity, numbers a double can't hold, invalid UTF-8 (malformed_json); a key given twice, deeper nesting,
// more values (malformed_json, with a pointer); more bytes (payload_too_large).
Result<JsonValue> parse(std::string_view bytes, const ParseLimits& limits = {});

}  // namespace slipway::api::json
