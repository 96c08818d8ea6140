#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "sky/bearing.h"

// Time, sun and Earth on Mars. The sun and the clock are those of Allison and McEwen, A post-Pathfinder
// evaluation of areocentric solar coordinates with improved timing recipes for Mars seasonal/diurnal climate
// studies, Planet. Space Sci. 48, 2000, with the constants that Mars24 publishes: the sun stands within 0.01
// deg of where JPL's ephemeris has it from 2004 to 2050, within 0.016 deg from 1874 to 2127 and 0.03 deg from
// 1800 to 2150.
namespace slipway::sky {

// Days of terrestrial time since J2000, of milliseconds of UTC since 1970. Leap seconds are those up to 2017,
// of which none has followed yet; before 1972 the difference of the times is the polynomial of Mars24.
double terrestrial_days(std::int64_t utc_ms);

inline constexpr double kSol_s = 88'775.244;  // a mean solar day of Mars

// Time at a place on Mars.
struct MarsTime {
  double sol_date = 0.0;            // Mars sol date: sols at the prime meridian since 29 December 1873
  double season_rad = 0.0;          // areocentric solar longitude Ls, [0, 2 pi)
  double mean_solar_h = 0.0;        // local mean solar time, [0, 24)
  double true_solar_h = 0.0;        // local true solar time, [0, 24)
  double equation_of_time_h = 0.0;  // true less mean solar time
  double declination_rad = 0.0;     // of the sun, planetocentric
  double sun_distance_au = 0.0;
};
MarsTime mars_time(std::int64_t utc_ms, double east_longitude_rad);

// Why sun and Earth are not computed at a time; nothing from 1800 to 2150.
std::optional<std::string> why_not_known(std::int64_t utc_ms);

// The sun over a place, by its east longitude and planetocentric latitude. Elevations are over the level of
// the ellipsoid [Archinal et al. 2018: 3396.19 and 3376.20 km], not over the normal of a sphere: at middle
// latitudes these differ by a third of a degree.
Bearing mars_sun(std::int64_t utc_ms, double east_longitude_rad, double latitude_rad);

// The Earth over a place, by both planets' motions (planets.h) and the pole and rotation of Mars [Archinal et
// al. 2018], where its light comes from: good to 0.02 deg.
Bearing mars_earth(std::int64_t utc_ms, double east_longitude_rad, double latitude_rad);

}  // namespace slipway::sky
