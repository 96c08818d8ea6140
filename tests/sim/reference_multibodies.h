#pragma once

#include <string>
#include <vector>

#include "sim/dynamic/multibody.h"

namespace slipway::sim {

// A rover with rockers, bogies, a steering on some wheels, whose own body has no mass, and six wheels: of
// MER's size. Some pieces lie askew, so that no term of the equations is 0.
inline Multibody rocker_bogie_rover(int steerings = 4, double wheel_armature_kg_m2 = 0.0) {
  using Eigen::Matrix3d, Eigen::Vector3d;
  const auto mass = [](double kg, const Vector3d& com, const Vector3d& radii_m) {
    const Vector3d squares = radii_m.cwiseAbs2();
    const Vector3d moments = kg * (Vector3d::Constant(squares.sum()) - squares);
    return MassProperties{kg, com, moments.asDiagonal()};
  };
  MassProperties base = mass(140.0, {-0.03, 0.01, 0.45}, {0.4, 0.35, 0.2});
  base.inertia_kg_m2(0, 2) = base.inertia_kg_m2(2, 0) = 1.3;
  std::vector<RevoluteBody> bodies;
  for (const double side : {1.0, -1.0}) {
    const std::string name = side > 0.0 ? "left" : "right";
    const auto at = [side](double x, double y, double z) { return Vector3d(x, side * y, z); };
    const int rocker = static_cast<int>(bodies.size()), bogie = rocker + 1;
    bodies.push_back({name + " rocker", -1, at(0.05, 0.45, 0.4), Vector3d::UnitY(),
                      mass(6.0, at(0.3, 0.47, 0.33), {0.3, 0.04, 0.1})});
    bodies.push_back({name + " bogie", rocker, at(-0.35, 0.5, 0.3), Vector3d(0.0, 1.0, 0.02).normalized(),
                      mass(3.0, at(-0.36, 0.52, 0.2), {0.25, 0.03, 0.05})});
    bodies.back().mass.inertia_kg_m2(0, 1) = bodies.back().mass.inertia_kg_m2(1, 0) = 0.01;
    for (int k = 0; k < 3; ++k) {
      const Vector3d hub = at(0.7 * (1 - k), k == 1 ? 0.61 : 0.53, 0.125);
      int parent = k == 0 ? rocker : bogie;
      if (k != 1 || steerings == 6) {
        bodies.push_back({name + " steering", parent, hub, Vector3d::UnitZ()});
        parent = static_cast<int>(bodies.size()) - 1;
      }
      bodies.push_back({.name = name + " wheel",
                        .parent = parent,
                        .pivot_m = hub,
                        .axis = Vector3d::UnitY(),
                        .mass = mass(2.5, hub, {0.07, 0.05, 0.07}),
                        .armature_kg_m2 = wheel_armature_kg_m2,
                        .round = true});
    }
  }
  return Multibody(base, std::move(bodies));
}

}  // namespace slipway::sim
