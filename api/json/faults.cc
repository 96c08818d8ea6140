#include "api/json/faults.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "core/text_encoding.h"
#include "sim/effects/effect_catalogue.h"

namespace slipway::api {

bool has_fault_under(const std::vector<Fault>& faults, std::string_view pointer) {
  return std::any_of(faults.begin(), faults.end(), [pointer](const Fault& f) {
    return f.pointer.starts_with(pointer) &&
           (f.pointer.size() == pointer.size() || f.pointer[pointer.size()] == '/');
  });
}

std::vector<Fault> moved_under(std::string_view prefix, std::vector<Fault> faults) {
  for (Fault& fault : faults) fault.pointer.insert(0, prefix);
  return faults;
}

std::optional<Fault> temperature_without_effect(const sim::RoverModel& rover,
                                                const std::vector<sim::EffectSetting>& requested) {
  for (const sim::EffectSetting& setting : sim::in_force(rover.effects, requested))
    if (const sim::Effect* const effect = sim::find_effect(setting.name);
        effect != nullptr && effect->reads_motor_temperature)
      return std::nullopt;
  std::vector<std::string_view> readers;
  for (const sim::Effect& effect : sim::effect_catalogue())
    if (effect.reads_motor_temperature) readers.push_back(effect.name);
  return Fault{
      "/motor_temp_c",
      fmt::format("motor_temp_c counts only where the effect {} is on: switch it on or leave this out",
                  fmt::join(readers, " or "))};
}

Error bounded(Error error) {
  constexpr std::size_t kMaxFaults = 100, kMaxPointer = 300, kMaxText = 1000;
  error.detail = cut_to(std::move(error.detail), kMaxText);
  if (const std::size_t count = error.faults.size(); count > kMaxFaults) {
    error.faults.resize(kMaxFaults - 1);
    error.faults.push_back({"", fmt::format("and {} faults more", count - (kMaxFaults - 1))});
  }
  for (Fault& fault : error.faults) {
    fault.pointer = cut_to(std::move(fault.pointer), kMaxPointer);
    fault.message = cut_to(std::move(fault.message), kMaxText);
  }
  return error;
}

std::string summary_of(const std::vector<Fault>& faults) {
  return faults.size() == 1 ? faults.front().message
                            : fmt::format("{} faults; the first: {}", faults.size(), faults.front().message);
}

}  // namespace slipway::api
