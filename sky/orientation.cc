#include "sky/orientation.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "core/angle.h"

namespace slipway::sky {
namespace {

double polynomial(const std::array<double, Orientation::kPowers>& of, double at) {
  double sum = 0.0;
  for (std::size_t k = of.size(); k-- > 0;) sum = sum * at + of[k];
  return sum;
}

double turned_rad(double degrees) {
  return rad_from_deg(std::fmod(degrees, 360.0));
}

}  // namespace

Eigen::Matrix3d Orientation::fixed(double days) const {
  const double centuries = days / 36525.0;
  double right_ascension = polynomial(right_ascension_deg, centuries);
  double declination = polynomial(declination_deg, centuries);
  double prime = polynomial(prime_deg, days);
  for (const Term& term : terms) {
    const double angle = turned_rad(polynomial(term.angle_deg, centuries));
    right_ascension += term.right_ascension_deg * std::sin(angle);
    declination += term.declination_deg * std::cos(angle);
    prime += term.prime_deg * std::sin(angle);
  }
  using Eigen::AngleAxisd, Eigen::Vector3d;
  return (AngleAxisd(-turned_rad(prime), Vector3d::UnitZ()) *
          AngleAxisd(rad_from_deg(declination) - 0.5 * std::numbers::pi, Vector3d::UnitX()) *
          AngleAxisd(-rad_from_deg(right_ascension) - 0.5 * std::numbers::pi, Vector3d::UnitZ()))
      .toRotationMatrix();
}

const Orientation& mars_orientation() {
  static const Orientation mars{{317.269202, -0.10927547},
                                {54.432516, -0.05827105},
                                {176.049863, 350.891982443297},
                                {{{79.398797, 0.5042615}, 0.419057, 0.0, 0.0},
                                 {{166.325722, 0.5042615}, 0.0, 1.591274, 0.0},
                                 {{95.391654, 0.5042615}, 0.0, 0.0, 0.584542}}};
  return mars;
}

const Orientation& moon_orientation() {
  static const Orientation moon{{269.9949, 0.0031},
                                {66.5392, 0.0130},
                                {38.3213, 13.17635815, -1.4e-12},
                                {{{125.045, -1935.5364525}, -3.8787, 1.5419, 3.5610},
                                 {{250.089, -3871.072905}, -0.1204, 0.0239, 0.1208},
                                 {{260.008, 475263.3328725}, 0.0700, -0.0278, -0.0642},
                                 {{176.625, 487269.629985}, -0.0172, 0.0068, 0.0158},
                                 {{357.529, 35999.0509575}, 0.0, 0.0, 0.0252},
                                 {{311.589, 964468.49931}, 0.0072, -0.0029, -0.0066},
                                 {{134.963, 477198.869325}, 0.0, 0.0009, -0.0047},
                                 {{276.617, 12006.300765}, 0.0, 0.0, -0.0046},
                                 {{34.226, 63863.5132425}, 0.0, 0.0, 0.0028},
                                 {{15.134, -5806.6093575}, -0.0052, 0.0008, 0.0052},
                                 {{119.743, 131.84064}, 0.0, 0.0, 0.0040},
                                 {{239.961, 6003.1503825}, 0.0, 0.0, 0.0019},
                                 {{25.053, 473327.79642}, 0.0043, -0.0009, -0.0044}}};
  return moon;
}

Eigen::Matrix3d level_frame(double east_longitude_rad, double latitude_rad, double polar) {
  const double graphic = std::atan2(std::sin(latitude_rad), polar * polar * std::cos(latitude_rad));
  const double sl = std::sin(east_longitude_rad), cl = std::cos(east_longitude_rad);
  const double sp = std::sin(graphic), cp = std::cos(graphic);
  Eigen::Matrix3d frame;
  frame << -sl, cl, 0.0, -sp * cl, -sp * sl, cp, cp * cl, cp * sl, sp;
  return frame;
}

Eigen::Vector3d on_ellipsoid(double east_longitude_rad, double latitude_rad, double equatorial_radius,
                             double polar) {
  const double level = std::cos(latitude_rad);
  const Eigen::Vector3d ray(level * std::cos(east_longitude_rad), level * std::sin(east_longitude_rad),
                            std::sin(latitude_rad));
  return ray * (equatorial_radius / Eigen::Vector3d(ray.x(), ray.y(), ray.z() / polar).norm());
}

}  // namespace slipway::sky
