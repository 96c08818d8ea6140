#include "api/documents/soil/soil_estimate_request.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "api/documents/soil/sweep_settings.h"
#include "api/files/effect_settings.h"
#include "api/files/soil_tests_csv.h"
#include "api/json/faults.h"
#include "api/json/parse.h"
#include "api/json/strict_reader.h"
#include "core/largest_exact_whole.h"

namespace slipway::api::json {
namespace {

constexpr std::size_t kMaxTests = 2000, kMaxPlates = 100, kMaxSamples = 2000, kMaxNamed = 50, kMaxFree = 60;

void read_grousers(ObjectReader& reader, TestedWheel& wheel) {
  auto object = reader.object("grousers", kOptional);
  if (!object) return;
  wheel.grousers.emplace();
  object->number("height_m", kRequired, {"m", 0.0, 0.2}, wheel.grousers->height_m);
  object->number("count", kRequired, {"1", 0.0, 200.0}, wheel.grousers->count);
  object->refuse_unknown();
}

void read_wheel(ObjectReader& reader, TestedWheel& wheel) {
  reader.text("rover", kOptional, {.most = 64, .is_name = true}, wheel.rover);
  reader.text("wheel", kOptional, {.most = 64, .is_name = true}, wheel.wheel);
  reader.number("radius_m", kOptional, {"m", 0.01, 2.0}, wheel.radius_m);
  reader.number("width_m", kOptional, {"m", 0.005, 2.0}, wheel.width_m);
  reader.number("motor_temp_c", kOptional, {"C", -150.0, 150.0}, wheel.motor_temp_c);
  read_grousers(reader, wheel);
}

// The wheels and soils that tests name.
void read_named(ObjectReader& reader, SoilEstimateRequest& request) {
  const TextRule name{.most = 64, .is_name = true};
  for (const Element& element : reader.list("wheels", kOptional, {0, kMaxNamed})) {
    ObjectReader object = reader.object(element);
    NamedWheel& wheel = request.wheels.emplace_back();
    if (!object.is_object()) continue;
    object.text("name", kRequired, name, wheel.name);
    object.number("radius_m", kOptional, {"m", 0.01, 2.0}, wheel.wheel.radius_m);
    object.number("width_m", kOptional, {"m", 0.005, 2.0}, wheel.wheel.width_m);
    read_grousers(object, wheel.wheel);
    object.refuse_unknown();
  }
  for (const Element& element : reader.list("soils", kOptional, {0, kMaxNamed})) {
    ObjectReader object = reader.object(element);
    TestedSoil& soil = request.soils.emplace_back();
    if (!object.is_object()) continue;
    object.text("name", kRequired, name, soil.name);
    object.text("soil", kRequired, name, soil.soil);
    object.refuse_unknown();
  }
}

void read_wheel_tests(ObjectReader& reader, sim::SlipDefinition definition, sim::SlipRadius radius,
                      SoilEstimateRequest& request) {
  for (const Element& element : reader.list("wheel_tests", kOptional, {1, kMaxTests})) {
    const std::size_t before = reader.faults().size();
    ObjectReader test = reader.object(element);
    if (!test.is_object()) continue;
    std::vector<std::optional<double>> values;
    for (const TestColumn& column : wheel_test_columns()) {
      auto& value = values.emplace_back();
      test.number(column.name, column.required ? kRequired : kOptional,
                  {"", column.lowest, column.highest, column.above_lowest}, value);
    }
    const TextRule name{.most = 64, .is_name = true};
    std::string wheel, soil;
    test.text("wheel", kOptional, name, wheel);
    test.text("soil", kOptional, name, soil);
    test.refuse_unknown();
    std::vector<std::string> faults;
    gap::WheelObservation& observation = request.data.wheels.emplace_back(wheel_observation(values, faults));
    observation.test.slip_definition = definition;
    observation.test.slip_radius = radius;
    observation.wheel = wheel;
    observation.soil = soil;
    for (std::size_t i = 0; reader.faults().size() == before && i < faults.size(); ++i)
      reader.faults().push_back({element.pointer, faults[i]});
  }
}

void read_plate_tests(ObjectReader& reader, SoilEstimateRequest& request) {
  for (const Element& element : reader.list("plate_tests", kOptional, {1, kMaxPlates})) {
    ObjectReader test = reader.object(element);
    if (!test.is_object()) continue;
    gap::PlateRecord& plate = request.data.plates.emplace_back();
    test.number("plate_radius_m", kRequired, {"m", 0.001, 5.0}, plate.radius_m);
    test.numbers("sinkage_m", kRequired, {1, kMaxSamples}, {"m", 0.0, 5.0, true}, plate.sinkage_m);
    test.numbers("pressure_pa", kRequired, {1, kMaxSamples}, {"Pa", -1e9, 1e9}, plate.pressure_pa);
    test.refuse_unknown();
    if (!has_fault_under(reader.faults(), element.pointer) &&
        plate.sinkage_m.size() != plate.pressure_pa.size())
      reader.faults().push_back(
          {element.pointer, fmt::format("{} sinkages and {} pressures, must be as many",
                                        plate.sinkage_m.size(), plate.pressure_pa.size())});
  }
}

// Nothing, and a fault at the pointer, where there is no such number.
std::optional<gap::FreeParameter> parameter_of(const std::string& text, const std::string& pointer,
                                               std::vector<Fault>& faults) {
  auto parameter = gap::free_parameter(text);
  if (!parameter) faults.push_back({pointer, unknown_name("parameter", text, gap::free_parameter_names())});
  return parameter;
}

void read_free(ObjectReader& reader, gap::SoilEstimationOptions& options) {
  std::vector<std::string> free;
  reader.texts("free", kOptional, {1, kMaxFree}, {.most = 128}, free);
  for (std::size_t i = 0; i < free.size(); ++i)
    if (auto parameter = parameter_of(free[i], child_pointer(reader.pointer() + "/free", i), reader.faults()))
      options.free.push_back(std::move(*parameter));
  for (const Element& element : reader.list("bounds", kOptional, {0, kMaxFree})) {
    ObjectReader object = reader.object(element);
    if (!object.is_object()) continue;
    std::string name;
    double lowest = 0.0, highest = 0.0;
    const bool good = object.text("parameter", kRequired, {.most = 128}, name) &
                      object.number("lowest", kRequired, {}, lowest) &
                      object.number("highest", kRequired, {}, highest);
    object.refuse_unknown();
    if (!good) continue;
    const auto parameter = parameter_of(name, element.pointer + "/parameter", reader.faults());
    if (!parameter) continue;
    const double unit = parameter->boundary_unit();
    options.bounds.push_back({*parameter, lowest / unit, highest / unit});
  }
}

void read_options(ObjectReader& reader, gap::SoilEstimationOptions& options) {
  read_free(reader, options);
  std::size_t prior = 0, loss = 0;
  if (reader.choice("prior", kOptional, {"none", "wide", "soil"}, prior))
    options.priors = static_cast<gap::SoilPriors>(prior);
  const auto losses = gap::robust_loss_names();
  if (reader.choice("loss", kOptional, {losses.begin(), losses.end()}, loss))
    options.loss = static_cast<gap::RobustLoss>(loss);
  reader.number("loss_scale", kOptional, {"", 0.0, 100.0, true}, options.loss_scale);
  if (reader.number("noise", kOptional, {"", 1e-4, 1.0}, options.noise.share))
    options.noise.share_of_rms = 0.25 * options.noise.share;
  reader.boolean("profile", kOptional, options.profile);
  reader.whole("seed", kOptional, std::uint64_t{0}, kMaxExactWhole, options.seed);
}

// Drives bring their rover, their soils and what is asked of them: all else would be dropped in silence.
void refuse_beside_campaign(const JsonValue& document, std::vector<Fault>& faults) {
  for (const std::string& key : document.keys)
    if (key != "campaign" && key != "channels" && key != "wheel_tests" && key != "plate_tests")
      faults.push_back(
          {"/" + key, fmt::format("{} is not used where the drives of a campaign are asked", key)});
}

}  // namespace

SlipOfTests read_soil_estimate(ObjectReader& reader, SoilEstimateRequest& request) {
  reader.text("campaign", kOptional, {.most = 64, .is_name = true}, request.campaign);
  reader.text("soil", kOptional, {.most = 64, .is_name = true}, request.soil);
  read_wheel(reader, request.wheel);
  read_named(reader, request);
  read_effects(reader, request.effects);
  read_settings(reader, request.set);
  reader.number("gravity_m_s2", kOptional, {"m/s^2", 0.1, 30.0}, request.gravity_m_s2);
  reader.number("speed_m_s", kOptional, {"m/s", 1e-4, 5.0}, request.speed_m_s);
  std::size_t definition = 0, radius = 0;
  reader.choice("slip_definition", kOptional, {"forward", "travel"}, definition);
  reader.choice("slip_radius", kOptional, {"rim", "shear", "tip"}, radius);
  const SlipOfTests slip{static_cast<sim::SlipDefinition>(definition), static_cast<sim::SlipRadius>(radius)};
  read_wheel_tests(reader, slip.definition, slip.radius, request);
  read_plate_tests(reader, request);
  std::vector<std::string> channels;
  reader.texts("channels", kOptional, {1, 10}, {.most = 64, .is_name = true}, channels);
  read_options(reader, request.options);
  reader.refuse_unknown();
  for (Fault& fault : choose_channels(channels, request))
    reader.faults().push_back({reader.pointer() + fault.pointer, std::move(fault.message)});
  return slip;
}

Result<Reading<SoilEstimateRequest>> read_soil_estimate_request(std::string_view bytes) {
  const auto document = parse(bytes, {.bytes = RequestLimits::kBodyBytes});
  if (!document) return fail(document.error());
  Reading<SoilEstimateRequest> reading;
  SoilEstimateRequest& request = reading.request;
  ObjectReader reader(*document, "", reading.faults);
  if (!reader.is_object()) return reading;
  read_soil_estimate(reader, request);
  if (!request.campaign.empty()) refuse_beside_campaign(*document, reading.faults);
  const bool tests = !request.data.wheels.empty() || !request.data.plates.empty();
  if (reading.faults.empty() && tests == !request.campaign.empty())
    reading.faults.push_back({"", tests ? "there are tests and a campaign: one of them is enough"
                                        : "there are no wheel_tests, no plate_tests and no campaign"});
  return reading;
}

}  // namespace slipway::api::json
