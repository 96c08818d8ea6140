#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace slipway::planner {

// Whether a drive may be commanded.
enum class Verdict { kGo, kNoGo, kUnknown };

// "go", "no_go", "unknown": the name in answers.
std::string_view describe(Verdict verdict);
// "GO", "NO-GO", "UNKNOWN": what people are told, of a name in answers.
std::string_view verdict_words(std::string_view name);

// Where a drive over a kilometre and more is planned and no other length is asked for [m]: about what a rover
// drives on a sol.
constexpr double kSegment_m = 250.0;
constexpr double kLongDrive_m = 1000.0;

// 0 of a GO, 1 of UNKNOWN, 2 of a NO-GO: of several verdicts the most severe stands.
int severity(Verdict verdict);

// What one rule says of a drive. The name is that of a rule of sim::rule_catalogue() for a limit that breaks
// on the mean soils; "stop", "immobilised" or "embedding" for a probability over the draws; "keep_out",
// "solver" or "dynamics" for what else forbids a drive or leaves it open.
struct JudgedRule {
  std::string name;
  Verdict verdict = Verdict::kGo;
  bool over_draws = false;  // a probability
  // Of the value that is judged, in `unit`, and its interval where it has one.
  double value = 0.0, low = 0.0, high = 0.0;
  double go_below = 0.0, no_go_above = 0.0;  // the bars; of a limit both are the limit
  std::string unit = "1";
  std::optional<double> at_m = {};  // where, along the drive
  std::string words = {};           // a sentence without its full stop
};

// A change that another check has found to help.
struct Advice {
  enum class Kind { kShorterDrive, kOtherRoute, kScoutDrive };
  Kind kind = Kind::kShorterDrive;
  std::string words = {};
  double to_m = 0.0;            // of a shorter drive: where it ends; of a scout drive: where it begins
  double x_m = 0.0, y_m = 0.0;  // that place
  int route = 0;                // the other route's rank
};
// "shorter_drive", "other_route", "scout_drive".
std::string_view describe(Advice::Kind kind);

struct Departures;
struct DisplacedStarts;

// What an operator is told. The verdict is NO-GO where any rule says so, else UNKNOWN where any rule is open,
// else GO.
struct DriveVerdict {
  Verdict verdict = Verdict::kUnknown;
  std::vector<JudgedRule> rules;                 // the ones that decide first
  std::vector<std::string> reasons;              // in words and numbers, the one that decides first
  std::vector<Advice> advice;                    // what would make it better; none of a GO
  std::string otherwise = {};                    // what else could, in words, where the advice is not all
  std::shared_ptr<const Departures> departures;  // where it was asked when the drive may begin
  std::shared_ptr<const DisplacedStarts> starts = {};  // where the start has an error
};

// Adds a rule behind those that are as severe; the verdict is then that of the first.
void add_rule(JudgedRule rule, DriveVerdict& verdict);

}  // namespace slipway::planner
