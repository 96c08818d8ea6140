#include "api/report/day_words.h"

#include <fmt/format.h>

#include "api/json/lookup.h"
#include "core/utc.h"
#include "planner/timing/departures.h"

namespace slipway::api {
namespace {

using json::at;
using json::has;
using json::JsonValue;
using json::number;
using json::text;

const JsonValue* rule_of(const JsonValue& drive, std::string_view name) {
  for (const JsonValue& rule : at(drive, "rules").elements)
    if (text(rule, "rule") == name) return &rule;
  return nullptr;
}

// Where the battery is empty: at the first station at which it is; where none of them knows it, where the
// rule breaks. Nothing where it never is.
std::optional<double> empty_at_m(const JsonValue& drive, std::string_view least, std::string_view along) {
  if (!(number(drive, least) < 0.0)) return std::nullopt;
  for (const JsonValue& station : at(drive, "stations").elements)
    if (number(station, along) <= 0.0) return number(station, "distance_m");
  const JsonValue* const rule = rule_of(drive, "charge");
  return rule != nullptr && has(*rule, "at_m") ? number(*rule, "at_m") : 0.0;
}

}  // namespace

std::int64_t time_of(const JsonValue& object, std::string_view key) {
  return utc_of_text(text(object, key)).value_or(0);
}

planner::DepartureWindow told_window(const JsonValue& window) {
  return planner::to_the_minute({time_of(window, "from"), time_of(window, "to")});
}

std::string battery_words(const JsonValue& drive, int decimals) {
  const auto usual_m = empty_at_m(drive, "least_charge_percent", "charge_percent");
  const auto low_m = empty_at_m(drive, "least_charge_low_percent", "charge_low_percent");
  std::string words = usual_m ? fmt::format("the battery is empty at {:.1f} m", *usual_m)
                              : fmt::format("the battery holds {:.{}f} % at the arrival",
                                            number(drive, "charge_percent"), decimals);
  words += low_m
               ? fmt::format(" ({}at {:.1f} m at the worse pace)", usual_m ? "" : "empty ", *low_m)
               : fmt::format(" ({:.{}f} % at the worse pace)", number(drive, "charge_low_percent"), decimals);
  return words;
}

std::optional<std::string> in_time_words(const JsonValue& drive) {
  const JsonValue* const rule = rule_of(drive, "arrival");
  if (rule == nullptr || text(*rule, "verdict") != "go") return std::nullopt;
  return text(*rule, "words");
}

}  // namespace slipway::api
