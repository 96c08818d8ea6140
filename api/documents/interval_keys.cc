#include "api/documents/interval_keys.h"

#include <cmath>

namespace slipway::api::json {

void write_interval_keys(Writer& w, const gap::Interval& interval, double unit) {
  if (std::isfinite(interval.value)) w.significant("value", unit * interval.value);
  if (std::isfinite(interval.low) && std::isfinite(interval.high) && interval.low <= interval.value &&
      interval.value <= interval.high)
    w.key("interval_90")
        .begin_array()
        .significant(unit * interval.low)
        .significant(unit * interval.high)
        .end_array();
}

void write_interval(Writer& w, std::string_view key, const gap::Interval& interval, double unit) {
  w.key(key).begin_object();
  write_interval_keys(w, interval, unit);
  w.end_object();
}

void write_finite(Writer& w, std::string_view key, double value) {
  if (std::isfinite(value)) w.significant(key, value);
}

}  // namespace slipway::api::json
