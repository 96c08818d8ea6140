#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "sim/rover/rover_model.h"

namespace slipway::api {

// Text from outside as a message shows it: in quotes, cut where long, never half a UTF-8 character.
std::string in_quotes(std::string_view text);

// Of `known`, the one that `name` was probably meant to be.
std::optional<std::string> nearest(std::string_view name, const std::vector<std::string>& known);

// "unknown rover \"mer\"; did you mean \"mer-class\"? known: fido-class, mer-class"
std::string unknown_name(std::string_view kind, std::string_view name, const std::vector<std::string>& known);

// Whether some fault lies at the pointer or below it.
bool has_fault_under(const std::vector<Fault>& faults, std::string_view pointer);

// Puts `prefix` before every pointer.
std::vector<Fault> moved_under(std::string_view prefix, std::vector<Fault> faults);

// Why a request's motor_temp_c is refused where nothing reads it; nothing where motor_temperature is on.
std::optional<Fault> temperature_without_effect(const sim::RoverModel& rover,
                                                const std::vector<sim::EffectSetting>& requested);

// One sentence for an error's detail.
std::string summary_of(const std::vector<Fault>& faults);

}  // namespace slipway::api
