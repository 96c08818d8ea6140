#include "gap/diagnosis/model/nuisance_catalogue.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace slipway::gap {
namespace {

using sim::RoverModel;
using sim::Soil;

constexpr auto kSoil = NuisanceKind::kSoil;
constexpr auto kClosure = NuisanceKind::kClosure;

constexpr std::array kRows{
    Nuisance{"stiffness", "logarithm of both moduli of sinkage over the nominal ones", kSoil, 0.15, -1.5, 1.5,
             [](double v, Soil& s) {
               s.pressure.k_c *= std::exp(v);
               s.pressure.k_phi *= std::exp(v);
             }},
    Nuisance{"n", "logarithm of the exponent of sinkage", kSoil, 0.06, -0.5, 0.5,
             [](double v, Soil& s) { s.pressure.n *= std::exp(v); }},
    Nuisance{"cohesion", "logarithm of the cohesion", kSoil, 0.15, -1.5, 1.5,
             [](double v, Soil& s) { s.cohesion_pa *= std::exp(v); }},
    Nuisance{"friction", "logarithm of tan(friction angle)", kSoil, 0.06, -0.5, 0.5,
             [](double v, Soil& s) {
               s.friction_angle_rad = std::atan(std::exp(v) * std::tan(s.friction_angle_rad));
             }},
    Nuisance{"shear_modulus", "logarithm of Janosi's moduli", kSoil, 0.15, -1.5, 1.5,
             [](double v, Soil& s) {
               s.shear_modulus_x_m *= std::exp(v);
               s.shear_modulus_y_m *= std::exp(v);
             }},
    Nuisance{kLateralShearModulus, "logarithm of Janosi's modulus across over that along", kClosure, 0.15,
             -1.5, 1.5, [](double v, Soil& s) { s.shear_modulus_y_m *= std::exp(v); }},
    Nuisance{"c1", "angle of greatest stress without slip", kClosure, 0.05, -0.4, 0.4,
             [](double v, Soil& s) { s.c1 = std::clamp(s.c1 + v, 0.0, 0.9); }},
    Nuisance{"c2", "its change with slip", kClosure, 0.05, -0.4, 0.4,
             [](double v, Soil& s) { s.c2 = std::clamp(s.c2 + v, -0.2, 0.9); }},
    Nuisance{"exit_angle", "contact behind the lowest point, of the entry angle", kClosure, 0.1, 0.0, 0.6,
             [](double v, Soil& s) { s.exit_angle_ratio = std::min(0.9, s.exit_angle_ratio + v); }},
    Nuisance{"shear_coupling", "one strength for both directions of shear", kClosure, 0.5, 0.0, 1.0,
             [](double v, Soil& s) { s.shear_coupling = std::min(1.0, s.shear_coupling + v); }},
    Nuisance{
        "pull_below_axle", "the pull acts below the axle, not ahead of it", kClosure, 0.5, 0.0, 1.0, nullptr,
        [](double v, RoverModel& r) { r.pull_below_axle = std::clamp(r.pull_below_axle + v, 0.0, 1.0); }},
    Nuisance{"wheel_weight", "share of the wheels' weight that hangs at the wheels, not in the body",
             kClosure, 0.7, 0.0, 3.0, nullptr,
             [](double v, RoverModel& r) { r.wheel_weight = std::clamp(r.wheel_weight + v, 0.0, 3.0); }},
    Nuisance{"com_height", "centre of mass above where the rover's file has it, m", kClosure, 0.05, -0.3, 0.3,
             nullptr, [](double v, RoverModel& r) { r.com_m.z() += v; }},
    Nuisance{kPoseLag, "headings are recorded later than positions, s", NuisanceKind::kSensor, 1.0, -5.0,
             5.0},
    Nuisance{kTrackLeftOut, "share of a track's depth that sinkages are recorded without",
             NuisanceKind::kSensor, 0.5, 0.0, 1.0},
    Nuisance{"torque_constant", "logarithm of the motors' torque constant", NuisanceKind::kMotor, 0.01, -0.3,
             0.3, nullptr, [](double v, RoverModel& r) { r.drive.torque_constant_nm_per_a *= std::exp(v); }},
    Nuisance{
        kIdleCurrent,
        "added to each motor's no-load current, A; where a total was recorded, with all that hangs on it",
        NuisanceKind::kMotor, 0.5, -5.0, 5.0, nullptr,
        [](double v, RoverModel& r) {
          r.drive.no_load_current_a = std::max(0.0, r.drive.no_load_current_a + v);
        }},
};

}  // namespace

std::optional<SoilQuantity> quantity_of(const Nuisance& row) {
  const auto name = std::find(kSoilNuisances.begin(), kSoilNuisances.end(), row.name);
  if (name == kSoilNuisances.end()) return std::nullopt;
  return static_cast<SoilQuantity>(name - kSoilNuisances.begin());
}

std::span<const Nuisance> nuisance_catalogue() {
  return kRows;
}

}  // namespace slipway::gap
