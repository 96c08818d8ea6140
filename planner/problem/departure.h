#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "dem/horizon/horizon.h"
#include "planner/problem/verdict.h"
#include "sky/mars_time.h"
#include "sky/sky.h"

namespace slipway::planner {

// What must hold from departure to arrival; of what is not asked for nothing is judged.
struct DepartureRules {
  std::optional<double> min_charge;       // of the battery, share of what it holds
  std::optional<double> min_sun_rad;      // over the level, and the sun over the ground's horizon
  std::optional<double> min_earth_rad;    // the same of the Earth
  std::optional<double> light_left_s;     // from the arrival to when the sun sets behind the ground's horizon
  std::optional<std::int64_t> arrive_by;  // ms of UTC since 1970
};

// The air over a day: warmest a twelfth of a day behind noon, as a cosine.
struct AirTemperature {
  double coldest_c = 0.0, warmest_c = 0.0;
};

// When a drive may begin, and under what sky. Times are milliseconds of UTC since 1970.
struct Departure {
  std::int64_t from_ms = 0, to_ms = 0;
  double every_s = 900.0;      // between the departures that are told of; the rules are looked at each minute
  double charge = 1.0;         // of the battery at the departure, share of what it holds
  double optical_depth = 0.0;  // of the atmosphere
  std::optional<AirTemperature> air = {};
  std::int64_t noon_ms = 0;   // when the sun stands highest, of any day; where there is air
  bool noon_is_known = true;  // otherwise what hangs on the hour's air is open
  DepartureRules rules;
  std::shared_ptr<const sky::Sky> sky;
  std::shared_ptr<const dem::Horizon> horizon;
  double day_s = sky::kSol_s;  // a solar day of the body
};

// A drive from one departure on. Where slip has an interval: at the pace and the energy that a share of the
// draws stay below.
struct TimedStation {
  double distance_m = 0.0;
  std::int64_t utc_ms = 0, late_ms = 0;  // at the 50th and the 95th percentile of the draws
  double sun_over_horizon_rad = 0.0;
  bool is_lit = false;
  double in_w = 0.0, out_w = 0.0;
  double charge = 1.0,
         charge_low = 1.0;  // at the 50th percentile of the draws, and at the worse of it and the 95th
  // Of the drive motor that is worked hardest, degC: at the 50th and at the 95th percentile. Nothing where
  // the air or the motor is not known, see motor_warmth.h.
  std::optional<double> motor_c = {}, motor_slow_c = {};
};

struct TimedDrive {
  std::int64_t departs_ms = 0;
  std::int64_t arrives_ms = 0, arrives_late_ms = 0;  // at the 50th and the 95th percentile of the draws
  double charge_at_arrival = 1.0, charge_at_arrival_low = 1.0;
  double least_charge = 1.0, least_charge_low = 1.0;
  double lit_share = 0.0;  // of the time
  // In Wh: charge at the start + gained - used - spilled = charge at the end. Spilled: what a full battery
  // can't take.
  double gained_wh = 0.0, used_wh = 0.0, spilled_wh = 0.0;
  std::vector<TimedStation> stations;  // as far as the sun is known
  std::vector<JudgedRule> rules;
};

struct DepartureWindow {
  std::int64_t from_ms = 0, to_ms = 0;
};

// A halt on the way to let the battery charge.
struct ChargingHalt {
  double at_m = 0.0;
  double hours = 0.0;
};

// What the times of day make of one route.
struct Departures {
  std::vector<DepartureWindow> windows;  // in which all rules hold
  // Of those in windows the one with most in the battery at the arrival, at the worse pace; without a window
  // the one that `halt` makes keep the rules and that arrives first; without either what fails least.
  TimedDrive drive;
  std::optional<ChargingHalt> halt = {};
  std::vector<TimedDrive> tried;  // without stations, by rising departure, as often as asked for

  bool is_kept() const { return !windows.empty() || halt; }  // `drive` keeps the rules
};

}  // namespace slipway::planner
