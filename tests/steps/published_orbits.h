#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstdlib>

#include "core/angle.h"

// Where sun, Moon and planets are by published series, in km and the equator of J2000, at TDB seconds past
// J2000. Nothing here is the product's.
namespace slipway::steps::published {

constexpr double kAu_km = 149'597'870.7;
constexpr double kCentury_s = 36525.0 * 86400.0;

inline std::array<double, 3> array_of(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

// From the ecliptic and equinox of date to the equator of J2000 [Meeus, Astronomical Algorithms, 22.2 and
// 21.2].
inline Eigen::Vector3d from_ecliptic_of_date(double longitude_deg, double latitude_deg, double distance,
                                             double centuries) {
  const double l = rad_from_deg(longitude_deg), b = rad_from_deg(latitude_deg), t = centuries;
  const Eigen::Vector3d ecliptic(std::cos(b) * std::cos(l), std::cos(b) * std::sin(l), std::sin(b));
  const double obliquity = 23.4392911 + (-46.8150 * t - 0.00059 * t * t) / 3600.0;
  const double zeta = (2306.2181 * t + 0.30188 * t * t) / 3600.0,
               z = (2306.2181 * t + 1.09468 * t * t) / 3600.0;
  const double theta = (2004.3109 * t - 0.42665 * t * t) / 3600.0;
  using Eigen::AngleAxisd, Eigen::Vector3d;
  return distance * (AngleAxisd(-rad_from_deg(zeta), Vector3d::UnitZ()) *
                     AngleAxisd(rad_from_deg(theta), Vector3d::UnitY()) *
                     AngleAxisd(-rad_from_deg(z), Vector3d::UnitZ()) *
                     AngleAxisd(rad_from_deg(obliquity), Vector3d::UnitX()) * ecliptic);
}

struct EclipticPlace {
  double longitude_deg, latitude_deg, distance_km;
};

// The Moon from the Earth: the terms of Meeus' tables 47.A and 47.B above 0.0017 deg.
inline EclipticPlace moon_of_date(double centuries) {
  struct Longitude {
    int d, m, moon, f;
    double sine, cosine;
  };
  static constexpr std::array<Longitude, 32> kLongitudes{
      {{0, 0, 1, 0, 6288774, -20905355}, {2, 0, -1, 0, 1274027, -3699111}, {2, 0, 0, 0, 658314, -2955968},
       {0, 0, 2, 0, 213618, -569925},    {0, 1, 0, 0, -185116, 48888},     {0, 0, 0, 2, -114332, -3149},
       {2, 0, -2, 0, 58793, 246158},     {2, -1, -1, 0, 57066, -152138},   {2, 0, 1, 0, 53322, -170733},
       {2, -1, 0, 0, 45758, -204586},    {0, 1, -1, 0, -40923, -129620},   {1, 0, 0, 0, -34720, 108743},
       {0, 1, 1, 0, -30383, 104755},     {2, 0, 0, -2, 15327, 10321},      {0, 0, 1, 2, -12528, 0},
       {0, 0, 1, -2, 10980, 79661},      {4, 0, -1, 0, 10675, -34782},     {0, 0, 3, 0, 10034, -23210},
       {4, 0, -2, 0, 8548, -21636},      {2, 1, -1, 0, -7888, 24208},      {2, 1, 0, 0, -6766, 30824},
       {1, 0, -1, 0, -5163, -8379},      {1, 1, 0, 0, 4987, -16675},       {2, -1, 1, 0, 4036, -12831},
       {2, 0, 2, 0, 3994, -10445},       {4, 0, 0, 0, 3861, -11650},       {2, 0, -3, 0, 3665, 14403},
       {0, 1, -2, 0, -2689, -7003},      {2, 0, -1, 2, -2602, 0},          {2, -1, -2, 0, 2390, 10056},
       {1, 0, 1, 0, -2348, 6322},        {2, -2, 0, 0, 2236, -9884}}};
  struct Latitude {
    int d, m, moon, f;
    double sine;
  };
  static constexpr std::array<Latitude, 20> kLatitudes{
      {{0, 0, 0, 1, 5128122}, {0, 0, 1, 1, 280602},  {0, 0, 1, -1, 277693}, {2, 0, 0, -1, 173237},
       {2, 0, -1, 1, 55413},  {2, 0, -1, -1, 46271}, {2, 0, 0, 1, 32573},   {0, 0, 2, 1, 17198},
       {2, 0, 1, -1, 9266},   {0, 0, 2, -1, 8822},   {2, -1, 0, -1, 8216},  {2, 0, -2, -1, 4324},
       {2, 0, 1, 1, 4200},    {2, 1, 0, -1, -3359},  {2, -1, -1, 1, 2463},  {2, -1, 0, 1, 2211},
       {2, -1, -1, -1, 2065}, {0, 1, -1, -1, -1870}, {4, 0, -1, -1, 1828},  {0, 1, 0, 1, -1794}}};
  const double t = centuries;
  const double mean = 218.3164477 + 481267.88123421 * t - 0.0015786 * t * t;
  const double d = 297.8501921 + 445267.1114034 * t - 0.0018819 * t * t;
  const double m = 357.5291092 + 35999.0502909 * t - 0.0001536 * t * t;
  const double moon = 134.9633964 + 477198.8675055 * t + 0.0087414 * t * t;
  const double f = 93.2720950 + 483202.0175233 * t - 0.0036539 * t * t;
  const double e = 1.0 - 0.002516 * t - 0.0000074 * t * t;
  const auto angle = [&](const auto& term) {
    return rad_from_deg(term.d * d + term.m * m + term.moon * moon + term.f * f);
  };
  const auto sine = [](double degrees) { return std::sin(rad_from_deg(degrees)); };
  const double venus = 119.75 + 131.849 * t, jupiter = 53.09 + 479264.290 * t, flat = 313.45 + 481266.484 * t;
  double l = 3958.0 * sine(venus) + 1962.0 * sine(mean - f) + 318.0 * sine(jupiter), r = 0.0;
  double b = -2235.0 * sine(mean) + 382.0 * sine(flat) + 175.0 * sine(venus - f) + 175.0 * sine(venus + f) +
             127.0 * sine(mean - moon) - 115.0 * sine(mean + moon);
  for (const Longitude& term : kLongitudes) {
    const double share = std::pow(e, std::abs(term.m));
    l += share * term.sine * std::sin(angle(term));
    r += share * term.cosine * std::cos(angle(term));
  }
  for (const Latitude& term : kLatitudes)
    b += std::pow(e, std::abs(term.m)) * term.sine * std::sin(angle(term));
  return {mean + 1e-6 * l, 1e-6 * b, 385'000.56 + 1e-3 * r};
}

inline std::array<double, 3> moon_km(double et_s) {
  const double t = et_s / kCentury_s;
  const EclipticPlace moon = moon_of_date(t);
  return array_of(from_ecliptic_of_date(moon.longitude_deg, moon.latitude_deg, moon.distance_km, t));
}

// The Earth from the sun [Meeus, chapter 25, to 0.01 deg].
inline std::array<double, 3> earth_km(double et_s) {
  const double t = et_s / kCentury_s;
  const double anomaly_deg = 357.52911 + 35999.05029 * t - 0.0001537 * t * t;
  const double m = rad_from_deg(anomaly_deg);
  const double centre_deg = (1.914602 - 0.004817 * t - 0.000014 * t * t) * std::sin(m) +
                            (0.019993 - 0.000101 * t) * std::sin(2.0 * m) + 0.000289 * std::sin(3.0 * m);
  const double longitude_deg = 280.46646 + 36000.76983 * t + 0.0003032 * t * t + centre_deg;
  const double e = 0.016708634 - 0.000042037 * t;
  const double distance_au = 1.000001018 * (1.0 - e * e) / (1.0 + e * std::cos(m + rad_from_deg(centre_deg)));
  return array_of(-from_ecliptic_of_date(longitude_deg, 0.0, kAu_km * distance_au, t));
}

}  // namespace slipway::steps::published
