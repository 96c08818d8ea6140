#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/json/json_value.h"
#include "core/result.h"

namespace slipway::api::json {

// Whether the key must be there. An optional key that is absent leaves its target as it was: the default
// stands in the struct that is read into, and nowhere else.
enum class Presence { kRequired, kOptional };
constexpr Presence kRequired = Presence::kRequired;
constexpr Presence kOptional = Presence::kOptional;

// What a number must be, in the unit of the boundary.
struct NumberRule {
  std::string_view unit;  // "" or "1": none is shown
  double lowest = -std::numeric_limits<double>::infinity();
  double highest = std::numeric_limits<double>::infinity();
  bool above_lowest = false;  // lowest itself is refused
};

struct TextRule {
  std::size_t most = 200;  // bytes
  bool is_name = false;    // [a-z0-9_-], as in file names and addresses
  bool may_be_empty = false;
};

struct CountRule {
  std::size_t least = 0;
  std::size_t most = 0;
};

// One element of a list, and its place.
struct Element {
  const JsonValue* value;
  std::string pointer;
};

// "slope_deg = 212 deg, must be in [0, 60]"; false where a fault was added and `out` left alone.
bool read_number(const JsonValue& value, const std::string& pointer, std::string_view label,
                 const NumberRule& rule, double& out, std::vector<Fault>& faults);
bool read_text(const JsonValue& value, const std::string& pointer, std::string_view label,
               const TextRule& rule, std::string& out, std::vector<Fault>& faults);

// Reads one object and writes down every fault of it: wrong types, missing keys, values out of range, and (in
// refuse_unknown, which every reader calls last) keys that nobody asked for. Nothing is clamped or converted.
class ObjectReader {
 public:
  // A value that is no object is a fault, after which nothing is read and nothing more is said.
  // passed_over: where given, keys that nobody asked for are written down there by their pointers instead of
  // being faults (see refuse_unknown), in this object and in those within it.
  ObjectReader(const JsonValue& value, std::string pointer, std::vector<Fault>& faults,
               std::vector<std::string>* passed_over = nullptr);

  bool is_object() const { return object_ != nullptr; }
  const std::string& pointer() const { return pointer_; }
  std::vector<Fault>& faults() const { return faults_; }

  // Each returns whether `out` was set.
  bool number(std::string_view key, Presence presence, const NumberRule& rule, double& out);
  bool number(std::string_view key, Presence presence, const NumberRule& rule, std::optional<double>& out);
  // Given in degrees, kept in radians.
  bool angle_deg(std::string_view key, Presence presence, const NumberRule& rule_deg, double& out_rad);
  bool angle_deg(std::string_view key, Presence presence, const NumberRule& rule_deg,
                 std::optional<double>& out_rad);
  template <class Integer>
  bool whole(std::string_view key, Presence presence, Integer lowest, Integer highest, Integer& out) {
    double number = 0.0;
    if (!whole_number(key, presence, static_cast<double>(lowest), static_cast<double>(highest), number))
      return false;
    out = static_cast<Integer>(number);
    return true;
  }
  bool text(std::string_view key, Presence presence, const TextRule& rule, std::string& out);
  bool boolean(std::string_view key, Presence presence, bool& out);
  // The text must be one of `allowed`; out is its index.
  bool choice(std::string_view key, Presence presence, const std::vector<std::string_view>& allowed,
              std::size_t& out);

  // The raw member, for what this class does not know; nullptr where absent (a fault when required).
  const JsonValue* member(std::string_view key, Presence presence);
  std::optional<ObjectReader> object(std::string_view key, Presence presence);
  // An element of a list as an object, read as this one is.
  ObjectReader object(const Element& element) const;
  // Empty where absent or refused.
  std::vector<Element> list(std::string_view key, Presence presence, const CountRule& rule);
  bool numbers(std::string_view key, Presence presence, const CountRule& count, const NumberRule& rule,
               std::vector<double>& out);
  bool texts(std::string_view key, Presence presence, const CountRule& count, const TextRule& rule,
             std::vector<std::string>& out);

  void fault(std::string_view key, std::string message);
  // Faults for the keys that were not asked for, each with the nearest known one. Where such keys may be
  // passed over, only for those that look like a required one that is missing.
  void refuse_unknown();

 private:
  bool whole_number(std::string_view key, Presence presence, double lowest, double highest, double& out);

  const JsonValue* object_ = nullptr;
  std::string pointer_;
  std::vector<Fault>& faults_;
  std::vector<std::string>* passed_over_ = nullptr;
  std::vector<std::string> known_;
  std::vector<std::string> missing_;  // of the required ones
};

}  // namespace slipway::api::json
