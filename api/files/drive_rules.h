#pragma once

#include <string>
#include <string_view>

#include "api/json/strict_reader.h"
#include "api/json/writer.h"
#include "core/result.h"
#include "sim/prediction/drive_prediction.h"

namespace slipway::api {

// By what a drive is judged.
struct DriveRules {
  sim::DriveLimits limits;
  sim::SlipChecks checks;
  sim::OutcomeBars bars;
};

// A named set of rules that drives are checked by (rules/1).
struct RuleSet {
  std::string name;     // of its file
  std::string summary;  // one line for people
  std::string source;   // where these numbers are documented
  DriveRules rules;
};

namespace json {

// "limits", "checks" and "bars" of an object, each of whose keys may be left out.
void read_drive_rules(ObjectReader& reader, DriveRules& rules);
void write_drive_rules(Writer& w, const DriveRules& rules);

// Errors: unreadable_data with every fault.
Result<RuleSet> read_rules_file(std::string_view bytes);

}  // namespace json
}  // namespace slipway::api
