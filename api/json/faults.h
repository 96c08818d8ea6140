#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/fault_words.h"
#include "core/result.h"
#include "sim/rover/rover_model.h"

namespace slipway::api {

// Whether some fault lies at the pointer or below it.
bool has_fault_under(const std::vector<Fault>& faults, std::string_view pointer);

// Puts `prefix` before every pointer.
std::vector<Fault> moved_under(std::string_view prefix, std::vector<Fault> faults);

// The fault of a request whose motor_temp_c has no effect; empty where the effect motor_temperature is on.
std::optional<Fault> temperature_without_effect(const sim::RoverModel& rover,
                                                const std::vector<sim::EffectSetting>& requested);

// With texts and a list of faults that an answer may hold and a store may keep, whatever was sent: what is
// too long ends in "...", and the last of too many faults says how many more there are.
Error bounded(Error error);

// One sentence for an error's detail.
std::string summary_of(const std::vector<Fault>& faults);

}  // namespace slipway::api
