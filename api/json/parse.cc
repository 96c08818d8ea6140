#include "api/json/parse.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "api/json/text_place.h"

namespace slipway::api::json {
namespace {

using Library = nlohmann::json;

// Builds a JsonValue from the library's events. The library's own document is not used, since it keeps the
// last of two equal keys and allows any depth.
class Builder : public nlohmann::json_sax<Library> {
 public:
  explicit Builder(const ParseLimits& limits) : limits_(limits) {}

  bool null() override { return place({}) != nullptr; }
  bool boolean(bool value) override {
    JsonValue v;
    v.kind = JsonValue::Kind::kBoolean;
    v.boolean = value;
    return place(std::move(v)) != nullptr;
  }
  bool number_integer(std::int64_t value) override { return number(static_cast<double>(value)); }
  bool number_unsigned(std::uint64_t value) override { return number(static_cast<double>(value)); }
  bool number_float(double value, const std::string& /*text*/) override { return number(value); }
  bool string(std::string& value) override {
    JsonValue v;
    v.kind = JsonValue::Kind::kString;
    v.text = std::move(value);
    return place(std::move(v)) != nullptr;
  }
  bool binary(Library::binary_t& /*value*/) override { return refuse("binary values are not JSON"); }
  bool start_object(std::size_t /*size*/) override { return open(JsonValue::Kind::kObject); }
  bool start_array(std::size_t /*size*/) override { return open(JsonValue::Kind::kArray); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }

  bool key(std::string& name) override {
    JsonValue& object = *open_.back();
    if (std::find(object.keys.begin(), object.keys.end(), name) != object.keys.end()) {
      refuse(fmt::format("key \"{}\" is given twice", name));
      error.faults.front().pointer = child_pointer(pointer(), name);
      return false;
    }
    if (object.keys.size() >= limits_.keys)
      return refuse(fmt::format("more than {} keys in one object", limits_.keys));
    object.keys.push_back(std::move(name));
    return true;
  }

  bool parse_error(std::size_t position, const std::string& /*token*/, const Library::exception& e) override {
    error_position = position;
    error.code = ErrorCode::kMalformedJson;
    error.detail = e.what();
    return false;
  }

  JsonValue root;
  Error error;
  std::size_t error_position = 0;  // one past the offending byte; 0 where the syntax is right

 private:
  bool number(double value) {
    if (!std::isfinite(value)) return refuse("a number is too large");
    JsonValue v;
    v.kind = JsonValue::Kind::kNumber;
    v.number = value;
    return place(std::move(v)) != nullptr;
  }

  bool open(JsonValue::Kind kind) {
    if (static_cast<int>(open_.size()) >= limits_.depth) {
      return refuse(fmt::format("nested deeper than {} levels", limits_.depth));
    }
    JsonValue v;
    v.kind = kind;
    JsonValue* const placed = place(std::move(v));
    if (placed == nullptr) return false;
    open_.push_back(placed);
    return true;
  }

  bool close() {
    open_.pop_back();
    return true;
  }

  // Pointers to open values stay valid, since only the innermost one's elements grow.
  JsonValue* place(JsonValue value) {
    if (++values_ > limits_.values) {
      refuse(fmt::format("more than {} values", limits_.values));
      return nullptr;
    }
    if (open_.empty()) {
      root = std::move(value);
      return &root;
    }
    return &open_.back()->elements.emplace_back(std::move(value));
  }

  std::string pointer() const {
    std::string text;
    for (std::size_t i = 0; i + 1 < open_.size(); ++i) {
      const JsonValue& v = *open_[i];
      text = v.is(JsonValue::Kind::kObject) ? child_pointer(text, v.keys.back())
                                            : child_pointer(text, v.elements.size() - 1);
    }
    return text;
  }

  bool refuse(std::string message) {
    error = Error{ErrorCode::kMalformedJson, message, {{pointer(), message}}};
    return false;
  }

  const ParseLimits& limits_;
  std::vector<JsonValue*> open_;
  std::size_t values_ = 0;
};

// "[json.exception.parse_error.101] parse error at line 1, column 2: syntax error while ..." without the
// library's name.
std::string syntax_message(const std::string& what, std::string_view bytes, std::size_t position) {
  const std::size_t end = std::min(position == 0 ? 0 : position - 1, bytes.size());
  const auto before = bytes.substr(0, end);
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const std::size_t newline = before.rfind('\n');
  const std::size_t column = newline == std::string_view::npos ? end + 1 : end - newline;
  const std::size_t place = what.find("column");
  const std::size_t reason = place == std::string::npos ? what.find("] ") : what.find(": ", place);
  return fmt::format("line {}, column {}: {}", line, column,
                     reason == std::string::npos ? "not JSON" : what.substr(reason + 2));
}

// The library quotes the last bytes read, which may be the invalid UTF-8 itself.
std::string printable(std::string text) {
  std::replace_if(
      text.begin(), text.end(),
      [](char c) { return static_cast<unsigned char>(c) >= 0x80U || static_cast<unsigned char>(c) < 0x20U; },
      '?');
  constexpr std::size_t kMax = 300;
  if (text.size() > kMax) text.replace(kMax, std::string::npos, "...");
  return text;
}

}  // namespace

// An empty name is that of no file.
Result<JsonValue> parse_file(std::string_view bytes, std::string_view file, const ParseLimits& limits) {
  if (bytes.size() > limits.bytes) {
    Error error{ErrorCode::kPayloadTooLarge,
                fmt::format("the body has {} bytes, at most {} are read", bytes.size(), limits.bytes),
                {}};
    if (!file.empty()) error.faults = {{"", fmt::format("{}: {}", file, error.detail)}};
    return fail(std::move(error));
  }
  Builder builder(limits);
  if (Library::sax_parse(bytes.begin(), bytes.end(), &builder)) return std::move(builder.root);
  Error& error = builder.error;
  if (builder.error_position > 0 || error.faults.empty()) {
    error.detail = printable(syntax_message(error.detail, bytes, builder.error_position));
    error.faults = {{"", file.empty() ? error.detail : fmt::format("{}, {}", file, error.detail)}};
  } else if (!file.empty()) {
    Fault& fault = error.faults.front();
    fault.message = with_place(file, bytes, fault.pointer, fault.message);
  }
  return fail(std::move(error));
}

Result<JsonValue> parse(std::string_view bytes, const ParseLimits& limits) {
  return parse_file(bytes, {}, limits);
}

}  // namespace slipway::api::json
