#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sim/prediction/drive_limits.h"
#include "sim/quasi_static/quasi_static.h"
#include "sim/rover/drive_command.h"
#include "sim/rover/rover_model.h"
#include "sim/rover/stance.h"

namespace slipway::sim {

// What may halt a drive, or embed the rover. The catalogue has one row for each.
enum class Rule {
  kSlipCheck,
  kTilt,
  kPitch,
  kRoll,
  kSuspension,
  kCurrent,
  kSinkage,
  kClearance,
  kSideSlip,
  kAside,
  kDriveTime,
  kEnergy,
  kStance,
  kImmobilised,
  kEmbedding
};
inline constexpr std::size_t kRules = 15;

// When a value trips its rule.
enum class Trips { kAtOrAbove, kAbove, kBelow };

// A value, and the index of the wheel whose it is; -1 where it is the rover's.
struct Measured {
  double value = 0.0;
  int wheel = -1;
};

// One rule. A rule that is measured at each station alone takes a row and a member of DriveLimits, and
// nothing else: requests, flags, answers and the verdict read this catalogue.
struct RuleRow {
  Rule rule;
  std::string_view name;      // "slip_check"
  std::string_view quantity;  // "slip", before its value
  std::string_view words;     // "slip over a stretch between checks", in a table
  std::string_view unit;      // at the boundary; "1" where it has none
  double factor = 1.0;        // from SI to that unit
  Trips trips = Trips::kAbove;
  // The member of DriveLimits and its key in requests, with its range in the unit. The least value itself is
  // refused where it is not `least_allowed`. No member: the limit is none of a request's.
  double DriveLimits::*limit = nullptr;
  std::string_view key = {};
  double least = 0.0, most = 0.0;
  bool least_allowed = false;
  std::string_view help = {};  // of the flag
  // What makes the value what it is; empty: the slope, or on less than 5 deg the soil.
  std::string_view cause = {};
  // It hangs on the ground's shape, and is measured where the rover is held too.
  bool of_shape = false;
  // The value at a station, in SI. Null: OutcomeFollower keeps account of it along the way.
  Measured (*at)(const RoverModel& rover, const Stance& stance, const StationState& state) = nullptr;

  bool tripped_by(double value, double limit_value) const;
};

// In the order of Rule.
std::span<const RuleRow> rule_catalogue();
const RuleRow& row_of(Rule rule);
std::string_view describe(Rule rule);  // the row's name

// A limit of a request, or the constant that stands for it: 1 of immobilised, the share of the radius of
// embedding.
double limit_of(Rule rule, const DriveLimits& limits, const SlipChecks& checks);

// "0.52", "26.1 deg": a value of a rule in its unit. More digits where it lies within 2 % of the limit.
std::string value_words(Rule rule, double value, double limit);

// A limit that a drive on given soils breaks.
struct BrokenLimit {
  Rule rule = Rule::kSlipCheck;
  double value = 0.0, limit = 0.0;  // in SI
  double distance_m = 0.0;          // along the drive
  int wheel = -1;                   // whose value it is
};
// "slip 0.52 at 31.2 m, limit 0.4".
std::string describe(const BrokenLimit& broken);

// The rules that have a limit and are measured at each station.
class StationRules {
 public:
  StationRules(const RoverModel& rover, const DriveLimits& limits);

  struct Active {
    const RuleRow* row = nullptr;
    double limit = 0.0;
  };
  const std::vector<Active>& active() const { return active_; }
  Measured measure(const Active& rule, const Stance& stance, const StationState& state) const {
    return rule.row->at(rover_, stance, state);
  }
  // Whether the motion at a station breaks a limit, its slip among them; a turn in place has no slip on the
  // way. `of_soil_alone` leaves out what hangs on the ground's shape, but for the tilt that the soil leans.
  bool broken_by(const Stance& stance, const DriveCommand& command, const StationState& state,
                 bool of_soil_alone = false) const;
  double max_slip_ratio() const { return max_slip_ratio_; }

 private:
  const RoverModel& rover_;
  double max_slip_ratio_;
  std::vector<Active> active_;
};

// A maximum and the distance along the drive at which it occurs.
struct Peak {
  double value = 0.0;
  double distance_m = 0.0;

  // By more than this share of the value.
  void raise(double other, double other_distance_m, double share = 0.0) {
    if (other > value * (1.0 + share)) *this = {other, other_distance_m};
  }
};

// The extremes of a drive in motion for which there are limits.
struct DriveExtremes {
  Peak max_slip_ratio, max_tilt_rad, max_current_a, max_sinkage_m;
};
std::vector<BrokenLimit> broken_limits(const DriveExtremes& extremes, const DriveLimits& limits);

// The maximum current and sinkage over the wheels of a state.
Measured largest_current(const StationState& state);
Measured deepest_sinkage(const StationState& state);
inline double largest_current_a(const StationState& state) {
  return largest_current(state).value;
}
inline double deepest_sinkage_m(const StationState& state) {
  return deepest_sinkage(state).value;
}

}  // namespace slipway::sim
