#include "api/files/effect_settings.h"

namespace slipway::api::json {
namespace {

constexpr std::size_t kMaxEffects = 50;

void read_parameters(ObjectReader& effect, sim::EffectSetting& setting) {
  const JsonValue* const parameters = effect.member("parameters", kOptional);
  if (parameters == nullptr) return;
  const std::string pointer = child_pointer(effect.pointer(), "parameters");
  if (!parameters->is(JsonValue::Kind::kObject)) {
    effect.fault("parameters", "parameters = " + describe(*parameters) + ", must be an object");
    return;
  }
  // Which keys there are, and their ranges, is the effect catalogue's to say.
  for (std::size_t i = 0; i < parameters->keys.size(); ++i) {
    const std::string& key = parameters->keys[i];
    double value = 0.0;
    if (read_number(parameters->elements[i], child_pointer(pointer, key), key, {}, value, effect.faults())) {
      setting.parameters[key] = value;
    }
  }
}

}  // namespace

void read_effects(ObjectReader& reader, std::vector<sim::EffectSetting>& effects) {
  for (const Element& element : reader.list("effects", kOptional, {0, kMaxEffects})) {
    ObjectReader effect(*element.value, element.pointer, reader.faults());
    sim::EffectSetting& setting = effects.emplace_back();  // also when faulty: the indices must stay
    effect.text("name", kRequired, {.most = 64}, setting.name);
    effect.boolean("on", kOptional, setting.on);
    read_parameters(effect, setting);
    effect.refuse_unknown();
  }
}

void write_effects(Writer& w, const std::vector<sim::EffectSetting>& effects) {
  w.key("effects").begin_array();
  for (const sim::EffectSetting& effect : effects) {
    w.begin_object().text("name", effect.name);
    if (!effect.on) w.boolean("on", false);
    w.key("parameters").begin_object();
    for (const auto& [key, value] : effect.parameters) w.exact(key, value);
    w.end_object().end_object();
  }
  w.end_array();
}

}  // namespace slipway::api::json
