#include "api/json/strict_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "api/json/faults.h"
#include "core/angle.h"

namespace slipway::api::json {
namespace {

std::string with_unit(std::string_view unit) {
  return unit.empty() || unit == "1" ? std::string() : fmt::format(" {}", unit);
}

// "in [0, 60]", "above 0", "at least 1", "finite"
std::string range_text(const NumberRule& rule) {
  const bool below = std::isfinite(rule.lowest);
  const bool above = std::isfinite(rule.highest);
  if (below && above)
    return fmt::format("in {}{}, {}]", rule.above_lowest ? "(" : "[", rule.lowest, rule.highest);
  if (below) return fmt::format("{} {}", rule.above_lowest ? "above" : "at least", rule.lowest);
  if (above) return fmt::format("at most {}", rule.highest);
  return "finite";
}

bool in_range(double value, const NumberRule& rule) {
  return std::isfinite(value) && value <= rule.highest &&
         (rule.above_lowest ? value > rule.lowest : value >= rule.lowest);
}

bool is_name(const std::string& text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
}

}  // namespace

bool read_number(const JsonValue& value, const std::string& pointer, std::string_view label,
                 const NumberRule& rule, double& out, std::vector<Fault>& faults) {
  if (!value.is(JsonValue::Kind::kNumber)) {
    faults.push_back(
        {pointer, fmt::format("{} = {}, must be a number{}", label, describe(value),
                              with_unit(rule.unit).empty() ? "" : fmt::format(" in {}", rule.unit))});
    return false;
  }
  if (!in_range(value.number, rule)) {
    const bool is_percent =
        rule.unit == "1" && rule.highest == 1.0 && value.number > 1.0 && value.number <= 100.0;
    faults.push_back(
        {pointer,
         fmt::format(
             "{} = {}{}, must be {}{}", label, value.number, with_unit(rule.unit), range_text(rule),
             is_percent ? fmt::format("; {} % is {}", value.number, value.number / 100.0) : std::string())});
    return false;
  }
  out = value.number;
  return true;
}

bool read_text(const JsonValue& value, const std::string& pointer, std::string_view label,
               const TextRule& rule, std::string& out, std::vector<Fault>& faults) {
  if (!value.is(JsonValue::Kind::kString)) {
    faults.push_back({pointer, fmt::format("{} = {}, must be a string", label, describe(value))});
    return false;
  }
  if (value.text.size() > rule.most) {
    faults.push_back(
        {pointer, fmt::format("{} has {} bytes, must have at most {}", label, value.text.size(), rule.most)});
    return false;
  }
  if (value.text.empty() && !rule.may_be_empty) {
    faults.push_back({pointer, fmt::format("{} is empty", label)});
    return false;
  }
  if (rule.is_name && !is_name(value.text)) {
    faults.push_back(
        {pointer, fmt::format("{} = {}, must be made of a-z, 0-9, _ and - only", label, describe(value))});
    return false;
  }
  out = value.text;
  return true;
}

ObjectReader::ObjectReader(const JsonValue& value, std::string pointer, std::vector<Fault>& faults,
                           std::vector<std::string>* passed_over)
    : pointer_(std::move(pointer)), faults_(faults), passed_over_(passed_over) {
  if (value.is(JsonValue::Kind::kObject)) {
    object_ = &value;
  } else {
    faults_.push_back({pointer_, fmt::format("is {}, must be an object", describe(value))});
  }
}

const JsonValue* ObjectReader::member(std::string_view key, Presence presence) {
  known_.emplace_back(key);
  if (object_ == nullptr) return nullptr;
  const JsonValue* const value = object_->find(key);
  if (value == nullptr && presence == kRequired) {
    fault(key, fmt::format("{} is missing", key));
    missing_.emplace_back(key);
  }
  return value;
}

bool ObjectReader::number(std::string_view key, Presence presence, const NumberRule& rule, double& out) {
  const JsonValue* const value = member(key, presence);
  return value != nullptr && read_number(*value, child_pointer(pointer_, key), key, rule, out, faults_);
}

bool ObjectReader::number(std::string_view key, Presence presence, const NumberRule& rule,
                          std::optional<double>& out) {
  double value = 0.0;
  if (!number(key, presence, rule, value)) return false;
  out = value;
  return true;
}

bool ObjectReader::angle_deg(std::string_view key, Presence presence, const NumberRule& rule_deg,
                             double& out_rad) {
  double deg = 0.0;
  if (!number(key, presence, rule_deg, deg)) return false;
  out_rad = rad_from_deg(deg);
  return true;
}

bool ObjectReader::angle_deg(std::string_view key, Presence presence, const NumberRule& rule_deg,
                             std::optional<double>& out_rad) {
  double rad = 0.0;
  if (!angle_deg(key, presence, rule_deg, rad)) return false;
  out_rad = rad;
  return true;
}

bool ObjectReader::whole_number(std::string_view key, Presence presence, double lowest, double highest,
                                double& out) {
  const JsonValue* const value = member(key, presence);
  if (value == nullptr) return false;
  if (!value->is(JsonValue::Kind::kNumber) || value->number != std::floor(value->number) ||
      value->number < lowest || value->number > highest) {
    fault(key,
          fmt::format("{} = {}, must be a whole number in [{}, {}]", key, describe(*value), lowest, highest));
    return false;
  }
  out = value->number;
  return true;
}

bool ObjectReader::text(std::string_view key, Presence presence, const TextRule& rule, std::string& out) {
  const JsonValue* const value = member(key, presence);
  return value != nullptr && read_text(*value, child_pointer(pointer_, key), key, rule, out, faults_);
}

bool ObjectReader::boolean(std::string_view key, Presence presence, bool& out) {
  const JsonValue* const value = member(key, presence);
  if (value == nullptr) return false;
  if (!value->is(JsonValue::Kind::kBoolean)) {
    fault(key, fmt::format("{} = {}, must be true or false", key, describe(*value)));
    return false;
  }
  out = value->boolean;
  return true;
}

bool ObjectReader::choice(std::string_view key, Presence presence,
                          const std::vector<std::string_view>& allowed, std::size_t& out) {
  const JsonValue* const value = member(key, presence);
  if (value == nullptr) return false;
  const auto found = std::find(allowed.begin(), allowed.end(), value->text);
  if (!value->is(JsonValue::Kind::kString) || found == allowed.end()) {
    fault(key, fmt::format("{} = {}, must be one of {}", key, describe(*value), fmt::join(allowed, ", ")));
    return false;
  }
  out = static_cast<std::size_t>(found - allowed.begin());
  return true;
}

std::optional<ObjectReader> ObjectReader::object(std::string_view key, Presence presence) {
  const JsonValue* const value = member(key, presence);
  if (value == nullptr) return std::nullopt;
  if (!value->is(JsonValue::Kind::kObject)) {
    fault(key, fmt::format("{} = {}, must be an object", key, describe(*value)));
    return std::nullopt;
  }
  return ObjectReader(*value, child_pointer(pointer_, key), faults_, passed_over_);
}

ObjectReader ObjectReader::object(const Element& element) const {
  return ObjectReader(*element.value, element.pointer, faults_, passed_over_);
}

std::vector<Element> ObjectReader::list(std::string_view key, Presence presence, const CountRule& rule) {
  const JsonValue* const value = member(key, presence);
  std::vector<Element> elements;
  if (value == nullptr) return elements;
  if (!value->is(JsonValue::Kind::kArray)) {
    fault(key, fmt::format("{} = {}, must be a list", key, describe(*value)));
    return elements;
  }
  const std::size_t count = value->elements.size();
  if (count < rule.least || count > rule.most) {
    fault(key, fmt::format("{} has {} elements, must have {} to {}", key, count, rule.least, rule.most));
    return elements;
  }
  elements.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    elements.push_back({&value->elements[i], child_pointer(child_pointer(pointer_, key), i)});
  }
  return elements;
}

