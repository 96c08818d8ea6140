#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

namespace slipway::sky {

// How a body stands in the equator of J2000, as the IAU's working group on cartographic coordinates and
// rotational elements writes it [Archinal et al. 2018]: right ascension and declination of its pole, and the
// angle W from the equator's node to its prime meridian. T are centuries of 36525 days, d days of TDB since
// J2000.
struct Orientation {
  static constexpr std::size_t kPowers = 4;
  // One angle, of which right ascension and W have a sine and the declination a cosine.
  struct Term {
    std::array<double, kPowers> angle_deg{};  // times 1, T, T^2, T^3
    double right_ascension_deg = 0.0, declination_deg = 0.0, prime_deg = 0.0;
  };
  std::array<double, kPowers> right_ascension_deg{}, declination_deg{};  // times 1, T, T^2, T^3
  std::array<double, kPowers> prime_deg{};                               // times 1, d, d^2, d^3
  std::vector<Term> terms;

  // Turns a direction in the equator of J2000 into the frame that is fixed to the body: z to its pole, x to
  // its prime meridian.
  Eigen::Matrix3d fixed(double days) const;
};

// Mars with the terms of a revolution of the pole alone; the others turn it by 0.0003 deg at most from 1800
// to 2150.
const Orientation& mars_orientation();
// The Moon's mean Earth and polar axes, in which its maps are; within 0.006 deg of the Moon's own.
const Orientation& moon_orientation();

// East, north and up at a place on an ellipsoid, as rows in the body's frame. The latitude is planetocentric;
// `polar` is the polar radius over the equatorial one.
Eigen::Matrix3d level_frame(double east_longitude_rad, double latitude_rad, double polar);
// From the body's centre, in its frame, in the unit of the equatorial radius. The latitude is planetocentric.
Eigen::Vector3d on_ellipsoid(double east_longitude_rad, double latitude_rad, double equatorial_radius,
                             double polar);
constexpr double kMarsRadius_m = 3'396'190.0;  // at the equator
constexpr double kMarsPolar = 3376.20 / 3396.19;

}  // namespace slipway::sky
