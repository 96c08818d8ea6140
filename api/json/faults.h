#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "sim/rover/rover_model.h"

namespace slipway::api {

// Text from outside as a message shows it: in quotes and shortened where it is long, never within a UTF-8
// character.
std::string in_quotes(std::string_view text);

// The name among `known` that `name` was probably meant to be; empty where none is near.
std::optional<std::string> nearest(std::string_view name, const std::vector<std::string>& known);

// "unknown rover \"mer\"; did you mean \"mer-class\"? known: fido-class, mer-class"
std::string unknown_name(std::string_view kind, std::string_view name, const std::vector<std::string>& known);

// Whether some fault lies at the pointer or below it.
bool has_fault_under(const std::vector<Fault>& faults, std::string_view pointer);

// Puts `prefix` before every pointer.
std::vector<Fault> moved_under(std::string_view prefix, std::vector<Fault> faults);

// The fault of a request whose motor_temp_c has no effect; empty where the effect motor_temperature is on.
std::optional<Fault> temperature_without_effect(const sim::RoverModel& rover,
                                                const std::vector<sim::EffectSetting>& requested);

// One sentence for an error's detail.
std::string summary_of(const std::vector<Fault>& faults);

}  // namespace slipway::api
