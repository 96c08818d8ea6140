#include "gap/diagnosis/model/outside_cause.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/angle.h"
#include "gap/diagnosis/model/outside_cause_rows.h"

namespace slipway::gap {
namespace {

constexpr double kMaxDeviations = 10.0;
const double kSlopeOfForce = std::sin(rad_from_deg(10.0));

}  // namespace

sim::EffectVariant::Free outside_number(std::string field, double std) {
  return {.field = std::move(field),
          .std = std,
          .lowest = -kMaxDeviations * std,
          .highest = kMaxDeviations * std};
}

sim::EffectVariant outside_variant(std::vector<sim::EffectVariant::Free> free, std::string label,
                                   std::vector<std::pair<std::string, double>> fixed) {
  sim::EffectVariant variant;
  variant.label = std::move(label);
  variant.free = std::move(free);
  variant.fixed = std::move(fixed);
  return variant;
}

std::string wheel_field(std::size_t k) {
  return fmt::format("wheel_{}", k);
}

std::vector<std::pair<std::string, double>> marks_of(std::span<const std::size_t> wheels) {
  std::vector<std::pair<std::string, double>> marks;
  for (const std::size_t k : wheels) marks.emplace_back(wheel_field(k), 1.0);
  return marks;
}

std::vector<std::size_t> wheels_in(const OutsideValues& values) {
  std::vector<std::size_t> wheels;
  for (std::size_t k = 0; k < static_cast<std::size_t>(sim::kMaxWheels); ++k)
    if (values.contains(wheel_field(k))) wheels.push_back(k);
  return wheels;
}

std::vector<std::size_t> wheels_of_side(const sim::RoverModel& rover, double side) {
  std::vector<std::size_t> wheels;
  for (std::size_t k = 0; k < rover.wheels.size(); ++k)
    if (side * rover.wheels[k].position_m.y() > 0.0) wheels.push_back(k);
  return wheels;
}

std::string names_of_wheels(const sim::RoverModel& rover, std::span<const std::size_t> wheels) {
  std::string names;
  for (const std::size_t k : wheels) names += (names.empty() ? "" : " and ") + rover.wheels[k].name;
  return names;
}

bool OutsideForces::any() const {
  return along_n != 0.0 || along_by_speed_n != 0.0 || along_by_slope_n != 0.0 || !in_body_n.isZero(0.0) ||
         !on_map_n.isZero(0.0) || load_n != 0.0 || !moment_nm.isZero(0.0) || !at_wheel_n.empty();
}

double SoilDrift::factor(const SoilPlace& at) const {
  constexpr double kLeast = 0.05;  // of the strength: a fit may try what leaves nothing
  const double t = at.order;
  return std::max(
      kLeast, 1.0 + 0.5 * last * (t + 1.0) + middle * (1.0 - t * t) + end * at.along + over.dot(at.on_map));
}

void strengthen(sim::Soil& soil, double factor) {
  soil.cohesion_pa *= factor;
  soil.friction_angle_rad = std::atan(factor * std::tan(soil.friction_angle_rad));
}

sim::OutsideWrench wrench_of(const OutsideForces& forces, const sim::RoverModel& rover,
                             const sim::Stance& stance, const sim::DriveCommand& command) {
  const double sense = command.turn_in_place ? 0.0 : command.speed_m_s < 0.0 ? -1.0 : 1.0;
  const Eigen::Vector2d direction = sim::travel_direction(command);
  const Eigen::Vector3d travel(sense * direction.x(), sense * direction.y(), 0.0);
  const double speed =
      rover.cruise_speed_m_s > 0.0 ? std::abs(command.speed_m_s) / rover.cruise_speed_m_s : 1.0;
  const double climb = stance.R_MB(2, 0) / kSlopeOfForce;  // of the body's front, 1 at 10 deg
  sim::OutsideWrench wrench;
  wrench.force_n =
      (forces.along_n + forces.along_by_speed_n * speed) * travel +
      Eigen::Vector3d(forces.in_body_n.x() + forces.along_by_slope_n * climb, forces.in_body_n.y(), 0.0) +
      stance.R_MB.transpose() * Eigen::Vector3d(forces.on_map_n.x(), forces.on_map_n.y(), -forces.load_n);
  const Eigen::Vector3d at = rover.com_m + Eigen::Vector3d(forces.ahead_m, 0.0, forces.height_m);
  wrench.moment_nm = at.cross(wrench.force_n) + forces.moment_nm;
  if (forces.at_wheel_n.empty()) return wrench;
  wrench.at_wheel_n = sim::PerWheel<Eigen::Vector3d>(rover.wheels.size(), Eigen::Vector3d::Zero());
  for (const auto& [wheel, force_n] : forces.at_wheel_n)
    wrench.at_wheel_n[wheel] = force_n.x() * travel + Eigen::Vector3d(0.0, force_n.y(), force_n.z());
  return wrench;
}

std::span<const OutsideCause> outside_catalogue() {
  static const std::vector<OutsideCause> rows = [] {
    std::vector<OutsideCause> all;
    for (const auto some :
         {outside_force_rows(), outside_rover_rows(), outside_soil_rows(), outside_sensor_rows()})
      all.insert(all.end(), some.begin(), some.end());
    return all;
  }();
  return rows;
}

bool is_outside(std::string_view name) {
  return find_outside(name) != nullptr;
}

const OutsideCause* find_outside(std::string_view name) {
  const auto rows = outside_catalogue();
  const auto row =
      std::find_if(rows.begin(), rows.end(), [name](const OutsideCause& c) { return c.name == name; });
  return row == rows.end() ? nullptr : &*row;
}

std::vector<sim::EffectVariant> outside_variants(const DriveCampaign& campaign) {
  std::vector<sim::EffectVariant> all;
  for (const OutsideCause& cause : outside_catalogue())
    for (sim::EffectVariant& variant : cause.variants(campaign)) {
      variant.effect = cause.name;
      all.push_back(std::move(variant));
    }
  return all;
}

}  // namespace slipway::gap
