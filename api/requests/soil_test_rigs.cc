#include "api/requests/soil_test_rigs.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "api/json/faults.h"
#include "sim/effects/effect_catalogue.h"
#include "sim/rover/rover_field.h"
#include "sim/single_wheel/sweep_parameter.h"

namespace slipway::api {
namespace {

using gap::FreeParameter;
using gap::SoilParameter;

// "smooth_rim@smooth": a name, and the wheel or soil whose it is; empty: of all.
struct Labelled {
  std::string name, of;
};
Labelled labelled(std::string_view text) {
  const std::size_t at = text.find('@');
  if (at == std::string_view::npos) return {std::string(text), ""};
  return {std::string(text.substr(0, at)), std::string(text.substr(at + 1))};
}

std::vector<std::string> names_in_order(const std::vector<gap::WheelObservation>& tests,
                                        std::string gap::WheelObservation::*member) {
  std::vector<std::string> names;
  for (const gap::WheelObservation& test : tests)
    if (std::find(names.begin(), names.end(), test.*member) == names.end()) names.push_back(test.*member);
  return names;
}

// A number of a soil, an effect or a wheel as sim::set_sweep_parameter has it.
std::vector<std::string> swept_names(const FreeParameter& parameter) {
  if (!parameter.soil) return {parameter.swept};
  if (*parameter.soil == SoilParameter::kBekker) return {"soil.k_s"};
  if (*parameter.soil == SoilParameter::kShearModulus)
    return {"soil.shear_modulus_x_m", "soil.shear_modulus_y_m"};
  return {"soil." + std::string(gap::row_of(*parameter.soil).field->field.name)};
}

class Resolving {
 public:
  Resolving(const Catalogue& catalogue, const SoilEstimateRequest& request, std::vector<Fault>& faults)
      : catalogue_(catalogue), request_(request), faults_(faults) {
    wheels_ = names_in_order(request.data.wheels, &gap::WheelObservation::wheel);
    soils_ = names_in_order(request.data.wheels, &gap::WheelObservation::soil);
    if (soils_.empty()) soils_.emplace_back();
  }

  SoilTestRigs run() {
    out_.data.plates = request_.data.plates;
    check_labels();
    find_soils();
    find_rover();
    check_effects();
    make_rigs();
    apply_settings();
    check_free();
    if (!soils_.front().empty()) out_.data.soils = soils_;
    return std::move(out_);
  }

 private:
  void fault(std::string pointer, std::string message) {
    faults_.push_back({std::move(pointer), std::move(message)});
  }
  bool is_wheel(std::string_view name) const {
    return std::find(wheels_.begin(), wheels_.end(), name) != wheels_.end();
  }
  bool is_soil(std::string_view name) const {
    return std::find(soils_.begin(), soils_.end(), name) != soils_.end();
  }
  // Whether tests have such a label, or none is asked for.
  bool known(const std::string& of, const std::string& pointer) {
    if (of.empty() || is_wheel(of) || is_soil(of)) return true;
    std::vector<std::string> names = wheels_;
    names.insert(names.end(), soils_.begin(), soils_.end());
    std::erase(names, "");
    fault(pointer, unknown_name("wheel or soil of the tests", of, names));
    return false;
  }

  void check_labels() {
    for (const auto& [what, names] : {std::pair("wheel", &wheels_), std::pair("soil", &soils_)})
      if (names->size() > 1 && std::find(names->begin(), names->end(), "") != names->end())
        fault("/wheel_tests", fmt::format("some tests name their {} and some don't", what));
    for (const std::string& name : wheels_)
      if (!name.empty() && is_soil(name))
        fault("/wheel_tests",
              fmt::format("{} is a wheel and a soil: a name must be of one of them", in_quotes(name)));
    if (soils_.size() > 1 && !request_.data.plates.empty())
      fault("/plate_tests", "plates are of one soil, and the wheel tests name several");
  }

  void find_soil(const std::string& name, const std::string& pointer, sim::SoilDistribution& soil) {
    const auto found = catalogue_.soils.find(name);
    if (found == catalogue_.soils.end())
      return fault(pointer, unknown_name("soil", name, names_of(catalogue_.soils)));
    if (!found->second.mean.has_bekker_law())
      return fault(pointer, fmt::format("{} has another law of pressure than Bekker's, whose parameters are "
                                        "what is estimated",
                                        in_quotes(name)));
    soil = found->second;
  }
  void find_soils() {
    out_.nominals.resize(soils_.size());
    for (sim::SoilDistribution& soil : out_.nominals) {
      const std::size_t before = faults_.size();
      find_soil(request_.soil, "/soil", soil);
      if (faults_.size() > before) break;
    }
    for (std::size_t i = 0; i < request_.soils.size(); ++i) {
      const TestedSoil& tested = request_.soils[i];
      const auto place = std::find(soils_.begin(), soils_.end(), tested.name);
      if (tested.name.empty() || place == soils_.end())
        fault(fmt::format("/soils/{}/name", i), unknown_name("soil of the tests", tested.name, soils_));
      else
        find_soil(tested.soil, fmt::format("/soils/{}/soil", i),
                  out_.nominals[static_cast<std::size_t>(place - soils_.begin())]);
    }
  }

