#include "api/rover_on_slope.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "sim/effects/effect_catalogue.h"
#include "sim/rover/stance.h"

namespace slipway::api {
namespace {

constexpr std::string_view kSlope = "slope_deg";
constexpr std::array<std::string_view, 4> kConditions{kSlope, "speed_m_s", "gravity_m_s2", "motor_temp_c"};

bool may_vary(std::string_view parameter) {
  return parameter.starts_with("soil.") || parameter.starts_with("effects.") ||
         std::find(kConditions.begin(), kConditions.end(), parameter) != kConditions.end();
}

RoverOnSlope rover_at(const sim::WheelRig& rig, double slope_rad, std::vector<double> at) {
  const std::vector<sim::EffectSetting> effects = sim::in_force(rig.rover.effects, rig.effects);
  sim::RoverModel rover = rig.rover;
  sim::Soil soil = rig.soil;
  sim::apply_effects(effects, rover);
  sim::apply_effects(effects, soil);
  sim::QuasiStaticSolver solver(rover, rig.test.gravity_m_s2);
  const sim::DriveCommand command{.speed_m_s = rig.test.speed_m_s, .motor_temp_c = rig.motor_temp_c};
  // A positive pitch is nose down.
  const sim::Stance stance =
      sim::stance_on_plane(rover, {.roll_rad = 0.0, .pitch_rad = -slope_rad, .yaw_rad = 0.0});
  RoverOnSlope row{std::move(at),
                   slope_rad,
                   rover.mass_kg * rig.test.gravity_m_s2,
                   solver.solve(stance, soil, command),
                   {}};
  for (const sim::WheelModel& wheel : rover.wheels) row.wheels.push_back(wheel.name);
  return row;
}

}  // namespace

std::vector<Fault> whole_rover_faults(const WheelSweepRequest& request) {
  std::vector<Fault> faults;
  const auto refuse = [&](bool given, const char* key) {
    if (given)
      faults.push_back(
          {fmt::format("/{}", key),
           fmt::format("{} is of a single wheel; of a whole rover it follows from the slope", key)});
  };
  refuse(request.load_n.has_value(), "load_n");
  refuse(request.test.sinkage_m.has_value(), "sinkage_m");
  refuse(request.test.slip_angle_rad != 0.0, "slip_angle_deg");
  refuse(request.test.slip_radius != sim::SlipRadius::kRim, "slip_radius");
  refuse(request.test.slip_definition != sim::SlipDefinition::kForward, "slip_definition");
  refuse(request.test.speed_is_of_travel, "speed_of");
  refuse(request.test.in_a_track, "in_a_track");
  refuse(!request.wheel.empty(), "wheel");
  refuse(request.radius_m.has_value(), "radius_m");
  refuse(request.width_m.has_value(), "width_m");
  refuse(request.grousers.has_value(), "grousers");
  bool sloping = request.test.slope_rad.has_value();
  for (std::size_t a = 0; a < request.sweep.size(); ++a) {
    const std::string& name = request.sweep[a].parameter;
    sloping = sloping || name == kSlope;
    if (!may_vary(name))
      faults.push_back(
          {fmt::format("/sweep/{}/parameter", a), name + " is of a single wheel, not of a whole rover"});
  }
  for (const sim::SweepSetting& setting : request.set) {
    sloping = sloping || setting.parameter == kSlope;
    if (!may_vary(setting.parameter))
      faults.push_back(
          {"/set/" + setting.parameter, setting.parameter + " is of a single wheel, not of a whole rover"});
  }
  if (!sloping)
    faults.push_back(
        {"/slope_deg", "slope_deg is missing: of a whole rover the slip at a slope is asked for"});
  return faults;
}

std::vector<RoverOnSlope> rovers_on_slopes(const sim::WheelSweep& sweep) {
  std::vector<RoverOnSlope> rows;
  for (std::size_t i = 0; i < sim::rows_of(sweep); ++i) {
    std::vector<double> at;
    const sim::WheelRig rig = sim::rig_of(sweep, i, at);
    rows.push_back(rover_at(rig, rig.test.slope_rad.value_or(0.0), std::move(at)));
  }
  return rows;
}

}  // namespace slipway::api
