#pragma once

#include <cstddef>
#include <string_view>

#include "api/json/json_value.h"
#include "core/result.h"

namespace slipway::api::json {

// The maximum size of a document; a larger one is refused.
struct ParseLimits {
  std::size_t bytes = std::size_t{1} << 20U;
  std::size_t values = 100'000;
  int depth = 64;
  std::size_t keys = 200;  // of one object; they are compared pairwise
};

// Parses bytes from outside. Errors: malformed_json with line and column for anything but one JSON text, for
// NaN and Infinity, for numbers that a double cannot hold, and for invalid UTF-8; malformed_json with a
// pointer for a key given twice, and for nesting or numbers of values beyond the limits; payload_too_large
// for too many bytes.
Result<JsonValue> parse(std::string_view bytes, const ParseLimits& limits = {});

// The same of a file's bytes: every fault begins with the file's name and the place in it, see with_place(),
// and too many bytes are a fault too.
Result<JsonValue> parse_file(std::string_view bytes, std::string_view file, const ParseLimits& limits);

}  // namespace slipway::api::json
