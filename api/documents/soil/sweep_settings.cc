#include "api/documents/soil/sweep_settings.h"

#include "api/json/faults.h"

namespace slipway::api::json {

void read_settings(ObjectReader& reader, std::vector<sim::SweepSetting>& set) {
  const JsonValue* const settings = reader.member("set", kOptional);
  if (settings == nullptr) return;
  if (!settings->is(JsonValue::Kind::kObject))
    return reader.fault("set", "set = " + describe(*settings) + ", must be an object");
  for (std::size_t i = 0; i < settings->keys.size(); ++i) {
    const std::string& key = settings->keys[i];
    double value = 0.0;
    if (read_number(settings->elements[i], child_pointer("/set", key), key, {}, value, reader.faults()))
      set.push_back({key, value});
  }
}

}  // namespace slipway::api::json
