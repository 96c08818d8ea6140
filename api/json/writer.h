#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "api/json/json_value.h"

namespace slipway::api::json {

// Writes one JSON document in the order of the calls, so that the same values give the same bytes. A number
// that is not finite throws std::domain_error with its key, since no answer may hold NaN or a null in its
// place. What is no UTF-8 in a text is written as U+FFFD.
class Writer {
 public:
  Writer& begin_object();
  Writer& end_object();
  Writer& begin_array();
  Writer& end_array();
  Writer& key(std::string_view name);

  Writer& text(std::string_view value);
  Writer& boolean(bool value);
  Writer& null();
  Writer& whole(std::int64_t value);
  Writer& exact(double value);         // with the fewest digits that read back as the same double
  Writer& significant(double value);   // six significant digits
  Writer& metres(double value);        // to a millimetre: map coordinates and heights
  Writer& raw(std::string_view json);  // a whole JSON value

  Writer& angle_deg(double rad);  // in degrees with twelve digits, so that 25 deg in a request is 25 again

  // key and value
  Writer& text(std::string_view name, std::string_view value) { return key(name).text(value); }
  Writer& boolean(std::string_view name, bool value) { return key(name).boolean(value); }
  Writer& whole(std::string_view name, std::int64_t value) { return key(name).whole(value); }
  Writer& exact(std::string_view name, double value) { return key(name).exact(value); }
  Writer& significant(std::string_view name, double value) { return key(name).significant(value); }
  Writer& metres(std::string_view name, double value) { return key(name).metres(value); }
  Writer& angle_deg(std::string_view name, double rad) { return key(name).angle_deg(rad); }
  Writer& texts(std::string_view name, const std::vector<std::string>& values);

  // What was written since the last call.
  std::string take() { return std::exchange(out_, {}); }

 private:
  void separate();
  void finite(double value) const;

  std::string out_;
  std::string last_key_;
  bool first_ = true;  // no member or element has been written in this object or array
};

// Writes a document in memory.
void write_value(Writer& w, const JsonValue& value);

}  // namespace slipway::api::json
