#include "api/json/toml_parse.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <toml.hpp>

namespace slipway::api::json {
namespace {

constexpr std::size_t kMaxTomlBytes = std::size_t{1} << 20U;

JsonValue value_of(const toml::value& value) {
  JsonValue out;
  switch (value.type()) {
    case toml::value_t::table: {
      out.kind = JsonValue::Kind::kObject;
      // The library's tables have no order.
      for (const auto& [key, member] : value.as_table()) out.keys.push_back(key);
      std::sort(out.keys.begin(), out.keys.end());
      for (const std::string& key : out.keys) out.elements.push_back(value_of(value.as_table().at(key)));
      break;
    }
    case toml::value_t::array:
      out.kind = JsonValue::Kind::kArray;
      for (const toml::value& element : value.as_array()) out.elements.push_back(value_of(element));
      break;
    case toml::value_t::integer:
      out.kind = JsonValue::Kind::kNumber;
      out.number = static_cast<double>(value.as_integer());
      break;
    case toml::value_t::floating:
      out.kind = JsonValue::Kind::kNumber;
      out.number = value.as_floating();
      break;
    case toml::value_t::boolean:
      out.kind = JsonValue::Kind::kBoolean;
      out.boolean = value.as_boolean();
      break;
    case toml::value_t::string:
      out.kind = JsonValue::Kind::kString;
      out.text = value.as_string().str;
      break;
    default: {
      std::ostringstream text;
      text << value;
      out.kind = JsonValue::Kind::kString;
      out.text = text.str();
    }
  }
  return out;
}

// The first line of a message of many with a picture.
std::string first_line(std::string_view message) {
  const std::size_t end = std::min(message.find('\n'), message.size());
  std::string line(message.substr(0, end));
  if (const std::size_t tag = line.find("toml::"); line.starts_with("[error]") && tag != std::string::npos)
    line = line.substr(tag);
  return line;
}

}  // namespace

Result<JsonValue> parse_toml(std::string_view bytes, const std::string& file) {
  if (bytes.size() > kMaxTomlBytes)
    return fail(ErrorCode::kPayloadTooLarge,
                fmt::format("{} has {} bytes, must have {} at most", file, bytes.size(), kMaxTomlBytes));
  std::istringstream stream{std::string(bytes)};
  try {
    return value_of(toml::parse(stream, file));
  } catch (const toml::exception& error) {
    const std::string message = fmt::format("{}, line {}, column {}: {}", file, error.location().line(),
                                            error.location().column(), first_line(error.what()));
    return fail(ErrorCode::kUnreadableData, message, {{file + "#", message}});
  } catch (const std::exception& error) {
    const std::string message = fmt::format("{} is no TOML: {}", file, first_line(error.what()));
    return fail(ErrorCode::kUnreadableData, message, {{file + "#", message}});
  }
}

}  // namespace slipway::api::json
