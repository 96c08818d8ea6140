#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace slipway::api::json {

// A JSON document in memory in a type of Slipway's own, so that only parse.cc depends on the parser's
// library. Numbers are doubles: every whole number up to 2^53 is exact, and no key allows larger ones.
struct JsonValue {
  enum class Kind { kNull, kBoolean, kNumber, kString, kArray, kObject };

  Kind kind = Kind::kNull;
  bool boolean = false;
  double number = 0.0;
  std::string text;
  std::vector<std::string> keys;    // of an object, in the document's order, each once
  std::vector<JsonValue> elements;  // of an array; of an object, the values of `keys`

  bool is(Kind k) const { return kind == k; }
  // The member of an object; nullptr where there is none.
  const JsonValue* find(std::string_view key) const {
    for (std::size_t i = 0; i < keys.size(); ++i) {
      if (keys[i] == key) return &elements[i];
    }
    return nullptr;
  }
};

// One more step of a JSON pointer (RFC 6901).
std::string child_pointer(std::string_view pointer, std::string_view key);
std::string child_pointer(std::string_view pointer, std::size_t index);

// The value as a fault shows it: 212, "uphill" (shortened where it is long), a list of 3.
std::string describe(const JsonValue& value);

}  // namespace slipway::api::json
