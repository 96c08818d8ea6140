#pragma once

#include <string>

#include "api/documents/drive_series.h"
#include "api/json/writer.h"
#include "api/requests/answers.h"

namespace slipway::api::json {

// "check/1": verdict and reasons, the rules one by one, grounds and stretches, and the path as GeoJSON with
// its series. The same answer gives the same bytes. Throws std::domain_error where a number is not finite.
std::string write_check_answer(const CheckAnswer& answer, StationDetail detail = StationDetail::kThinned);

// One rule of a verdict.
void write_judged_rule(Writer& w, const planner::JudgedRule& rule);

// "decision": the verdict with its reasons.
void write_decision(Writer& w, const planner::DriveVerdict& decision);

// "outcomes": stops and embeddings by rule, ground and stretch.
void write_outcomes(Writer& w, const sim::DrivePrediction& prediction, const Provenance& provenance,
                    const sim::OutcomeBars& bars);

// "position_uncertainty": how far behind its path a rover is, at the end of each stretch, that is commanded
// by the way its wheels roll (see sim::ShortfallFollower), and how much of that comes between two checks of
// the slip.
void write_position_uncertainty(Writer& w, const sim::DrivePrediction& prediction,
                                const sim::SlipChecks& checks);

}  // namespace slipway::api::json
