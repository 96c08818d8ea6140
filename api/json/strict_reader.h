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

// Whether the key must be present. An absent optional key leaves its target unchanged, so that the default
// stands only in the struct that is read into.
enum class Presence { kRequired, kOptional };
constexpr Presence kRequired = Presence::kRequired;
constexpr Presence kOptional = Presence::kOptional;

// The range of a number, in the unit of the document.
struct NumberRule {
  std::string_view unit;  // messages show none for "" or "1"
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

// Reads a number or text. Returns false where it added a fault ("slope_deg = 212 deg, must be in [0, 60]")
// and left `out` unchanged.
bool read_number(const JsonValue& value, const std::string& pointer, std::string_view label,
                 const NumberRule& rule, double& out, std::vector<Fault>& faults);
bool read_text(const JsonValue& value, const std::string& pointer, std::string_view label,
               const TextRule& rule, std::string& out, std::vector<Fault>& faults);

// Reads one object and collects all its faults: wrong types, missing keys, values out of range, and (in
// refuse_unknown, which every reader calls last) unknown keys. Nothing is clamped or converted.
class ObjectReader {
 public:
  // A value that is no object is one fault; nothing is read from it and no other fault is added.
  // Where passed_over is given, unknown keys of this object and of those within it are listed there by their
  // pointers instead of being faults (see refuse_unknown).
  ObjectReader(const JsonValue& value, std::string pointer, std::vector<Fault>& faults,
               std::vector<std::string>* passed_over = nullptr);

  bool is_object() const { return object_ != nullptr; }
  const std::string& pointer() const { return pointer_; }
  std::vector<Fault>& faults() const { return faults_; }

  // Each of these returns whether `out` was set.
  bool number(std::string_view key, Presence presence, const NumberRule& rule, double& out);
  bool number(std::string_view key, Presence presence, const NumberRule& rule, std::optional<double>& out);
  // The document has degrees; `out_rad` gets radians.
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
  // The text must be one of `allowed`; `out` gets its index.
  bool choice(std::string_view key, Presence presence, const std::vector<std::string_view>& allowed,
              std::size_t& out);

  // The member itself, for readers of other types; nullptr where it is absent, which is a fault when
  // required.
  const JsonValue* member(std::string_view key, Presence presence);
  std::optional<ObjectReader> object(std::string_view key, Presence presence);
  // An element of a list as an object, read as this one is.
  ObjectReader object(const Element& element) const;
  // The elements of a list; empty where the list is absent or refused.
  std::vector<Element> list(std::string_view key, Presence presence, const CountRule& rule);
  bool numbers(std::string_view key, Presence presence, const CountRule& count, const NumberRule& rule,
               std::vector<double>& out);
  bool texts(std::string_view key, Presence presence, const CountRule& count, const TextRule& rule,
             std::vector<std::string>& out);

  void fault(std::string_view key, std::string message);
  // Adds a fault for each unknown key, with the nearest known one. Where unknown keys may be passed over,
  // only those that look like a missing required key are faults.
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
