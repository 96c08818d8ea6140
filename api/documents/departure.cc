#include "api/documents/departure.h"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <utility>

#include "api/documents/check_answer.h"
#include "api/json/faults.h"
#include "core/angle.h"
#include "core/utc.h"

namespace slipway::api::json {
namespace {

constexpr NumberRule kElevation{"deg", -90.0, 90.0}, kAzimuth{"deg", -360.0, 360.0},
    kPercent{"%", 0.0, 100.0};

bool read_time(ObjectReader& reader, std::string_view key, Presence presence, std::int64_t& out) {
  std::string text;
  if (!reader.text(key, presence, {.most = 40}, text)) return false;
  const auto ms = utc_of_text(text);
  if (ms)
    out = *ms;
  else
    reader.fault(key,
                 fmt::format("{} = {} is no time of UTC such as 2026-07-01T12:00:00Z", key, in_quotes(text)));
  return ms.has_value();
}

void read_rules(ObjectReader& object, planner::DepartureRules& rules) {
  std::optional<double> percent, hours;
  object.number("min_charge_percent", kOptional, kPercent, percent);
  if (percent) rules.min_charge = 0.01 * *percent;
  object.angle_deg("min_sun_deg", kOptional, kElevation, rules.min_sun_rad);
  object.angle_deg("min_earth_deg", kOptional, kElevation, rules.min_earth_rad);
  object.number("light_left_h", kOptional, {"h", 0.0, 1000.0}, hours);
  if (hours) rules.light_left_s = 3600.0 * *hours;
  if (std::int64_t at = 0; read_time(object, "arrive_by", kOptional, at)) rules.arrive_by = at;
}

// `has_times`: the first and the last departure are known.
void read_sky(ObjectReader& object, bool has_times, DepartureRequest& departure) {
  const std::vector<Element> moments = object.list("sky", kOptional, {0, RequestLimits::kSkyMoments});
  // The rows of a list that is too short are read all the same, so that no fault hides another.
  const JsonValue* const given = object.member("sky", kOptional);
  const bool is_short = given != nullptr && given->is(JsonValue::Kind::kArray) && given->elements.size() < 2;
  if (is_short)
    object.fault("sky", fmt::format("sky has {} elements, must have {} to {}", given->elements.size(), 2,
                                    RequestLimits::kSkyMoments));
  const std::size_t before = object.faults().size();
  std::size_t with_earth = 0;
  for (const Element& element : moments) {
    ObjectReader moment = object.object(element);
    sky::SkySample sample;
    read_time(moment, "at", kRequired, sample.utc_ms);
    moment.angle_deg("sun_azimuth_deg", kRequired, kAzimuth, sample.sun.azimuth_rad);
    moment.angle_deg("sun_elevation_deg", kRequired, kElevation, sample.sun.elevation_rad);
    sky::Bearing earth;
    const bool azimuth = moment.angle_deg("earth_azimuth_deg", kOptional, kAzimuth, earth.azimuth_rad);
    const bool elevation =
        moment.angle_deg("earth_elevation_deg", kOptional, kElevation, earth.elevation_rad);
    if (azimuth != elevation)
      moment.fault(azimuth ? "earth_elevation_deg" : "earth_azimuth_deg",
                   "the Earth's direction has an azimuth and an elevation");
    if (azimuth && elevation) sample.earth = earth;
    moment.number("sun_distance_au", kOptional, {"au", 0.1, 100.0}, sample.sun_distance_au);
    with_earth += sample.earth ? 1 : 0;
    moment.refuse_unknown();
    if (object.faults().size() == before && !departure.table.empty() &&
        sample.utc_ms <= departure.table.back().utc_ms)
      moment.fault("at", "the moments of a sky must rise in time");
    constexpr double kWidestCos = -0.999;  // between two directions almost opposite lies no great circle
    const auto are_opposite = [](const sky::Bearing& a, const sky::Bearing& b) {
      return sky::towards(a).dot(sky::towards(b)) < kWidestCos;
    };
    if (!departure.table.empty() && object.faults().size() == before) {
      const sky::SkySample& last = departure.table.back();
      if (are_opposite(last.sun, sample.sun) ||
          (last.earth && sample.earth && are_opposite(*last.earth, *sample.earth)))
        moment.fault("at", "a direction is opposite to that of the moment before: give moments between them");
    }
    departure.table.push_back(sample);
  }
  if (object.faults().size() != before || is_short || moments.empty()) return;
  if (with_earth != 0 && with_earth != moments.size())
    object.fault("sky", "all moments have the Earth's direction, or none");
  if (departure.rules.min_earth_rad && with_earth == 0)
    object.fault("sky", "min_earth_deg needs the Earth's direction at every moment");
  if (!has_times) return;
  if (departure.from_ms < departure.table.front().utc_ms || departure.to_ms > departure.table.back().utc_ms)
    object.fault(
        "sky",
        fmt::format("must cover the departures: its moments run from {} to {}, the departures from {} to {}",
                    utc_words(departure.table.front().utc_ms), utc_words(departure.table.back().utc_ms),
                    utc_words(departure.from_ms), utc_words(departure.to_ms)));
}

void write_time(Writer& w, std::string_view key, std::int64_t ms) {
  w.text(key, utc_text(ms));
}

void write_drive(Writer& w, const planner::TimedDrive& drive) {
  write_time(w, "departs", drive.departs_ms);
  write_time(w, "arrives", drive.arrives_ms);
  write_time(w, "arrives_late", drive.arrives_late_ms);
  w.significant("charge_percent", 100.0 * drive.charge_at_arrival);
  w.significant("charge_low_percent", 100.0 * drive.charge_at_arrival_low);
  w.significant("least_charge_percent", 100.0 * drive.least_charge);
  w.significant("least_charge_low_percent", 100.0 * drive.least_charge_low);
  w.significant("lit_share", drive.lit_share);
  w.significant("gained_wh", drive.gained_wh).significant("used_wh", drive.used_wh);
  w.significant("spilled_wh", drive.spilled_wh);
  const auto names_of = [&](planner::Verdict verdict) {
    std::vector<std::string> names;
    for (const planner::JudgedRule& rule : drive.rules)
      if (rule.verdict == verdict) names.push_back(rule.name);
    return names;
  };
  w.texts("broken", names_of(planner::Verdict::kNoGo)).texts("open", names_of(planner::Verdict::kUnknown));
}

void write_drive_with_stations(Writer& w, const planner::TimedDrive& drive) {
  w.begin_object();
  write_drive(w, drive);
  w.key("rules").begin_array();
  for (const planner::JudgedRule& rule : drive.rules) write_judged_rule(w, rule);
  w.end_array();
  w.key("stations").begin_array();
  for (const planner::TimedStation& at : drive.stations) {
    w.begin_object().metres("distance_m", at.distance_m);
    write_time(w, "at", at.utc_ms);
    w.boolean("lit", at.is_lit).angle_deg("sun_over_horizon_deg", at.sun_over_horizon_rad);
    w.significant("in_w", at.in_w).significant("out_w", at.out_w);
    w.significant("charge_percent", 100.0 * at.charge)
        .significant("charge_low_percent", 100.0 * at.charge_low);
    if (at.motor_c && at.motor_slow_c)
      w.significant("motor_c", *at.motor_c).significant("motor_slow_c", *at.motor_slow_c);
    w.end_object();
  }
  w.end_array().end_object();
}

}  // namespace

void read_departure(ObjectReader& reader, std::optional<DepartureRequest>& out) {
  auto object = reader.object("departure", kOptional);
  if (!object) return;
  DepartureRequest departure;
  const bool from = read_time(*object, "from", kRequired, departure.from_ms);
  departure.to_ms = departure.from_ms;
  const bool to = read_time(*object, "to", kOptional, departure.to_ms);
  double minutes = departure.every_s / 60.0;
  object->number("every_min", kOptional, {"min", 0.1, 1e5}, minutes);
  departure.every_s = 60.0 * minutes;
  double percent = 100.0;
  object->number("charge_percent", kOptional, kPercent, percent);
  departure.charge = 0.01 * percent;
  object->number("optical_depth", kOptional, {"1", 0.0, 20.0}, departure.optical_depth);
  if (auto air = object->object("air", kOptional)) {
    planner::AirTemperature& celsius = departure.air.emplace();
    const bool coldest = air->number("coldest_c", kRequired, {"degC", -273.0, 200.0}, celsius.coldest_c);
    const bool warmest = air->number("warmest_c", kRequired, {"degC", -273.0, 200.0}, celsius.warmest_c);
    if (coldest && warmest && celsius.coldest_c > celsius.warmest_c)
      air->fault("coldest_c", "is above warmest_c");
    air->refuse_unknown();
  }
  read_rules(*object, departure.rules);
  if (from && to && departure.to_ms < departure.from_ms) object->fault("to", "is before from");
  if (from && departure.rules.arrive_by && *departure.rules.arrive_by <= departure.from_ms)
    object->fault("arrive_by", "is not behind from: no drive arrives before it departs");
  const double days = static_cast<double>(departure.to_ms - departure.from_ms) / 86.4e6;
  if (from && to && days > RequestLimits::kDepartureDays)
    object->fault("to", fmt::format("is {:.0f} days behind from, must be within {:.0f}", days,
                                    RequestLimits::kDepartureDays));
  const double tried = static_cast<double>(departure.to_ms - departure.from_ms) / 1000.0 / departure.every_s;
  if (from && tried > RequestLimits::kDepartures)
    object->fault(
        "every_min",
        fmt::format("{:.0f} departures are tried, must be at most {}: give every_min = {:.0f} or more", tried,
                    RequestLimits::kDepartures, std::ceil(minutes * tried / RequestLimits::kDepartures)));
  read_sky(*object, from, departure);
  object->refuse_unknown();
  out = std::move(departure);
}

void write_departure(Writer& w, const DepartureRequest& departure) {
  const planner::DepartureRules& rules = departure.rules;
  w.key("departure").begin_object();
  write_time(w, "from", departure.from_ms);
  write_time(w, "to", departure.to_ms);
  w.exact("every_min", departure.every_s / 60.0).exact("charge_percent", 100.0 * departure.charge);
  w.exact("optical_depth", departure.optical_depth);
  if (departure.air) {
    w.key("air").begin_object().exact("coldest_c", departure.air->coldest_c);
    w.exact("warmest_c", departure.air->warmest_c).end_object();
  }
  if (rules.min_charge) w.exact("min_charge_percent", 100.0 * *rules.min_charge);
  if (rules.min_sun_rad) w.angle_deg("min_sun_deg", *rules.min_sun_rad);
  if (rules.min_earth_rad) w.angle_deg("min_earth_deg", *rules.min_earth_rad);
  if (rules.light_left_s) w.exact("light_left_h", *rules.light_left_s / 3600.0);
  if (rules.arrive_by) write_time(w, "arrive_by", *rules.arrive_by);
  if (!departure.table.empty()) write_sky(w.key("sky"), departure.table);
  w.end_object();
}

void write_sky(Writer& w, const std::vector<sky::SkySample>& moments) {
  constexpr double kUsual_au = 1.0;
  w.begin_array();
  for (const sky::SkySample& moment : moments) {
    w.begin_object();
    write_time(w, "at", moment.utc_ms);
    w.angle_deg("sun_azimuth_deg", moment.sun.azimuth_rad);
    w.angle_deg("sun_elevation_deg", moment.sun.elevation_rad);
    if (moment.earth)
      w.angle_deg("earth_azimuth_deg", moment.earth->azimuth_rad)
          .angle_deg("earth_elevation_deg", moment.earth->elevation_rad);
    if (moment.sun_distance_au != kUsual_au) w.exact("sun_distance_au", moment.sun_distance_au);
    w.end_object();
  }
  w.end_array();
}

void write_departures(Writer& w, const planner::Departures& departures) {
  w.key("departures").begin_object().key("windows").begin_array();
  for (const planner::DepartureWindow& window : departures.windows) {
    w.begin_object();
    write_time(w, "from", window.from_ms);
    write_time(w, "to", window.to_ms);
    w.end_object();
  }
  w.end_array().key("best");
  if (departures.is_kept())
    write_drive_with_stations(w, departures.drive);
  else
    w.null();
  w.key("halt");
  if (departures.halt)
    w.begin_object()
        .metres("at_m", departures.halt->at_m)
        .significant("hours", departures.halt->hours)
        .end_object();
  else
    w.null();
  if (!departures.is_kept()) write_drive_with_stations(w.key("nearest"), departures.drive);
  w.key("tried").begin_array();
  for (const planner::TimedDrive& drive : departures.tried) {
    w.begin_object();
    write_drive(w, drive);
    w.end_object();
  }
  w.end_array().end_object();
}

}  // namespace slipway::api::json
