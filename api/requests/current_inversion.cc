#include "api/requests/current_inversion.h"

#include <fmt/format.h>

#include <algorithm>

#include "api/json/faults.h"
#include "sim/effects/effect_catalogue.h"
#include "sim/single_wheel/sweep_parameter.h"

namespace slipway::api {
namespace {

void check_number(std::string_view name, double value, double lowest, double highest,
                  std::vector<Fault>& faults) {
  if (value >= lowest && value <= highest) return;
  faults.push_back({fmt::format("/{}", name),
                    fmt::format("{} = {:g}, must be in [{:g}, {:g}]", name, value, lowest, highest)});
}

void check_parameter(std::string_view name, const std::optional<double>& value, std::vector<Fault>& faults) {
  const Field field = sim::sweep_field(name).value();
  if (value) check_number(name, *value, field.lowest, field.highest, faults);
}

std::vector<Fault> faults_of(const CurrentInversionRequest& request) {
  std::vector<Fault> faults = moved_under("/effects", sim::faults_of(request.effects));
  constexpr double kMaxAmperes = 1000.0;
  constexpr int kMaxDraws = 10'000;
  check_number("current_a", request.current_a, -kMaxAmperes, kMaxAmperes, faults);
  check_number("max_slip", request.options.max_slip, 0.0, 1.0, faults);
  check_number("draws", request.options.draws, 1, kMaxDraws, faults);
  check_parameter("load_n", request.load_n, faults);
  check_parameter("gravity_m_s2", request.gravity_m_s2, faults);
  check_parameter("speed_m_s", request.speed_m_s, faults);
  check_parameter("motor_temp_c", request.motor_temp_c, faults);
  return faults;
}

// Puts the rover's wheel on the rig, and fills in the defaults that rover and wheel give the request.
void settle(const sim::RoverModel& rover, CurrentInversionRequest& request, sim::WheelRig& rig,
            std::vector<Fault>& faults) {
  rig.rover = rover;
  std::vector<std::string> names;
  for (const sim::WheelModel& wheel : rover.wheels) names.push_back(wheel.name);
  if (request.wheel.empty()) request.wheel = names.front();
  const auto found = std::find(names.begin(), names.end(), request.wheel);
  if (found == names.end()) {
    faults.push_back({"/wheel", unknown_name("wheel", request.wheel, names)});
    return;
  }
  rig.wheel = static_cast<std::size_t>(found - names.begin());
  if (!request.load_n)
    request.load_n = rover.mass_kg * request.gravity_m_s2 / static_cast<double>(rover.wheels.size());
  if (!request.speed_m_s) request.speed_m_s = rover.cruise_speed_m_s;
  if (request.motor_temp_c)
    if (auto fault = temperature_without_effect(rover, request.effects)) faults.push_back(*std::move(fault));
  rig.effects = request.effects;
  rig.motor_temp_c = request.motor_temp_c;
  rig.test.load_n = *request.load_n;
  rig.test.speed_m_s = *request.speed_m_s;
  rig.test.gravity_m_s2 = request.gravity_m_s2;
}

}  // namespace

Result<CurrentInversion> invert_current(const Catalogue& catalogue, const CurrentInversionRequest& request) {
  CurrentInversion inversion{request, {}};
  std::vector<Fault> faults = faults_of(request);
  sim::WheelRig rig;
  if (const auto rover = catalogue.rovers.find(request.rover); rover != catalogue.rovers.end()) {
    settle(*rover->second, inversion.request, rig, faults);
  } else {
    faults.push_back({"/rover", unknown_rover(catalogue, request.rover)});
  }
  const auto soil = catalogue.soils.find(request.soil);
  if (soil == catalogue.soils.end())
    faults.push_back({"/soil", unknown_soil(catalogue, request.soil)});
  else if (soil->second.mean.slip_curve != nullptr)
    faults.push_back(
        {"/soil", fmt::format("{} is known by a slip curve alone, which says nothing of a wheel's current",
                              request.soil)});
  if (!faults.empty()) return fail(ErrorCode::kInvalidRequest, summary_of(faults), faults);
  sim::SoilDistribution belief = soil->second;
  sim::apply_effects(sim::in_force(rig.rover.effects, rig.effects), belief.mean);
  inversion.answer = sim::invert_current(sim::conditions_of(rig), belief, request.current_a, request.options);
  return inversion;
}

}  // namespace slipway::api
