#include "api/files/failed_wheels.h"

#include <fmt/format.h>

namespace slipway::api::json {

void read_failed_wheels(ObjectReader& reader, sim::FailedWheels& failed) {
  const JsonValue* const value = reader.member("failed_wheels", kOptional);
  if (value == nullptr) return;
  ObjectReader object(*value, child_pointer(reader.pointer(), "failed_wheels"), reader.faults());
  if (!object.is_object()) return;
  for (const std::string& wheel : value->keys) {
    std::size_t failure = 0;
    if (object.choice(wheel, kRequired, sim::wheel_failure_names(), failure))
      failed[wheel] = static_cast<sim::WheelFailure>(failure);
  }
}

}  // namespace slipway::api::json
