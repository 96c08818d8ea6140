#include "sky/mars_time.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

#include "core/angle.h"
#include "sky/orientation.h"
#include "sky/planets.h"

namespace slipway::sky {
namespace {

constexpr double kDayMs = 86'400'000.0, kDay_s = 86'400.0;
constexpr double kJ2000UnixDays = 10957.5;  // of noon, 1 January 2000

// From these days since 1970 on, TAI is so many seconds ahead of UTC [IERS Bulletin C].
struct LeapSecond {
  int from_day;
  double tai_less_utc_s;
};
constexpr std::array<LeapSecond, 28> kLeapSeconds{
    {{730, 10},   {912, 11},   {1096, 12},  {1461, 13},  {1826, 14},  {2191, 15},  {2557, 16},
     {2922, 17},  {3287, 18},  {3652, 19},  {4199, 20},  {4564, 21},  {4929, 22},  {5660, 23},
     {6574, 24},  {7305, 25},  {7670, 26},  {8217, 27},  {8582, 28},  {8947, 29},  {9496, 30},
     {10043, 31}, {10592, 32}, {13149, 33}, {14245, 34}, {15522, 35}, {16617, 36}, {17167, 37}}};

double turned(double degrees) {
  const double left = std::fmod(degrees, 360.0);
  return left < 0.0 ? left + 360.0 : left;
}

double hours(double any) {
  return turned(15.0 * any) / 15.0;
}

// What the other planets pull the sun's longitude by [deg], at days since J2000.
double perturbation_deg(double days) {
  struct Term {
    double amplitude_deg, period_years, phase_deg;
  };
  constexpr std::array<Term, 7> kTerms{{{0.0071, 2.2353, 49.409},
                                        {0.0057, 2.7543, 168.173},
                                        {0.0039, 1.1177, 191.837},
                                        {0.0037, 15.7866, 21.736},
                                        {0.0021, 2.1354, 15.704},
                                        {0.0020, 2.4694, 95.528},
                                        {0.0018, 32.8493, 49.095}}};
  double sum = 0.0;
  for (const Term& term : kTerms)
    sum += term.amplitude_deg * std::cos(rad_from_deg(0.985626 * days / term.period_years + term.phase_deg));
  return sum;
}

// The orbit of Mars about the sun.
struct Orbit {
  double season_deg = 0.0;
  double equation_of_time_deg = 0.0;
  double distance_au = 0.0;
};

Orbit orbit_at(double days) {
  const double mean = rad_from_deg(19.3871 + 0.52402073 * days);
  const double fictitious_deg = 270.3871 + 0.524038496 * days;
  const double centre_deg = (10.691 + 3.0e-7 * days) * std::sin(mean) + 0.623 * std::sin(2.0 * mean) +
                            0.050 * std::sin(3.0 * mean) + 0.005 * std::sin(4.0 * mean) +
                            0.0005 * std::sin(5.0 * mean) + perturbation_deg(days);
  const double season = rad_from_deg(fictitious_deg + centre_deg);
  return {turned(fictitious_deg + centre_deg),
          2.861 * std::sin(2.0 * season) - 0.071 * std::sin(4.0 * season) + 0.002 * std::sin(6.0 * season) -
              centre_deg,
          1.52367934 * (1.00436 - 0.09309 * std::cos(mean) - 0.004336 * std::cos(2.0 * mean) -
                        0.00031 * std::cos(3.0 * mean) - 0.00003 * std::cos(4.0 * mean))};
}

}  // namespace

double terrestrial_days(std::int64_t utc_ms) {
  const double days = static_cast<double>(utc_ms) / kDayMs;
  const auto* next = std::upper_bound(kLeapSeconds.begin(), kLeapSeconds.end(), days,
                                      [](double day, const LeapSecond& leap) { return day < leap.from_day; });
  const double since = days - kJ2000UnixDays;
  if (next != kLeapSeconds.begin()) return since + (std::prev(next)->tai_less_utc_s + 32.184) / kDay_s;
  const double t = since / 36525.0;  // before there were leap seconds: the polynomial of Mars24
  return since + (64.184 + t * (59.0 + t * (-51.2 + t * (-67.1 - 16.4 * t)))) / kDay_s;
}

MarsTime mars_time(std::int64_t utc_ms, double east_longitude_rad) {
  const double days = terrestrial_days(utc_ms);
  const Orbit orbit = orbit_at(days);
  MarsTime time;
  time.sol_date = (days - 4.5) / 1.0274912517 + 44796.0 - 0.0009626;
  time.season_rad = rad_from_deg(orbit.season_deg);
  time.equation_of_time_h = orbit.equation_of_time_deg / 15.0;
  time.mean_solar_h =
      hours(24.0 * (time.sol_date - std::floor(time.sol_date)) + deg_from_rad(east_longitude_rad) / 15.0);
  time.true_solar_h = hours(time.mean_solar_h + time.equation_of_time_h);
  time.declination_rad = std::asin(0.42565 * std::sin(time.season_rad));
  time.sun_distance_au = orbit.distance_au;
  return time;
}

std::optional<std::string> why_not_known(std::int64_t utc_ms) {
  const std::chrono::sys_time<std::chrono::milliseconds> time{std::chrono::milliseconds(utc_ms)};
  const int year =
      static_cast<int>(std::chrono::year_month_day(std::chrono::floor<std::chrono::days>(time)).year());
  if (year >= 1800 && year <= 2150) return std::nullopt;
  return fmt::format("sun and Earth over Mars are computed from 1800 to 2150, not for the year {}", year);
}

Bearing mars_sun(std::int64_t utc_ms, double east_longitude_rad, double latitude_rad) {
  const MarsTime time = mars_time(utc_ms, east_longitude_rad);
  // The sun stands over the meridian at 12 h, and goes on to the west.
  const double over = east_longitude_rad - rad_from_deg(15.0 * (time.true_solar_h - 12.0));
  const double level = std::cos(time.declination_rad);
  const Eigen::Vector3d sun(level * std::cos(over), level * std::sin(over), std::sin(time.declination_rad));
  return bearing_of(level_frame(east_longitude_rad, latitude_rad, kMarsPolar) * sun);
}

Bearing mars_earth(std::int64_t utc_ms, double east_longitude_rad, double latitude_rad) {
  constexpr double kLightDaysPerAu = 499.004784 / kDay_s, kAu_m = 149'597'870'700.0;
  const double days = terrestrial_days(utc_ms);
  const Eigen::Matrix3d fixed = mars_orientation().fixed(days);
  const Eigen::Vector3d eye =
      from_sun_au(Planet::kMars, days) +
      fixed.transpose() * on_ellipsoid(east_longitude_rad, latitude_rad, kMarsRadius_m / kAu_m, kMarsPolar);
  Eigen::Vector3d away = from_sun_au(Planet::kEarth, days) - eye;
  for (int k = 0; k < 3; ++k) away = from_sun_au(Planet::kEarth, days - kLightDaysPerAu * away.norm()) - eye;
  const Eigen::Vector3d a_day =
      from_sun_au(Planet::kMars, days + 0.5) - from_sun_au(Planet::kMars, days - 0.5);
  return bearing_of(level_frame(east_longitude_rad, latitude_rad, kMarsPolar) * fixed *
                    (away.normalized() + kLightDaysPerAu * a_day));
}

}  // namespace slipway::sky