  void find_rover() {
    const TestedWheel& tested = request_.wheel;
    if (tested.rover.empty()) {
      base_.rover.wheels.emplace_back();
      if (!tested.wheel.empty()) fault("/wheel", "a wheel is named of a rover, and there is none");
      if (tested.motor_temp_c)
        fault("/motor_temp_c", "a temperature needs the motor of a rover, and there is none");
      if (measures_current()) fault("/rover", "a measured current needs the motor of a rover");
      return;
    }
    const auto rover = catalogue_.rovers.find(tested.rover);
    if (rover == catalogue_.rovers.end()) {
      base_.rover.wheels.emplace_back();
      return fault("/rover", unknown_name("rover", tested.rover, names_of(catalogue_.rovers)));
    }
    base_.rover = *rover->second;
    base_.motor_temp_c = tested.motor_temp_c;
    std::vector<std::string> names;
    for (const sim::WheelModel& wheel : base_.rover.wheels) names.push_back(wheel.name);
    const auto found =
        tested.wheel.empty() ? names.begin() : std::find(names.begin(), names.end(), tested.wheel);
    if (found == names.end()) return fault("/wheel", unknown_name("wheel", tested.wheel, names));
    base_.wheel = static_cast<std::size_t>(found - names.begin());
  }
  bool measures_current() const {
    const auto& tests = request_.data.wheels;
    return std::any_of(tests.begin(), tests.end(), [](const gap::WheelObservation& o) {
      return o[gap::SoilChannel::kCurrent].value.has_value();
    });
  }

  void check_effects() {
    for (std::size_t i = 0; i < request_.effects.size(); ++i) {
      sim::EffectSetting setting = request_.effects[i];
      const Labelled name = labelled(setting.name);
      const std::string pointer = fmt::format("/effects/{}", i);
      setting.name = name.name;
      const std::size_t before = faults_.size();
      for (const Fault& of : sim::faults_of(std::span(&setting, 1)))
        fault(pointer + of.pointer.substr(2), of.message);  // behind "/0"
      if (faults_.size() == before && !sim::acts_on_single_wheel(name.name))
        fault(pointer + "/name",
              fmt::format("effect {} has no bearing on a single wheel", in_quotes(name.name)));
      if (request_.data.wheels.empty()) fault(pointer, "an effect acts on wheels, and no wheel was tested");
      known(name.of, pointer + "/name");
      for (std::size_t k = 0; k < i; ++k)
        if (request_.effects[k].name == request_.effects[i].name)
          fault(pointer + "/name",
                fmt::format("{} is given more than once", in_quotes(request_.effects[i].name)));
      if (name.name == "grousers" && setting.on) grousers_twice(name.of, pointer + "/name");
    }
  }
  // The effect grousers stands for all the cleats of a wheel: it would take the place of those that are
  // given.
  void grousers_twice(const std::string& of, const std::string& pointer) {
    bool given = request_.wheel.grousers.has_value();
    for (const NamedWheel& wheel : request_.wheels)
      given = given || (wheel.wheel.grousers && (of.empty() || of == wheel.name || is_soil(of)));
    if (given)
      fault(pointer,
            "grousers are given twice, as the wheel's own and by the effect grousers, which would take their "
            "place");
  }

