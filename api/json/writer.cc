#include "api/json/writer.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <stdexcept>

#include "core/angle.h"
#include "core/text_encoding.h"

namespace slipway::api::json {
namespace {

constexpr std::string_view kNoCharacter = "\xEF\xBF\xBD";  // U+FFFD

void append_quoted(std::string& out, std::string_view text) {
  out += '"';
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    switch (c) {
      case '"':
        out += "\\\"";
        break;
      case '\\':
        out += "\\\\";
        break;
      case '\n':
        out += "\\n";
        break;
      case '\t':
        out += "\\t";
        break;
      default:
        if (static_cast<unsigned char>(c) < 0x20U) {
          fmt::format_to(std::back_inserter(out), "\\u{:04x}", static_cast<unsigned>(c));
        } else if (static_cast<unsigned char>(c) < 0x80U) {
          out += c;
        } else if (const std::size_t length = length_of_character(text, i); length > 0) {
          out += text.substr(i, length);
          i += length - 1;
        } else {
          out += kNoCharacter;
        }
    }
  }
  out += '"';
}

}  // namespace

void Writer::separate() {
  if (!first_) out_ += ',';
  first_ = false;
}

void Writer::finite(double value) const {
  if (!std::isfinite(value)) throw std::domain_error(fmt::format("{} is not finite in an answer", last_key_));
}

Writer& Writer::begin_object() {
  separate();
  out_ += '{';
  first_ = true;
  return *this;
}

Writer& Writer::end_object() {
  out_ += '}';
  first_ = false;
  return *this;
}

Writer& Writer::begin_array() {
  separate();
  out_ += '[';
  first_ = true;
  return *this;
}

Writer& Writer::end_array() {
  out_ += ']';
  first_ = false;
  return *this;
}

Writer& Writer::key(std::string_view name) {
  separate();
  append_quoted(out_, name);
  out_ += ':';
  last_key_ = name;
  first_ = true;  // no comma before the value
  return *this;
}

Writer& Writer::text(std::string_view value) {
  separate();
  append_quoted(out_, value);
  return *this;
}

Writer& Writer::boolean(bool value) {
  return raw(value ? "true" : "false");
}

Writer& Writer::null() {
  return raw("null");
}

Writer& Writer::whole(std::int64_t value) {
  return raw(fmt::format("{}", value));
}

Writer& Writer::exact(double value) {
  finite(value);
  return raw(fmt::format("{}", value == 0.0 ? 0.0 : value));  // -0 is 0
}

Writer& Writer::significant(double value) {
  finite(value);
  return raw(fmt::format("{:.6g}", value == 0.0 ? 0.0 : value));
}

Writer& Writer::metres(double value) {
  finite(value);
  const double rounded = std::round(value * 1000.0) / 1000.0;
  return raw(fmt::format("{}", rounded == 0.0 ? 0.0 : rounded));
}

Writer& Writer::angle_deg(double rad) {
  finite(rad);
  const double deg = deg_from_rad(rad);
  return raw(fmt::format("{:.12g}", deg == 0.0 ? 0.0 : deg));
}

Writer& Writer::raw(std::string_view json) {
  separate();
  out_ += json;
  return *this;
}

Writer& Writer::texts(std::string_view name, const std::vector<std::string>& values) {
  key(name).begin_array();
  for (const std::string& value : values) text(value);
  return end_array();
}

void write_value(Writer& w, const JsonValue& value) {
  switch (value.kind) {
    case JsonValue::Kind::kNull:
      w.null();
      return;
    case JsonValue::Kind::kBoolean:
      w.boolean(value.boolean);
      return;
    case JsonValue::Kind::kNumber:
      w.exact(value.number);
      return;
    case JsonValue::Kind::kString:
      w.text(value.text);
      return;
    case JsonValue::Kind::kArray:
      w.begin_array();
      for (const JsonValue& element : value.elements) write_value(w, element);
      w.end_array();
      return;
    case JsonValue::Kind::kObject:
      w.begin_object();
      for (std::size_t i = 0; i < value.keys.size(); ++i) {
        w.key(value.keys[i]);
        write_value(w, value.elements[i]);
      }
      w.end_object();
      return;
  }
}

}  // namespace slipway::api::json
