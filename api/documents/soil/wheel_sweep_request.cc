#include "api/documents/soil/wheel_sweep_request.h"

#include <fmt/format.h>

#include <stdexcept>

#include "api/documents/drive_assumptions.h"
#include "api/documents/soil/sweep_settings.h"
#include "api/files/effect_settings.h"
#include "api/json/parse.h"
#include "api/json/strict_reader.h"
#include "api/json/writer.h"

namespace slipway::api::json {
namespace {

const std::vector<std::string_view> kSlipDefinitions{"forward", "travel"};
const std::vector<std::string_view> kSlipRadii{"rim", "shear", "tip"};
const std::vector<std::string_view> kHeldSpeeds{"rim", "travel"};

// The range that a sweep over the same number has.
NumberRule rule_of(std::string_view parameter) {
  const auto field = sim::sweep_field(parameter);
  if (!field) throw std::logic_error("no sweep parameter of this name");
  return {field->unit, field->lowest, field->highest};
}

void read_grousers(ObjectReader& reader, std::optional<sim::Grousers>& grousers) {
  auto object = reader.object("grousers", kOptional);
  if (!object) return;
  grousers.emplace();
  object->number("height_m", kRequired, rule_of("effects.grousers.height_m"), grousers->height_m);
  object->number("count", kRequired, rule_of("effects.grousers.count"), grousers->count);
  object->refuse_unknown();
}

void read_test(ObjectReader& reader, WheelSweepRequest& request) {
  sim::WheelRigConditions& test = request.test;
  reader.number("gravity_m_s2", kOptional, rule_of("gravity_m_s2"), test.gravity_m_s2);
  reader.number("load_n", kOptional, rule_of("load_n"), request.load_n);
  reader.number("sinkage_m", kOptional, rule_of("sinkage_m"), test.sinkage_m);
  if (request.load_n && test.sinkage_m)
    reader.fault("sinkage_m", "sinkage_m and load_n: a wheel is held at a depth or carries a load, not both");
  reader.number("slip", kOptional, rule_of("slip"), test.slip);
  double slope_rad = 0.0;
  if (reader.member("slope_deg", kOptional) != nullptr &&
      reader.angle_deg("slope_deg", kOptional, rule_of("slope_deg"), slope_rad)) {
    test.slope_rad = slope_rad;
    if (reader.member("slip", kOptional) != nullptr)
      reader.fault("slip", "slip and slope_deg: on a slope the slip follows from the pull");
  }
  reader.angle_deg("slip_angle_deg", kOptional, rule_of("slip_angle_deg"), test.slip_angle_rad);
  std::size_t choice = 0;
  if (reader.choice("slip_definition", kOptional, kSlipDefinitions, choice))
    test.slip_definition = choice == 0 ? sim::SlipDefinition::kForward : sim::SlipDefinition::kTravel;
  if (reader.choice("slip_radius", kOptional, kSlipRadii, choice))
    test.slip_radius = static_cast<sim::SlipRadius>(choice);
  reader.number("speed_m_s", kOptional, rule_of("speed_m_s"), request.speed_m_s);
  if (reader.choice("speed_of", kOptional, kHeldSpeeds, choice)) test.speed_is_of_travel = choice == 1;
  reader.number("motor_temp_c", kOptional, rule_of("motor_temp_c"), request.motor_temp_c);
  reader.boolean("in_a_track", kOptional, test.in_a_track);
}

// {"parameter": "slip", "values": [0, 0.1]} or {"parameter": "slip", "from": 0, "to": 0.9, "step": 0.1}
void read_axis(const Element& element, sim::SweepAxis& axis, std::vector<Fault>& faults) {
  ObjectReader reader(*element.value, element.pointer, faults);
  reader.text("parameter", kRequired, {.most = 100}, axis.parameter);
  const NumberRule any{"", -1e12, 1e12};
  if (element.value->find("values") != nullptr) {
    reader.numbers("values", kRequired, {1, sim::kMaxSweepRows}, any, axis.values);
    return reader.refuse_unknown();
  }
  // Where the parameter is unknown, that is the fault that is said.
  const NumberRule ends = sim::sweep_field(axis.parameter) ? rule_of(axis.parameter) : any;
  double from = 0.0, to = 0.0, step = 0.0;
  const bool good = reader.number("from", kRequired, ends, from) & reader.number("to", kRequired, ends, to) &
                    reader.number("step", kRequired, {"", 0.0, 1e12, true}, step);
  reader.refuse_unknown();
  if (!good) return;
  if (to < from) return reader.fault("to", fmt::format("to = {:g}, must be at least from = {:g}", to, from));
  axis.values = sim::stepped(from, to, step);
}

}  // namespace

Result<Reading<WheelSweepRequest>> read_wheel_sweep_request(std::string_view bytes) {
  const auto document = parse(bytes, {.bytes = RequestLimits::kBodyBytes});
  if (!document) return fail(document.error());
  Reading<WheelSweepRequest> reading;
  WheelSweepRequest& request = reading.request;
  ObjectReader reader(*document, "", reading.faults);
  if (!reader.is_object()) return reading;
  const TextRule name{.most = 64, .is_name = true};
  reader.text("rover", kRequired, name, request.rover);
  reader.text("wheel", kOptional, name, request.wheel);
  reader.text("soil", kRequired, name, request.soil);
  reader.number("radius_m", kOptional, rule_of("wheel.radius_m"), request.radius_m);
  reader.number("width_m", kOptional, rule_of("wheel.width_m"), request.width_m);
  read_grousers(reader, request.grousers);
  read_test(reader, request);
  read_effects(reader, request.effects);
  read_settings(reader, request.set);
  reader.boolean("whole_rover", kOptional, request.whole_rover);
  if (request.whole_rover && !request.test.slope_rad && reader.member("slip", kOptional) != nullptr)
    reader.fault("slip", "slip and whole_rover: the slip of a whole rover follows from the slope");
  reader.boolean("paired", kOptional, request.paired);
  for (const Element& element :
       reader.list("sweep", kOptional, {0, request.paired ? sim::kMaxPairedAxes : sim::kMaxSweepAxes}))
    read_axis(element, request.sweep.emplace_back(), reading.faults);
  reader.refuse_unknown();
  return reading;
}

std::string write_wheel_sweep_request(const WheelSweepRequest& request) {
  const sim::WheelRigConditions& test = request.test;
  Writer w;
  w.begin_object().text("rover", request.rover);
  if (!request.wheel.empty()) w.text("wheel", request.wheel);
  w.text("soil", request.soil);
  if (request.radius_m) w.exact("radius_m", *request.radius_m);
  if (request.width_m) w.exact("width_m", *request.width_m);
  if (request.grousers)
    w.key("grousers")
        .begin_object()
        .exact("height_m", request.grousers->height_m)
        .exact("count", request.grousers->count)
        .end_object();
  w.exact("gravity_m_s2", test.gravity_m_s2);
  if (request.load_n) w.exact("load_n", *request.load_n);
  if (test.sinkage_m) w.exact("sinkage_m", *test.sinkage_m);
  if (test.slope_rad)
    w.angle_deg("slope_deg", *test.slope_rad);
  else if (!request.whole_rover)
    w.exact("slip", test.slip);
  w.angle_deg("slip_angle_deg", test.slip_angle_rad);
  w.text("slip_definition", kSlipDefinitions[test.slip_definition == sim::SlipDefinition::kTravel ? 1 : 0]);
  if (test.slip_radius != sim::SlipRadius::kRim)
    w.text("slip_radius", kSlipRadii[static_cast<std::size_t>(test.slip_radius)]);
  if (request.speed_m_s) w.exact("speed_m_s", *request.speed_m_s);
  w.text("speed_of", kHeldSpeeds[test.speed_is_of_travel ? 1 : 0]);
  if (request.motor_temp_c) w.exact("motor_temp_c", *request.motor_temp_c);
  w.boolean("in_a_track", test.in_a_track);
  write_effects(w, request.effects);
  w.key("set").begin_object();
  for (const sim::SweepSetting& setting : request.set) w.exact(setting.parameter, setting.value);
  w.end_object();
  if (request.whole_rover) w.boolean("whole_rover", true);
  if (request.paired) w.boolean("paired", true);
  w.key("sweep").begin_array();
  for (const sim::SweepAxis& axis : request.sweep) {
    w.begin_object().text("parameter", axis.parameter).key("values").begin_array();
    for (const double value : axis.values) w.exact(value);
    w.end_array().end_object();
  }
  w.end_array().end_object();
  return w.take();
}

}  // namespace slipway::api::json
