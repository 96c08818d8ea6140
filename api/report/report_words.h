#pragma once

#include <fmt/format.h>

#include <string>

#include "gap/estimate/interval.h"

namespace slipway::api {

// Numbers in the words of a report. "none" where there is no number.

std::string interval_words(const gap::Interval& x, double unit = 1.0);  // "1.2 (0.9 to 1.5)"
std::string number_words(fmt::format_string<double> format, double value);
std::string p_words(double p);            // "below 0.001"
std::string probability_words(double p);  // "above 0.999"

}  // namespace slipway::api
