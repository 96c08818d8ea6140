#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "planner/problem/problem.h"
#include "planner/problem/verdict.h"
#include "sim/prediction/drive_prediction.h"

namespace slipway::planner {

// "4.2 %", "12 %"; with two digits more where it lies within a tenth of the bar.
std::string percent(double share, double bar = 0.0);

// "a halt in 4.2 % of the draws (90 % interval 2.1 to 7.9 %), GO below 20 %".
std::string share_words(std::string_view what, const sim::DrawnShare& share, double go_below,
                        double no_go_above, Verdict verdict);

// Where most draws halt first; null where none does.
const sim::StationPrediction* worst_station(const sim::DrivePrediction& drive);

// The rule that halts most draws; null where none does.
const sim::RuleRisk* main_halt(const sim::DrivePrediction& drive);

// A rule that trips in some draw: by how much then, where, on which ground and why.
std::string halt_words(const PlanProblem& problem, const sim::DrivePrediction& drive,
                       const sim::RuleRisk& rule);

// "climb", "descent", "cross_slope", "soil", "load" or "rough_ground": what makes a rule's value what it is
// where it comes nearest to its limit.
std::string_view cause_of(const sim::RuleRisk& rule, const sim::DrivePrediction& drive);

// The rules that trip in some draw, the likeliest first.
std::vector<std::string> tripping_words(const sim::DrivePrediction& drive);

// The rule of the request that a drive which keeps all of them comes nearest to.
std::string nearest_limit_words(const sim::DrivePrediction& drive);

// The ground on which most draws halt; empty where none does.
std::string ground_words(const PlanProblem& problem, const sim::DrivePrediction& drive);

// c1 and c2, where the drive on the mean soils hangs on them; empty otherwise.
std::string closure_words(const PlanProblem& problem, const sim::DrivePrediction& drive);

// How many segments are how, the sols, and the worst segment.
std::vector<std::string> segment_words(const sim::DriveOutcomes& outcomes, const sim::OutcomeBars& bars);

}  // namespace slipway::planner
