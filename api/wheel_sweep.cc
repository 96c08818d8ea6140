#include "api/wheel_sweep.h"

#include <fmt/format.h>

#include <algorithm>

#include "api/documents/soil/wheel_sweep_request.h"
#include "api/json/faults.h"
#include "api/rover_on_slope.h"
#include "sim/effects/effect_catalogue.h"

namespace slipway::api {
namespace {

// Faults beside the reader's; a value that the reader refused already is left alone.
class Check {
 public:
  explicit Check(std::vector<Fault> faults) : faults_(std::move(faults)) {}
  void add(const std::string& pointer, std::string message) {
    if (!has_fault_under(faults_, pointer)) faults_.push_back({pointer, std::move(message)});
  }
  bool passed() const { return faults_.empty(); }
  Error error() const { return {ErrorCode::kInvalidRequest, summary_of(faults_), faults_}; }

 private:
  std::vector<Fault> faults_;
};

void check_effects(const std::vector<sim::EffectSetting>& effects, bool whole_rover, Check& check) {
  for (Fault& fault : moved_under("/effects", sim::faults_of(effects)))
    check.add(fault.pointer, std::move(fault.message));
  if (whole_rover) return;
  for (std::size_t i = 0; i < effects.size(); ++i) {
    if (sim::acts_on_single_wheel(effects[i].name)) continue;
    check.add(fmt::format("/effects/{}/name", i),
              fmt::format("effect {} has no bearing on a single wheel", in_quotes(effects[i].name)));
  }
}

// The effect grousers stands for all the cleats of a wheel: it would take the place of those that are given.
void check_one_set_of_grousers(const WheelSweepRequest& request, Check& check) {
  constexpr std::string_view kEffect = "grousers", kParameter = "effects.grousers.";
  if (!request.grousers_given) return;
  const auto say = [&](const std::string& pointer) {
    check.add(pointer,
              "grousers are given twice, as the wheel's own and by the effect grousers, which would take "
              "their place");
  };
  for (std::size_t i = 0; i < request.effects.size(); ++i)
    if (request.effects[i].name == kEffect && request.effects[i].on) say(fmt::format("/effects/{}/name", i));
  for (const sim::SweepSetting& setting : request.set)
    if (setting.parameter.starts_with(kParameter)) say("/set/" + setting.parameter);
  for (std::size_t a = 0; a < request.sweep.size(); ++a)
    if (request.sweep[a].parameter.starts_with(kParameter)) say(fmt::format("/sweep/{}/parameter", a));
}

// What is asked for and could change nothing in any row: cleats' effects without cleats, and a track that no
// effect knows or that no wheel runs in.
void check_without_effect(const WheelSweepRequest& request, const sim::WheelSweep& sweep, Check& check) {
  if (request.whole_rover) return;
  bool cleats = false, tracks = false;
  for (const sim::SweepPoint& point : sim::points_of(sweep)) {
    cleats = cleats || point.test.wheel.grousers.height_m > 0.0;
    tracks = tracks || point.test.soil.multipass_stiffening != 0.0 || point.test.soil.bulldozing != 0.0;
  }
  if (!cleats && request.test.slip_radius != sim::SlipRadius::kRim)
    check.add("/slip_radius", "slip_radius: the wheel has no grousers, its rim is all there is");
  if (!tracks && request.test.in_a_track)
    check.add("/in_a_track",
              "in_a_track: a track is another soil only where the effect multipass or bulldozing is on");
  for (std::size_t i = 0; i < request.effects.size(); ++i) {
    const sim::EffectSetting& effect = request.effects[i];
    const std::string pointer = fmt::format("/effects/{}/name", i);
    if (effect.on && effect.name == "cleat_shear_radius" && !cleats)
      check.add(pointer, "cleat_shear_radius: the wheel has no grousers, by its file, grousers or height_m");
    if (effect.on && effect.name == "multipass" && !request.test.in_a_track)
      check.add(pointer, "multipass acts on a wheel in a track, and in_a_track is not asked for");
  }
}

// Puts the wheel's own numbers where the request has none, and the request's on the wheel.
void settle_wheel(WheelSweepRequest& request, sim::WheelModel& wheel) {
  wheel.radius_m = request.radius_m.value_or(wheel.radius_m);
  wheel.width_m = request.width_m.value_or(wheel.width_m);
  if (request.grousers) wheel.grousers = request.grousers;
  request.wheel = wheel.name;
  request.radius_m = wheel.radius_m;
  request.width_m = wheel.width_m;
  request.grousers_given = request.grousers.has_value();
  request.grousers = wheel.grousers;
}

void find_wheel(const sim::RoverModel& rover, WheelSweepRequest& request, sim::WheelRig& rig, Check& check) {
  rig.rover = rover;
  std::vector<std::string> names;
  for (const sim::WheelModel& wheel : rover.wheels) names.push_back(wheel.name);
  const auto found =
      request.wheel.empty() ? names.begin() : std::find(names.begin(), names.end(), request.wheel);
  if (found == names.end()) return check.add("/wheel", unknown_name("wheel", request.wheel, names));
  rig.wheel = static_cast<std::size_t>(found - names.begin());
  if (!request.whole_rover) settle_wheel(request, rig.rover.wheels[rig.wheel]);
  if (!request.whole_rover && !request.load_n && !request.test.sinkage_m)
    request.load_n = rover.mass_kg * request.test.gravity_m_s2 / static_cast<double>(rover.wheels.size());
  if (!request.speed_m_s) request.speed_m_s = rover.cruise_speed_m_s;
  rig.test = request.test;
  rig.test.load_n = request.load_n.value_or(rig.test.load_n);
  rig.test.speed_m_s = *request.speed_m_s;
  rig.motor_temp_c = request.motor_temp_c;
  rig.effects = request.effects;
}

}  // namespace

Result<WheelSweepAnswer> read_wheel_sweep(const Catalogue& catalogue, std::string_view json) {
  auto reading = json::read_wheel_sweep_request(json);
  if (!reading) return fail(reading.error());
  WheelSweepAnswer answer;
  answer.request = std::move(reading->request);
  Check check(std::move(reading->faults));
  check_effects(answer.request.effects, answer.request.whole_rover, check);
  if (answer.request.whole_rover)
    for (Fault& fault : whole_rover_faults(answer.request))
      check.add(fault.pointer, std::move(fault.message));
  const auto rover = catalogue.rovers.find(answer.request.rover);
  if (rover == catalogue.rovers.end()) {
    check.add("/rover", unknown_rover(catalogue, answer.request.rover));
  } else {
    find_wheel(*rover->second, answer.request, answer.sweep.rig, check);
  }
  const auto soil = catalogue.soils.find(answer.request.soil);
  if (soil == catalogue.soils.end()) {
    check.add("/soil", unknown_soil(catalogue, answer.request.soil));
  } else {
    answer.sweep.rig.soil = soil->second.mean;
    for (Fault& fault : moved_under(
             "/effects", sim::doubled(answer.request.effects, soil->second.mean, answer.request.soil)))
      check.add(fault.pointer, std::move(fault.message));
  }
  answer.sweep.rig.soil_format = catalogue.soil_format;
  answer.sweep.set = answer.request.set;
  answer.sweep.axes = answer.request.sweep;
  answer.sweep.paired = answer.request.paired;
  check_one_set_of_grousers(answer.request, check);
  for (Fault& fault : sim::parameter_faults(answer.sweep)) check.add(fault.pointer, std::move(fault.message));
  if (answer.request.motor_temp_c && rover != catalogue.rovers.end()) {
    if (const auto fault = temperature_without_effect(*rover->second, answer.request.effects))
      check.add(fault->pointer, fault->message);
  }
  if (!check.passed()) return fail(check.error());
  for (Fault& fault : sim::faults_of(answer.sweep)) check.add(fault.pointer, std::move(fault.message));
  if (!check.passed()) return fail(check.error());
  check_without_effect(answer.request, answer.sweep, check);
  if (!check.passed()) return fail(check.error());
  return answer;
}

Result<WheelSweepAnswer> run_wheel_sweep(const Catalogue& catalogue, std::string_view json) {
  auto answer = read_wheel_sweep(catalogue, json);
  if (answer && answer->request.whole_rover)
    answer->rover_rows = rovers_on_slopes(answer->sweep);
  else if (answer)
    answer->rows = sim::run_wheel_sweep(answer->sweep);
  return answer;
}

}  // namespace slipway::api
