#include "sim/prediction/drive_outcome.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace slipway::sim {

OutcomeFollower::OutcomeFollower(const RoverModel& rover, const DriveLimits& limits, const SlipChecks& checks)
    : rover_(rover), limits_(limits), checks_(checks) {}

void OutcomeFollower::note(Rule rule, double value, bool trips, int wheel) {
  RuleTrace& of = trace(rule);
  const bool nearer = rule == Rule::kClearance ? !clearance_seen_ || value < of.value : value > of.value;
  if (rule == Rule::kClearance) clearance_seen_ = true;
  if (nearer) {
    of.value = value;
    of.station = index_;
    of.wheel = wheel;
  }
  if (!trips) return;
  if (!of.tripped) of.first_m = distance_m_;
  of.last_m = distance_m_;
  of.tripped = true;
}

bool OutcomeFollower::embed() {
  note(Rule::kEmbedding, 1.0, true);
  outcome_.embedded = true;
  outcome_.events.push_back({Rule::kEmbedding, index_});
  return false;
}

void OutcomeFollower::halt(Rule rule) {
  ++outcome_.stops;
  outcome_.events.push_back({rule, index_});
}

// The wheels roll on without way to speak of. False where they dig themselves in before the next check.
bool OutcomeFollower::spin(double rolled_m) {
  spun_m_ += rolled_m;
  const double turn_m = 2.0 * std::numbers::pi * rover_.smallest_wheel_radius_m();
  return spun_m_ <= checks_.embedding_turns * turn_m;
}

// True where the rover halts.
bool OutcomeFollower::check_slip() {
  const double slip = rolled_m_ > 0.0 ? 1.0 - come_m_ / rolled_m_ : 0.0;
  const bool over = slip > limits_.max_slip_ratio;
  note(Rule::kSlipCheck, slip, over);
  rolled_m_ = come_m_ = spun_m_ = 0.0;
  if (over) halt(Rule::kSlipCheck);
  return over;
}

// A limit that holds over a stretch halts the rover once, where the stretch begins.
void OutcomeFollower::watch(Rule rule, double value, double limit, int wheel) {
  const bool over = value > limit;
  bool& was_over = over_[static_cast<std::size_t>(rule)];
  note(rule, value, over, wheel);
  if (over && !was_over) {
    halt(rule);
    rolled_m_ = come_m_ = spun_m_ = 0.0;
  }
  was_over = over;
}

// False where a wheel is too deep.
bool OutcomeFollower::watch_wheels(const StationState& state) {
  int hottest = -1, deepest = -1;
  double current = 0.0, sinkage = 0.0, share = 0.0;
  for (std::size_t k = 0; k < state.wheels.size(); ++k) {
    const WheelState& wheel = state.wheels[k];
    if (std::abs(wheel.current_a) > current) {
      current = std::abs(wheel.current_a);
      hottest = static_cast<int>(k);
    }
    if (wheel.sinkage_m > sinkage) {
      sinkage = wheel.sinkage_m;
      deepest = static_cast<int>(k);
    }
    share = std::max(share, wheel.sinkage_m / rover_.wheels[k].radius_m);
  }
  note(Rule::kSinkage, sinkage, sinkage > limits_.max_sinkage_m, deepest);
  note(Rule::kEmbedding, std::min(share / checks_.embedding_sinkage_share, 1.0), false, deepest);
  if (share > checks_.embedding_sinkage_share) return false;
  watch(Rule::kCurrent, current, limits_.max_current_a, hottest);
  return true;
}

// The rest of the way to the next check is rolled on the spot, and all of that to the one after it where
// little was left, so that the check lets it pass. False where the rover digs itself in before it halts.
bool OutcomeFollower::spin_on_the_spot() {
  const double rest = std::max(0.0, checks_.slip_check_every_m - rolled_m_);
  if (!spin(rest)) return false;
  rolled_m_ += rest;
  if (check_slip()) return true;
  if (!spin(checks_.slip_check_every_m)) return false;
  rolled_m_ = checks_.slip_check_every_m;
  check_slip();
  return true;
}

bool OutcomeFollower::add(const PreparedStation& station, std::size_t index, const StationState& state) {
  index_ = index;
  distance_m_ = station.distance_m;
  note(Rule::kClearance, station.stance.belly_clearance_m,
       station.stance.belly_clearance_m < limits_.min_clearance_m);
  watch(Rule::kTilt, state.attitude.tilt_rad(), limits_.max_tilt_rad);
  if (!state.moving()) {
    // A rover that the ground holds comes some half a metre a sol: Opportunity took 38 sols over a few metres
    // of ripple [Purgatory, sols 446 to 484].
    constexpr double kWayOfASol_m = 0.5;
    const bool held_before = held_from_m_ && distance_m_ - *held_from_m_ < kWayOfASol_m;
    if (held_before) return true;
    held_from_m_ = distance_m_;
    return spin_on_the_spot() || embed();
  }
  if (!watch_wheels(state)) return embed();
  if (station.command.turn_in_place || station.drive_m <= 0.0) return true;
  const double rolled = station.drive_m / (1.0 - std::clamp(state.slip_ratio, 0.0, 0.999));
  come_m_ += station.drive_m;
  rolled_m_ += rolled;
  if (state.slip_ratio > checks_.embedding_slip_ratio && !spin(rolled)) return embed();
  if (rolled_m_ >= checks_.slip_check_every_m) check_slip();
  return true;
}

const DriveOutcome& OutcomeFollower::finish() {
  if (!outcome_.embedded && rolled_m_ > 0.0) check_slip();
  return outcome_;
}

}  // namespace slipway::sim
