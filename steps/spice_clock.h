#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"

// Clocks, by NAIF's "Kernel", "SCLK" and "Time Required Reading".
namespace slipway::steps {

// How ephemeris time (TDB) runs beside terrestrial time (TDT): TDB - TDT = amplitude sin E, E = M +
// eccentricity sin M, M = anomaly + rate TDT. What a leap second kernel gives; these are the values of every
// one so far. Leap seconds themselves only tell UTC, which no step has.
struct EphemerisTime {
  double amplitude_s = 1.657e-3;
  double eccentricity = 1.671e-2;
  double anomaly_rad = 6.239996;
  double anomaly_rate_rad_s = 1.99096871e-7;

  double tdb_of(double tdt_s) const;
  double tdt_of(double tdb_s) const;
};

struct ClockCoefficients {
  double tick = 0.0;        // encoded
  double parallel_s = 0.0;  // the same moment in TDB or TDT
  double rate = 0.0;        // seconds of it in the most significant count of the clock, from here on
};

// A spacecraft clock of type 1.
struct SpacecraftClock {
  double ticks_per_count = 1.0;
  bool parallel_is_tdt = true;
  EphemerisTime ephemeris;
  std::vector<ClockCoefficients> coefficients;  // by rising ticks and times; not empty

  double et_of(double tick) const;
  double tick_of(double et_s) const;
};

// Whether a text kernel has coefficients of a spacecraft clock, or the constants of a leap second kernel.
bool looks_like_clock(std::string_view text);
bool looks_like_leap_seconds(std::string_view text);

// The clock of spacecraft -`id`. Errors: unreadable_data with the line or the name of what is wrong or
// missing.
Result<SpacecraftClock> read_spacecraft_clock(std::string_view text, std::string_view file, int id);

// Errors: the same.
Result<EphemerisTime> read_leap_seconds(std::string_view text, std::string_view file);

}  // namespace slipway::steps
