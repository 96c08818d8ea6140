#pragma once

#include <span>
#include <string>

#include "api/steps/step_comparison.h"

namespace slipway::api {

// "steps-score/1": an entry of `steps` for every row of the table, and the summary.
std::string step_comparison_json(const StepComparisonRequest& request, std::span<const steps::SlipStep> steps,
                                 const StepComparison& comparison);

// The same summary for people.
std::string step_comparison_text(const StepComparisonRequest& request, const StepComparison& comparison);

// "0.0179 (0.0167 to 0.0191)": an estimate times a factor, with so many digits.
std::string estimate_words(const steps::Estimate& estimate, double factor, int digits);

std::string_view name_of(steps::StepLearning learning);

}  // namespace slipway::api
