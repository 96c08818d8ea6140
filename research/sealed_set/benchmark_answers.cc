#include "research/sealed_set/benchmark_answers.h"

#include <string>

#include "api/json/parse.h"
#include "api/json/strict_reader.h"

namespace slipway::api::json {
namespace {

constexpr ParseLimits kLimits{.bytes = std::size_t{16} << 20U, .values = 1'000'000, .keys = 2000};

gap::HiddenAnswer read_answer(const std::string& campaign, const JsonValue& value,
                              std::vector<Fault>& faults) {
  gap::HiddenAnswer answer;
  answer.campaign = campaign;
  ObjectReader reader(value, child_pointer("", campaign), faults);
  if (const auto reading = reader.object("effects", kRequired); reading && reading->is_object()) {
    const JsonValue& effects = *value.find("effects");
    for (std::size_t i = 0; i < effects.keys.size(); ++i) {
      answer.effects.insert(effects.keys[i]);
      const JsonValue* wheel = effects.elements[i].find("wheel");
      if (wheel != nullptr && wheel->is(JsonValue::Kind::kNumber))
        answer.wheel_of[effects.keys[i]] = wheel->number;
    }
  }
  reader.text("fidelity", kOptional, {}, answer.fidelity);
  reader.text("kind", kOptional, {}, answer.kind);
  reader.number("size", kOptional, {.unit = "1", .lowest = 0.0}, answer.size);
  std::size_t nominal = 0;
  if (reader.choice("nominal", kOptional, {"true", "near", "usual", "far"}, nominal))
    answer.nominal_off = nominal >= 2;
  if (auto place = reader.object("place", kOptional); place && place->is_object()) {
    gap::HiddenAnswer::Place disc;
    const bool whole = place->number("x_m", kRequired, {.unit = "m"}, disc.x_m) &
                       place->number("y_m", kRequired, {.unit = "m"}, disc.y_m) &
                       place->number("radius_m", kRequired, {.unit = "m", .lowest = 0.0}, disc.radius_m);
    if (whole) answer.place = disc;
  }
  return answer;
}

}  // namespace

Result<std::vector<gap::HiddenAnswer>> read_benchmark_answers(std::string_view bytes) {
  const auto document = parse(bytes, kLimits);
  if (!document) return fail(document.error());
  std::vector<Fault> faults;
  std::vector<gap::HiddenAnswer> answers;
  if (!document->is(JsonValue::Kind::kObject))
    faults.push_back({"", "answers.json must be an object with a member for each campaign"});
  for (std::size_t i = 0; i < document->keys.size(); ++i)
    answers.push_back(read_answer(document->keys[i], document->elements[i], faults));
  if (!faults.empty())
    return fail(ErrorCode::kInvalidRequest, "answers.json can't be used", std::move(faults));
  return answers;
}

}  // namespace slipway::api::json
