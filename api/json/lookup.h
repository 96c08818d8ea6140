#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "api/json/json_value.h"

// Members of documents of our own, whose form is known: what is missing reads as null, 0 or empty.
namespace slipway::api::json {

inline const JsonValue& at(const JsonValue& value, std::string_view key) {
  static const JsonValue nothing;
  const JsonValue* const found = value.find(key);
  return found != nullptr ? *found : nothing;
}
inline bool has(const JsonValue& value, std::string_view key) {
  return !at(value, key).is(JsonValue::Kind::kNull);
}
inline double number(const JsonValue& value, std::string_view key) {
  return at(value, key).number;
}
inline const std::string& text(const JsonValue& value, std::string_view key) {
  return at(value, key).text;
}
inline std::vector<double> numbers(const JsonValue& value, std::string_view key) {
  std::vector<double> out;
  for (const JsonValue& element : at(value, key).elements) out.push_back(element.number);
  return out;
}

}  // namespace slipway::api::json
