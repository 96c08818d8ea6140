#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>

#include "gap/diagnosis/result/result.h"
#include "gap/estimate/interval.h"

namespace slipway::api {

// Numbers in the words of a report. "none" where there is no number.

std::string interval_words(const gap::Interval& x, double unit = 1.0);  // "1.2 (0.9 to 1.5)"
std::string number_words(fmt::format_string<double> format, double value);
std::string p_words(double p);            // "below 0.001"
std::string probability_words(double p);  // "above 0.999"

std::string unit_words(std::string_view unit);  // " N" behind a number; nothing where it has no unit

// The catalogue's sentence on an effect, and the unit of one of its parameters; "" where it has none.
std::string_view effect_summary(std::string_view effect);
std::string_view effect_unit(std::string_view effect, std::string_view parameter);

// The parameters of a cause from outside, with intervals and units: "force_n = -22 (-24 to -20) N".
std::string outside_parameters_words(const gap::ResidualShape& cause);

// Why no next drive is offered.
std::string no_drive_offered_words();

}  // namespace slipway::api
