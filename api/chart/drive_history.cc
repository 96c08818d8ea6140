#include "api/chart/drive_history.h"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <vector>

#include "api/chart/drive_table_charts.h"
#include "api/json/parse.h"
#include "core/angle.h"

namespace slipway::api {
namespace {

using json::JsonValue;

// Follows a path of keys into a document, into the first element of an array; nullptr where there is none.
const JsonValue* within(const JsonValue* value, std::initializer_list<std::string_view> keys) {
  for (const std::string_view key : keys) {
    if (value != nullptr) value = value->find(key);
    if (value != nullptr && value->is(JsonValue::Kind::kArray))
      value = value->elements.empty() ? nullptr : &value->elements.front();
  }
  return value;
}

// Reads one value of every sample; returns false where the column does not fit.
template <typename Set>
bool read_column(const JsonValue& of, std::string_view name, std::vector<sim::SensorReading>& readings,
                 const Set& set) {
  const JsonValue* const column = of.find(name);
  if (column == nullptr || column->elements.size() != readings.size()) return false;
  for (std::size_t i = 0; i < readings.size(); ++i) set(readings[i].sample, column->elements[i].number);
  return true;
}

bool read_wheel(const JsonValue& wheel, std::size_t k, std::vector<sim::SensorReading>& readings) {
  using sim::DriveSample;
  return read_column(wheel, "slip", readings,
                     [k](DriveSample& s, double v) { s.wheels[k].slip_ratio = v; }) &&
         read_column(wheel, "sinkage_m", readings,
                     [k](DriveSample& s, double v) { s.wheels[k].sinkage_m = v; }) &&
         read_column(wheel, "current_a", readings,
                     [k](DriveSample& s, double v) { s.wheels[k].current_a = v; }) &&
         read_column(wheel, "torque_nm", readings,
                     [k](DriveSample& s, double v) { s.wheels[k].torque_nm = v; });
}

// The columns of the time history; empty where their lengths differ.
std::vector<sim::SensorReading> readings_of(const JsonValue& samples, const JsonValue& wheels) {
  using sim::DriveSample;
  const JsonValue* const times = samples.find("time_s");
  std::vector<sim::SensorReading> readings(times != nullptr ? times->elements.size() : 0);
  for (sim::SensorReading& reading : readings)
    reading.sample.wheels = sim::PerWheel<sim::WheelState>(wheels.elements.size());
  bool fit = read_column(samples, "time_s", readings, [](DriveSample& s, double v) { s.time_s = v; }) &&
             read_column(samples, "slip", readings, [](DriveSample& s, double v) { s.slip_ratio = v; }) &&
             read_column(samples, "roll_deg", readings,
                         [](DriveSample& s, double v) { s.attitude.roll_rad = rad_from_deg(v); }) &&
             read_column(samples, "pitch_deg", readings,
                         [](DriveSample& s, double v) { s.attitude.pitch_rad = rad_from_deg(v); });
  for (std::size_t k = 0; fit && k < wheels.elements.size(); ++k)
    fit = read_wheel(wheels.elements[k], k, readings);
  if (!fit) readings.clear();
  return readings;
}

}  // namespace

Result<std::string> draw_drive_history(std::string_view answer) {
  const auto document = json::parse(answer, {.bytes = answer.size(), .values = answer.size()});
  if (!document) return fail(document.error());
  const JsonValue* const drive = within(&*document, {"routes", "features", "properties", "dynamic"});
  if (drive == nullptr)
    return fail(ErrorCode::kNoData,
                "the answer has no dynamic drive to draw: request the dynamic level (rung)");
  const JsonValue* const samples = drive->find("samples");
  const JsonValue* const wheels = samples != nullptr ? samples->find("wheels") : nullptr;
  const JsonValue *const end = drive->find("end"), *const at = drive->find("at_m"),
                         *const commanded = drive->find("commanded_m"),
                         *const rover = document->find("rover"), *const reason = drive->find("reason");
  if (wheels == nullptr || wheels->elements.size() > sim::kMaxWheels ||
      std::any_of(wheels->elements.begin(), wheels->elements.end(),
                  [](const JsonValue& w) { return w.keys.empty(); }) ||
      end == nullptr || at == nullptr || commanded == nullptr || rover == nullptr)
    return fail(ErrorCode::kInternal, "the answer's dynamic drive is not whole");
  if (const JsonValue* const count = samples->find("count"); count != nullptr && count->number == 0.0)
    return fail(ErrorCode::kNoData, fmt::format("the dynamic drive has no samples to draw: {}",
                                                reason != nullptr ? reason->text : end->text));
  const std::vector<sim::SensorReading> readings = readings_of(*samples, *wheels);
  if (readings.empty()) return fail(ErrorCode::kInternal, "the samples of the dynamic drive do not fit");
  sim::RoverModel named;  // the chart needs only the wheels' names
  for (const std::string& name : wheels->keys) named.wheels.emplace_back().name = name;
  return draw_time_history(
      fmt::format("{}: {}, {:.2f} of {:.2f} m", rover->text, end->text, at->number, commanded->number), named,
      readings);
}

}  // namespace slipway::api