  void put(const TestedWheel& tested, sim::WheelModel& wheel) {
    wheel.radius_m = tested.radius_m.value_or(wheel.radius_m);
    wheel.width_m = tested.width_m.value_or(wheel.width_m);
    if (tested.grousers) wheel.grousers = tested.grousers;
  }
  void make_rigs() {
    check_named_wheels();
    for (const gap::WheelObservation& test : request_.data.wheels) {
      const auto soil =
          static_cast<std::size_t>(std::find(soils_.begin(), soils_.end(), test.soil) - soils_.begin());
      std::size_t rig = 0;
      while (rig < out_.data.rigs.size() &&
             (out_.data.rigs[rig].wheel != test.wheel || out_.data.rigs[rig].soil != soil))
        ++rig;
      if (rig == out_.data.rigs.size()) out_.data.rigs.push_back(rig_of(test.wheel, soil));
      out_.data.wheels.push_back(test);
      out_.data.wheels.back().rig = rig;
      out_.data.wheels.back().test.gravity_m_s2 = request_.gravity_m_s2;
      out_.data.wheels.back().test.speed_m_s = request_.speed_m_s;
    }
    for (const gap::TestRig& rig : out_.data.rigs)
      if (const sim::WheelModel& wheel = rig.rig.rover.wheels[rig.rig.wheel];
          wheel.grousers && wheel.grousers->height_m > wheel.radius_m)
        fault("/grousers", "grousers are higher than the wheel's radius");
  }
  void check_named_wheels() {
    for (std::size_t i = 0; i < request_.wheels.size(); ++i) {
      const std::string& name = request_.wheels[i].name;
      if (!is_wheel(name))
        fault(fmt::format("/wheels/{}/name", i), unknown_name("wheel of the tests", name, wheels_));
    }
    if (request_.data.wheels.empty() || !request_.wheel.rover.empty()) return;
    for (const std::string& label : wheels_) {
      const auto given = [&](std::optional<double> TestedWheel::*number) {
        if (request_.wheel.*number) return true;
        return std::any_of(request_.wheels.begin(), request_.wheels.end(), [&](const NamedWheel& w) {
          return w.name == label && (w.wheel.*number).has_value();
        });
      };
      const std::string of = label.empty() ? "" : " of " + in_quotes(label);
      if (!given(&TestedWheel::radius_m))
        fault("/radius_m", fmt::format("radius_m{} is missing, or a rover with wheels", of));
      if (!given(&TestedWheel::width_m))
        fault("/width_m", fmt::format("width_m{} is missing, or a rover with wheels", of));
    }
  }
  gap::TestRig rig_of(const std::string& label, std::size_t soil) {
    gap::TestRig rig{base_, label, soil};
    sim::WheelModel& wheel = rig.rig.rover.wheels[rig.rig.wheel];
    put(request_.wheel, wheel);
    for (const NamedWheel& named : request_.wheels)
      if (named.name == label) put(named.wheel, wheel);
    // What is of one wheel or soil comes behind what is of all, and takes its place.
    for (const bool of_all : {true, false})
      for (const sim::EffectSetting& setting : request_.effects) {
        const Labelled name = labelled(setting.name);
        if (name.of.empty() != of_all) continue;
        if (!of_all && name.of != label && name.of != soils_[soil]) continue;
        std::erase_if(rig.rig.effects, [&](const sim::EffectSetting& s) { return s.name == name.name; });
        rig.rig.effects.push_back(setting);
        rig.rig.effects.back().name = name.name;
      }
    return rig;
  }

  void apply_settings() {
    for (const bool of_all : {true, false})
      for (const sim::SweepSetting& setting : request_.set)
        if ((setting.parameter.find('@') == std::string::npos) == of_all) apply(setting);
  }
  void apply(const sim::SweepSetting& setting) {
    const std::string pointer = "/set/" + setting.parameter;
    const auto parameter = gap::free_parameter(setting.parameter);
    if (!parameter)
      return fault(pointer, unknown_name("parameter", setting.parameter, gap::free_parameter_names()));
    if (!known(parameter->of, pointer)) return;
    for (const std::string& swept : swept_names(*parameter)) {
      const Field field = *sim::sweep_field(swept);
      if (!(setting.value >= field.lowest && setting.value <= field.highest))
        return fault(pointer, sim::out_of_range_in_words(setting.parameter, setting.value, field));
    }
    if (parameter->is_of_soil() && !parameter->of.empty() && !is_soil(parameter->of))
      return fault(pointer, "a number of a soil is one for all wheels in it");
    out_.stated.push_back(*parameter);
    for (const std::string& swept : swept_names(*parameter)) set(*parameter, swept, setting.value, pointer);
  }
  void set(const FreeParameter& parameter, const std::string& swept, double value,
           const std::string& pointer) {
    if (!parameter.is_of_soil()) {
      for (gap::TestRig& rig : out_.data.rigs)
        if (parameter.of.empty() || parameter.of == rig.wheel || parameter.of == soils_[rig.soil])
          sim::set_sweep_parameter(swept, value, rig.rig);
      return;
    }
    for (std::size_t s = 0; s < soils_.size(); ++s) {
      if (!parameter.of.empty() && parameter.of != soils_[s]) continue;
      if (const auto other = sim::not_of_this_soil(swept, out_.nominals[s].mean))
        return fault(pointer, *other);
      sim::WheelRig rig;
      rig.soil = out_.nominals[s].mean;
      sim::set_sweep_parameter(swept, value, rig);
      out_.nominals[s].mean = rig.soil;
    }
  }

  void check_free() {
    for (std::size_t i = 0; i < request_.options.free.size(); ++i) {
      const FreeParameter& parameter = request_.options.free[i];
      const std::string pointer = fmt::format("/free/{}", i);
      if (!known(parameter.of, pointer) || parameter.soil) continue;
      if (request_.data.wheels.empty())
        fault(pointer, fmt::format("{} is felt by wheels, and no wheel was tested", parameter.shown()));
      for (std::size_t s = 0; s < soils_.size(); ++s)
        if (const auto other = sim::not_of_this_soil(parameter.swept, out_.nominals[s].mean)) {
          fault(pointer, *other);
          break;
        }
      if (parameter.name.starts_with("grousers.")) grousers_twice(parameter.of, pointer);
    }
  }

  const Catalogue& catalogue_;
  const SoilEstimateRequest& request_;
  std::vector<Fault>& faults_;
  std::vector<std::string> wheels_, soils_;  // of the tests, in the order in which they come up
  sim::WheelRig base_;
  SoilTestRigs out_;
};

}  // namespace

SoilTestRigs soil_test_rigs(const Catalogue& catalogue, const SoilEstimateRequest& request,
                            std::vector<Fault>& faults) {
  return Resolving(catalogue, request, faults).run();
}

}  // namespace slipway::api
