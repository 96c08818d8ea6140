// Sun and Earth out of kernels that are written here from published series.

#include "steps/kernel_sky.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/angle.h"
#include "core/utc.h"
#include "daf_writer.h"
#include "published_orbits.h"
#include "sky/mars_time.h"
#include "sky/planets.h"
#include "steps/spice_orientation.h"
#include "tests/sky/degrees_between.h"

namespace slipway::steps {
namespace {

constexpr double kDay_s = 86400.0;

std::int64_t at(const char* utc) {
  return utc_of_text(utc).value();
}

SkyPlace place(double east_deg, double north_deg) {
  return {rad_from_deg(east_deg), rad_from_deg(north_deg)};
}

std::array<double, 3> resting_km(double /*et_s*/) {
  return {0.0, 0.0, 0.0};
}

// Sun at rest, Earth about it and Moon about the Earth, from `first_day` since J2000 on for `days`.
std::string moon_kernel(double first_day, std::size_t days, bool big_endian = false) {
  const double first_s = kDay_s * first_day;
  return made::daf("DAF/SPK ",
                   {made::chebyshev(2, 10, 0, first_s, kDay_s, days, 2, resting_km),
                    made::chebyshev(3, 399, 10, first_s, kDay_s, days, 8, published::earth_km),
                    made::chebyshev(2, 301, 399, first_s, kDay_s, days, 10, published::moon_km)},
                   big_endian);
}

std::array<double, 3> planet_km(sky::Planet planet, double et_s) {
  return published::array_of(published::kAu_km * sky::from_sun_au(planet, et_s / kDay_s));
}

std::string mars_kernel(double first_day, std::size_t days) {
  const double first_s = kDay_s * first_day;
  return made::daf("DAF/SPK ",
                   {made::chebyshev(2, 10, 0, first_s, kDay_s, days, 2, resting_km),
                    made::chebyshev(2, 399, 10, first_s, kDay_s, days, 8,
                                    [](double et_s) { return planet_km(sky::Planet::kEarth, et_s); }),
                    made::chebyshev(2, 4, 10, first_s, kDay_s, days, 8,
                                    [](double et_s) { return planet_km(sky::Planet::kMars, et_s); })},
                   false);
}

Result<KernelSky> read(const std::vector<std::string>& files, std::string_view body) {
  std::vector<KernelBytes> kernels;
  for (const std::string& bytes : files) kernels.push_back({"kernel", bytes});
  return KernelSky::read(kernels, body);
}

std::string why(const Error& error) {
  std::string words = error.detail;
  for (const Fault& fault : error.faults) words += "; " + fault.pointer + ": " + fault.message;
  return words;
}

sky::SkySample over(const std::string& kernel, std::string_view body, const SkyPlace& place,
                    std::int64_t utc_ms) {
  const auto sky = read({kernel}, body);
  EXPECT_TRUE(sky) << why(sky.error());
  const auto sample = sky->over(place, utc_ms);
  EXPECT_TRUE(sample) << why(sample.error());
  return sample.value();
}

// Meeus, example 47.a: 12 April 1992, 0h TD. The terms that are left out make no more than 0.005 deg.
TEST(PublishedOrbits, HaveTheMoonWhereMeeusHasIt) {
  const auto moon = published::moon_of_date(-0.077221081451);
  EXPECT_NEAR(std::fmod(moon.longitude_deg, 360.0) + 360.0, 133.162655, 0.005);
  EXPECT_NEAR(moon.latitude_deg, -3.229126, 0.005);
  EXPECT_NEAR(moon.distance_km, 368409.7, 20.0);
}

// Meeus, example 53.a, the same moment: the Earth stands over -1.23 deg east, 4.20 deg north of the Moon
// (librations of the axis included), the sun over 67.89 deg east, 1.46 deg north. These count from the
// Moon's principal axes, for Meeus' rho and sigma hold the constant 0.0224 deg; the mean axes of maps stand
// so much beside them, about the axis through 90 deg east.
TEST(KernelSky, OfTheMoonHasEarthAndSunWhereMeeusHasThem) {
  constexpr double kTilt_deg = 0.0224;
  const std::string kernel = moon_kernel(-2823.0, 5);
  // TD was 58.184 s ahead of UTC.
  const std::int64_t then = at("1992-04-11T23:59:01.816Z");
  const auto under = [&](double east_deg, double north_deg) {
    return over(kernel, "Moon", place(east_deg, north_deg - kTilt_deg * std::cos(rad_from_deg(east_deg))),
                then);
  };
  const auto below_earth = under(-1.23, 4.20), below_sun = under(67.89, 1.46);
  ASSERT_TRUE(below_earth.earth);
  const double earth_deg = 90.0 - deg_from_rad(below_earth.earth->elevation_rad);
  const double sun_deg = 90.0 - deg_from_rad(below_sun.sun.elevation_rad);
  std::printf("Earth off by %.4f deg, sun by %.4f deg\n", earth_deg, sun_deg);
  EXPECT_LT(earth_deg, 0.02);
  EXPECT_LT(sun_deg, 0.02);
  // The sun's distance from the Earth was 1.0024977 au; the Moon was further out by its elongation.
  EXPECT_NEAR(below_sun.sun_distance_au, 1.0024977, 0.0026);
}

// Seen from the limb of the Moon the Earth stands lower than from its middle: by the Moon's radius.
TEST(KernelSky, SeesTheEarthFromTheSurface) {
  const std::string kernel = moon_kernel(-2823.0, 5);
  const std::int64_t then = at("1992-04-11T23:59:01.816Z");
  const auto limb = over(kernel, "Moon", place(-1.23 + 90.0, 0.0), then);
  const double parallax_deg = deg_from_rad(std::atan2(1737.4, 368409.7));
  EXPECT_NEAR(deg_from_rad(limb.earth->elevation_rad), -parallax_deg, 0.02);
}

// Allison and McEwen's sun, which knows nothing of planets.h, and the Earth of sky/mars_time.h, over places
// and years.
TEST(KernelSky, OfMarsIsThatOfTheFormulas) {
  double sun_deg = 0.0, earth_deg = 0.0, distance_au = 0.0;
  for (int k = 0; k < 60; ++k) {
    const double day = 6200.25 + 251.0 * k;  // 2016 to 2057
    const std::string kernel = mars_kernel(std::floor(day) - 1.0, 3);
    const std::int64_t then = at("2000-01-01T12:00:00Z") + std::llround(86.4e6 * day);
    const double east_deg = 37.0 * k, north_deg = -80.0 + 160.0 * (k % 9) / 8.0;
    const auto sample = over(kernel, "Mars", place(east_deg, north_deg), then);
    const double east = rad_from_deg(east_deg), north = rad_from_deg(north_deg);
    sun_deg = std::max(sun_deg, degrees_between(sample.sun, sky::mars_sun(then, east, north)));
    earth_deg = std::max(earth_deg, degrees_between(*sample.earth, sky::mars_earth(then, east, north)));
    distance_au =
        std::max(distance_au, std::abs(sample.sun_distance_au - sky::mars_time(then, east).sun_distance_au));
  }
  EXPECT_LT(sun_deg, 0.011);
  EXPECT_LT(earth_deg, 0.001);
  EXPECT_LT(distance_au, 0.001);
  std::printf("sun within %.4f deg, Earth within %.4f deg, %.5f au\n", sun_deg, earth_deg, distance_au);
}

// Light that comes from ahead is bent ahead: a body that goes at right angles to the sun sees it 20.5 arc
// seconds to the front, as the Earth does, whose light time and way make the same of the Moon.
TEST(KernelSky, ShiftsWhatIsSeenByTheBodysWay) {
  const auto moving_km = [](double et_s) {
    return std::array<double, 3>{published::kAu_km, 29.7859 * et_s, 0.0};
  };
  const std::string kernel = made::daf("DAF/SPK ",
                                       {made::chebyshev(2, 10, 0, -kDay_s, kDay_s, 2, 2, resting_km),
                                        made::chebyshev(2, 399, 0, -kDay_s, kDay_s, 2, 2, resting_km),
                                        made::chebyshev(2, 499, 0, -kDay_s, kDay_s, 2, 2, moving_km)},
                                       true);
  const std::string level =
      "KPL/PCK\n\\begindata\nBODY499_POLE_RA = ( 0 )\nBODY499_POLE_DEC = ( 90 )\nBODY499_PM = ( 90 )\n";
  const auto sky = read({kernel, level}, "Mars");
  ASSERT_TRUE(sky) << why(sky.error());
  // The sun stands over the prime meridian, and the body goes to the west of it.
  const auto sample = sky->over(place(0.0, 0.0), at("2000-01-01T11:58:55.816Z"));
  ASSERT_TRUE(sample) << why(sample.error());
  const Eigen::Vector3d seen = towards(sample->sun);
  EXPECT_NEAR(3600.0 * deg_from_rad(std::atan2(std::hypot(seen.x(), seen.y()), seen.z())), 20.49, 0.05);
  EXPECT_LT(seen.x(), 0.0);
}

TEST(KernelSky, IsTheSameInBothByteOrdersAndOrdersOfFiles) {
  const std::int64_t then = at("1992-04-12T06:00:00Z");
  const auto little = over(moon_kernel(-2823.0, 5, false), "Moon", place(20.0, -80.0), then);
  const auto big = over(moon_kernel(-2823.0, 5, true), "Moon", place(20.0, -80.0), then);
  EXPECT_EQ(little.sun.azimuth_rad, big.sun.azimuth_rad);
  EXPECT_EQ(little.earth->elevation_rad, big.earth->elevation_rad);
}

// Of two kernels that have a body the one that was given last says.
TEST(KernelSky, TakesWhatWasGivenLast) {
  const auto far_km = [](double /*et_s*/) {
    return std::array<double, 3>{2.0 * published::kAu_km, 0.0, 0.0};
  };
  const std::string whole = moon_kernel(-2823.0, 5);
  const std::string moved =
      made::daf("DAF/SPK ", {made::chebyshev(2, 399, 10, -2823.0 * kDay_s, kDay_s, 5, 2, far_km)}, false);
  const std::int64_t then = at("1992-04-12T06:00:00Z");
  EXPECT_NEAR(read({whole, moved}, "Moon")->over({}, then)->sun_distance_au, 2.0, 0.003);
  EXPECT_NEAR(read({moved, whole}, "Moon")->over({}, then)->sun_distance_au, 1.0, 0.01);
}

TEST(KernelSky, TableIsNearTheKernelsBetweenItsMoments) {
  const auto sky = read({moon_kernel(-2823.0, 9)}, "Moon");
  ASSERT_TRUE(sky) << why(sky.error());
  const std::int64_t from = at("1992-04-11T00:00:00Z"), to = at("1992-04-13T05:17:00Z");
  const auto moments = sky->table(place(12.0, 60.0), from, to, to + 86'400'000, 5000);
  ASSERT_TRUE(moments) << why(moments.error());
  EXPECT_EQ(moments->front().utc_ms, from);
  EXPECT_GT(moments->back().utc_ms, to + 82'800'000);
  const sky::SkyTable table(*moments);
  for (std::int64_t when = from; when <= to + 82'800'000; when += 1'234'567) {
    const auto sample = sky->over(place(12.0, 60.0), when);
    EXPECT_LT(degrees_between(*table.sun(when), sample->sun), 0.004);
    EXPECT_LT(degrees_between(*table.earth(when), *sample->earth), 0.004);
  }
}

TEST(KernelSky, TableEndsWithTheKernelsBehindTheLastDeparture) {
  const auto sky = read({moon_kernel(-2823.0, 3)}, "Moon");  // till 12 April, 12 h
  ASSERT_TRUE(sky) << why(sky.error());
  const std::int64_t from = at("1992-04-10T00:00:00Z"), to = at("1992-04-12T11:58:00Z");
  const auto moments = sky->table({}, from, to, to + 86'400'000, 5000);
  ASSERT_TRUE(moments) << why(moments.error());
  EXPECT_EQ(moments->back().utc_ms, to);
  const auto instant = sky->table({}, from, from, from, 5000);
  ASSERT_TRUE(instant);
  EXPECT_EQ(instant->size(), 2U);
  const auto later = sky->table({}, from, to + 600'000, to, 5000);
  ASSERT_FALSE(later);
  EXPECT_NE(later.error().detail.find("1992-04-09 12:00 TDB to 1992-04-12 12:00 TDB"), std::string::npos)
      << later.error().detail;
  EXPECT_NE(sky->table({}, from, to, to, 50).error().detail.find("ask for fewer days"), std::string::npos);
}

TEST(KernelSky, SaysWhatIsMissing) {
  const std::string moon = moon_kernel(-2823.0, 3), mars = mars_kernel(-2823.0, 3);
  const std::int64_t then = at("1992-04-11T00:00:00Z");
  const auto told = [&](const std::vector<std::string>& files, std::string_view body, std::int64_t utc_ms) {
    const auto sky = read(files, body);
    if (!sky) return why(sky.error());
    const auto sample = sky->over({}, utc_ms);
    return sample ? std::string("nothing") : why(sample.error());
  };
  EXPECT_EQ(told({moon}, "Moon", then), "nothing");
  EXPECT_EQ(
      told({moon}, "Moon", at("2027-01-01T00:00:00Z")),
      "the kernels don't have the Moon (body 301) at 2027-01-01 00:01 TDB: they have it from 1992-04-09 "
      "12:00 TDB to 1992-04-12 12:00 TDB");
  EXPECT_EQ(
      told({mars}, "Moon", then),
      "the kernels don't have the Moon (body 301): they have the barycentre of Mars and its moons (body "
      "4), the sun (body 10), the Earth (body 399)");
  EXPECT_EQ(told({moon}, "Mars", then),
            "the kernels don't have Mars (body 499): they have the sun (body 10), the Moon (body 301), the "
            "Earth (body 399)");
  // The light that is seen at the very beginning left before it.
  EXPECT_NE(
      told({moon}, "Moon", at("1992-04-09T12:00:00Z")).find("the sun (body 10) at 1992-04-09 11:52 TDB"),
      std::string::npos);
  const auto with = [&](auto change) {
    made::Array array = made::chebyshev(2, 301, 399, -2823.0 * kDay_s, kDay_s, 3, 10, published::moon_km);
    change(array);
    return made::daf("DAF/SPK ", {array}, false);
  };
  EXPECT_NE(told({mars, with([](made::Array& a) { a.whole[3] = 21; })}, "Moon", then)
                .find("the Moon (body 301) in a segment of type 21 and frame 1 only"),
            std::string::npos);
  EXPECT_NE(
      told({mars, with([](made::Array& a) { a.whole[2] = 17; })}, "Moon", then).find("and frame 17 only"),
      std::string::npos);
  EXPECT_NE(told({with([](made::Array& a) { a.whole[1] = 301; })}, "Moon", then).find("given from it"),
            std::string::npos);
  EXPECT_NE(told({moon}, "Earth", then).find("not for the Earth"), std::string::npos);
  EXPECT_NE(told({moon}, "other", then).find("not for another body"), std::string::npos);
  EXPECT_NE(told({"KPL/PCK\n"}, "Moon", then).find("no kernel has positions (SPK)"), std::string::npos);
  EXPECT_EQ(told({moon, "KPL/LSK\n\\begindata\n"}, "Moon", then), "nothing");
  EXPECT_NE(told({moon, "KPL/FK\n"}, "Moon", then).find("kernel: neither positions (SPK)"),
            std::string::npos);
  EXPECT_NE(told({moon, made::daf("DAF/CK  ", {made::ck(1, {{}, {1.0}}, false)}, false)}, "Moon", then)
                .find("attitudes (CK) say nothing of the sky"),
            std::string::npos);
  // Faults of all files are told together.
  const std::string both = told({moon.substr(0, 3000), "KPL/FK\n"}, "Moon", then);
  EXPECT_NE(both.find("cut short"), std::string::npos) << both;
  EXPECT_NE(both.find("neither positions"), std::string::npos) << both;
}

// The text of the constants of Mars of 2015 with all their terms [Archinal et al. 2018, table 1].
const std::string kMarsConstants =
    "KPL/PCK\n\\begindata\nBODY4_MAX_PHASE_DEGREE = 1\nBODY4_NUT_PREC_ANGLES = (\n"
    " 198.991226 19139.4819985  226.292679 38280.8511281  249.663391 57420.7251593  266.183510 "
    "76560.6367950\n"
    " 79.398797 0.5042615  122.433576 19139.9407476  43.058401 38280.8753272  57.663379 57420.7517205\n"
    " 79.476401 76560.6495004  166.325722 0.5042615  129.071773 19140.0328244  36.352167 38281.0473591\n"
    " 56.668646 57420.9295360  67.364003 76560.2552215  104.792680 95700.4387578  95.391654 0.5042615 )\n"
    "BODY499_POLE_RA = ( 317.269202 -0.10927547 0. )\nBODY499_POLE_DEC = ( 54.432516 -0.05827105 0. )\n"
    "BODY499_PM = ( 176.049863 350.891982443297 0. )\n"
    "BODY499_NUT_PREC_RA = ( 0.000068 0.000238 0.000052 0.000009 0.419057 )\n"
    "BODY499_NUT_PREC_DEC = ( 0 0 0 0 0 0.000051 0.000141 0.000031 0.000005 1.591274 )\n"
    "BODY499_NUT_PREC_PM = ( 0 0 0 0 0 0 0 0 0 0 0.000145 0.000157 0.000040 0.000001 0.000001 0.584542 )\n";

double degrees_between(const sky::Orientation& a, const sky::Orientation& b, double days) {
  return deg_from_rad(Eigen::AngleAxisd(a.fixed(days) * b.fixed(days).transpose()).angle());
}

TEST(SpiceOrientation, OfMarsIsNearTheOneThatIsBuiltIn) {
  const auto mars = read_orientation(kMarsConstants, "pck.tpc", 499);
  ASSERT_TRUE(mars) << why(mars.error());
  ASSERT_TRUE(*mars);
  EXPECT_EQ((*mars)->terms.size(), 16U);
  double most_deg = 0.0;
  for (double days = 0.0; days < 20000.0; days += 97.0)
    most_deg = std::max(most_deg, degrees_between(**mars, sky::mars_orientation(), days));
  EXPECT_LT(most_deg, 0.0004);
  std::printf("within %.4f deg\n", most_deg);
}

// The Moon's axis lies 1.54 deg beside the ecliptic's pole, on the other side of it than the pole of its
// orbit [Cassini's laws].
TEST(SpiceOrientation, TheBuiltInMoonKeepsCassinisLaws) {
  const double obliquity = rad_from_deg(23.43928);
  const Eigen::Vector3d ecliptic(0.0, -std::sin(obliquity), std::cos(obliquity));
  for (double days = -3000.0; days < 12000.0; days += 1000.0) {
    const Eigen::Vector3d pole = sky::moon_orientation().fixed(days).row(2);
    EXPECT_NEAR(deg_from_rad(std::acos(pole.dot(ecliptic))), 1.543, 0.06) << days;
  }
}

TEST(SpiceOrientation, IsThatOfTheKernelsTextAndOfNoOtherBody) {
  const auto moon = read_orientation(kMarsConstants, "pck.tpc", 301);
  ASSERT_TRUE(moon);
  EXPECT_FALSE(*moon);
  EXPECT_TRUE(looks_like_constants(kMarsConstants));
}

TEST(SpiceOrientation, WhatIsWrongIsToldWithItsLine) {
  const auto fault = [](const std::string& from, const std::string& to) {
    std::string text = kMarsConstants;
    text.replace(text.find(from), from.size(), to);
    const auto read = read_orientation(text, "pck.tpc", 499);
    return read ? std::string("it was read")
                : read.error().faults[0].pointer + ": " + read.error().faults[0].message;
  };
  EXPECT_EQ(fault("KPL", "KPL"), "it was read");
  EXPECT_EQ(fault("BODY499_PM", "BODY498_PM"), "pck.tpc: there is no BODY499_PM");
  EXPECT_EQ(fault("BODY4_NUT_PREC_ANGLES", "BODY3_NUT_PREC_ANGLES"),
            "pck.tpc: there is no BODY4_NUT_PREC_ANGLES");
  EXPECT_EQ(fault("54.432516", "x"), "pck.tpc, line 10: BODY499_POLE_DEC: \"x\" is no number");
  EXPECT_EQ(fault("54.432516", "1e12"), "pck.tpc, line 10: BODY499_POLE_DEC: a number is beyond 1e9");
  EXPECT_EQ(fault("( 54.432516", "( 1 2 3 54.432516"),
            "pck.tpc, line 10: BODY499_POLE_DEC has 6 numbers, must have 4 at most");
  EXPECT_EQ(fault("0.5042615 )", ")"),
            "pck.tpc, line 4: BODY4_NUT_PREC_ANGLES has 31 numbers, must have 2 for each angle");
  EXPECT_EQ(fault("0.584542", "0.584542 1"),
            "pck.tpc, line 14: BODY499_NUT_PREC_PM has 17 numbers, but there are 16 angles in "
            "BODY4_NUT_PREC_ANGLES");
  EXPECT_EQ(fault("DEGREE = 1", "DEGREE = 9"), "pck.tpc, line 3: BODY4_MAX_PHASE_DEGREE must be 1, 2 or 3");
  EXPECT_EQ(fault("BODY499_PM", "BODY499_CONSTANTS_REF_FRAME = 17\nBODY499_PM"),
            "pck.tpc, line 11: BODY499_CONSTANTS_REF_FRAME: only the frame of J2000 (1) is read");
  EXPECT_EQ(fault("BODY499_PM", "BODY4_CONSTANTS_JED_EPOCH = 2433282.5\nBODY499_PM"),
            "pck.tpc, line 11: BODY4_CONSTANTS_JED_EPOCH: only the epoch J2000 (2451545.0) is read");
}

}  // namespace
}  // namespace slipway::steps