bool ObjectReader::numbers(std::string_view key, Presence presence, const CountRule& count,
                           const NumberRule& rule, std::vector<double>& out) {
  const std::size_t before = faults_.size();
  std::vector<double> values;
  const auto elements = list(key, presence, count);
  for (std::size_t i = 0; i < elements.size(); ++i) {
    double value = 0.0;
    read_number(*elements[i].value, elements[i].pointer, fmt::format("{}[{}]", key, i), rule, value, faults_);
    values.push_back(value);
  }
  if (faults_.size() != before || elements.empty()) return false;
  out = std::move(values);
  return true;
}

bool ObjectReader::texts(std::string_view key, Presence presence, const CountRule& count,
                         const TextRule& rule, std::vector<std::string>& out) {
  const std::size_t before = faults_.size();
  std::vector<std::string> values;
  const auto elements = list(key, presence, count);
  for (std::size_t i = 0; i < elements.size(); ++i) {
    read_text(*elements[i].value, elements[i].pointer, fmt::format("{}[{}]", key, i), rule,
              values.emplace_back(), faults_);
  }
  if (faults_.size() != before || elements.empty()) return false;
  out = std::move(values);
  return true;
}

void ObjectReader::fault(std::string_view key, std::string message) {
  faults_.push_back({child_pointer(pointer_, key), std::move(message)});
}

void ObjectReader::refuse_unknown() {
  if (object_ == nullptr) return;
  for (const std::string& key : object_->keys) {
    if (std::find(known_.begin(), known_.end(), key) != known_.end()) continue;
    if (passed_over_ != nullptr && !nearest(key, missing_)) {
      passed_over_->push_back(child_pointer(pointer_, key));
    } else {
      fault(key, unknown_name("key", key, known_));
    }
  }
}

}  // namespace slipway::api::json
