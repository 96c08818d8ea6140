#pragma once

#include <string>
#include <string_view>

#include "core/result.h"

namespace slipway::server {

// Answers as tables for people. Each takes the document that machines get, so both see the same figures.
// Errors: internal, where the document is not of that kind.
// Of a plan, a prediction or a check: at most 15 lines, and with `why` all that led to them.
Result<std::string> plan_table(std::string_view answer, bool why);
Result<std::string> sol_table(std::string_view answer, bool why);
Result<std::string> prediction_table(std::string_view answer, bool why);
Result<std::string> check_table(std::string_view answer, bool why);
Result<std::string> comparison_table(std::string_view comparison);
Result<std::string> answer_comparison_table(std::string_view comparison);
Result<std::string> wheel_table(std::string_view answer);
Result<std::string> terrain_table(std::string_view document);
Result<std::string> rover_table(std::string_view document);
Result<std::string> soil_table(std::string_view document);
Result<std::string> effect_table(std::string_view document);
// The parameters of every effect in the document: unit, value by default, range and meaning.
Result<std::string> effect_field_table(std::string_view document);

// An error with every fault, a line each.
std::string error_text(const Error& error);

}  // namespace slipway::server
