#include "sim/prediction/drive_outcome.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace slipway::sim {
namespace {

constexpr double kMaxSlip = 0.999;  // of 1 / (1 - slip)

// Mean distance of the wheels from the middle of a turn in place.
double turning_reach_m(const RoverModel& rover) {
  double sum = 0.0;
  for (const WheelModel& wheel : rover.wheels) sum += wheel.position_m.head<2>().norm();
  return sum / static_cast<double>(rover.wheels.size());
}

}  // namespace

DriveEnding DriveOutcome::ending(std::size_t first, std::size_t end) const {
  DriveEnding ending;
  for (std::size_t k = first; k < end; ++k) {
    const OutcomeEvent& event = events[k];
    if (ending.halt && event.station != ending.halt->station) break;
    if (!ending.halt) ending.halt = event;
    ending.immobilised |= event.rule == Rule::kImmobilised;
    ending.embedded |= event.rule == Rule::kEmbedding;
  }
  return ending;
}

OutcomeFollower::OutcomeFollower(const RoverModel& rover, const DriveLimits& limits, const SlipChecks& checks,
                                 double segment_m)
    : rover_(rover), limits_(limits), checks_(checks), station_rules_(rover, limits), segment_m_(segment_m) {}

double OutcomeFollower::turns_m() const {
  return checks_.embedding_turns * 2.0 * std::numbers::pi * rover_.smallest_wheel_radius_m();
}

void OutcomeFollower::note(Rule rule, double value, bool trips, int wheel) {
  RuleTrace& of = outcome_.rules[static_cast<std::size_t>(rule)];
  const bool nearer = row_of(rule).trips == Trips::kBelow ? value < of.value : value > of.value;
  if (nearer || !of.seen) {
    of.seen = true;
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
  note(Rule::kEmbedding, checks_.embedding_sinkage_share, true);
  outcome_.embedded = true;
  outcome_.events.push_back({Rule::kEmbedding, index_});
  return false;
}

// The next sol begins here, with a look at where the rover is.
void OutcomeFollower::halt(Rule rule) {
  ++outcome_.stops;
  outcome_.events.push_back({rule, index_});
  way_.assign(1, Way{});
  begin_ = 0;
  best_begin_ = {};
  aside_m_ = spun_m_ = turned_m_ = drive_s_ = energy_j_ = 0.0;
}

// A limit that is broken over a stretch halts the rover once, where the stretch begins.
void OutcomeFollower::watch(const RuleRow& row, double value, double limit, int wheel) {
  const bool over = row.tripped_by(value, limit);
  bool& was_over = over_[static_cast<std::size_t>(row.rule)];
  note(row.rule, value, over, wheel);
  if (over && !was_over) halt(row.rule);
  was_over = over;
}

void OutcomeFollower::begin(const PreparedStation& station, std::size_t index) {
  index_ = index;
  distance_m_ = station.distance_m;
  if (segment_m_ <= 0.0) return;
  const auto segment = static_cast<std::size_t>(distance_m_ / segment_m_);
  if (segment != segment_) drive_s_ = energy_j_ = 0.0;
  segment_ = segment;
}

// A rover that the ground holds comes some half a metre a sol: Opportunity took 38 sols over a few metres of
// ripple [Purgatory, sols 446 to 484]. False where it digs itself in.
bool OutcomeFollower::hold() {
  constexpr double kWayOfASol_m = 0.5;
  if (held_from_m_ && distance_m_ - *held_from_m_ < kWayOfASol_m) return true;
  held_from_m_ = distance_m_;
  note(Rule::kSlipCheck, 1.0, true);
  note(Rule::kImmobilised, 1.0, true);
  halt(Rule::kImmobilised);
  return way_to_halt_m() <= turns_m() || embed();
}

void OutcomeFollower::budget(const PreparedStation& station, const StationState& state) {
  const Effort effort = effort_of(station, state);
  drive_s_ += effort.duration_s;
  energy_j_ += effort.energy_j;
  if (std::isfinite(limits_.max_drive_s)) watch(row_of(Rule::kDriveTime), drive_s_, limits_.max_drive_s);
  if (std::isfinite(limits_.max_energy_j)) watch(row_of(Rule::kEnergy), energy_j_, limits_.max_energy_j);
}

// False where a wheel is too deep.
bool OutcomeFollower::sink(const StationState& state) {
  Measured share;
  for (std::size_t k = 0; k < state.wheels.size(); ++k)
    if (const double of_radius = state.wheels[k].sinkage_m / rover_.wheels[k].radius_m;
        of_radius > share.value)
      share = {of_radius, static_cast<int>(k)};
  note(Rule::kEmbedding, share.value, false, share.wheel);
  return share.value <= checks_.embedding_sinkage_share;
}

// What slips of a turn in place digs. False where it digs the wheels in.
bool OutcomeFollower::turn(const PreparedStation& station, const StationState& state) {
  const double slip = std::clamp(state.slip_ratio, 0.0, kMaxSlip);
  turned_m_ += station.turn_rad * turning_reach_m(rover_) * slip / (1.0 - slip);
  return turned_m_ <= turns_m();
}

// False where the wheels dig themselves in.
bool OutcomeFollower::roll(const PreparedStation& station, const StationState& state) {
  const double rolled_m = station.drive_m / (1.0 - std::clamp(state.slip_ratio, 0.0, kMaxSlip));
  way_.push_back({way_.back().rolled_m + rolled_m, way_.back().come_m + station.drive_m,
                  way_.back().aside_m + station.drive_m * std::tan(state.side_slip_rad)});
  if (way_.back().come_m - way_.front().come_m > rover_.smallest_wheel_radius_m()) turned_m_ = 0.0;
  spun_m_ = state.slip_ratio > checks_.embedding_slip_ratio ? spun_m_ + rolled_m : 0.0;
  const bool checked = state.slip_ratio >= limits_.max_slip_ratio;
  return (checked ? std::min(spun_m_, way_to_halt_m()) : spun_m_) <= turns_m();
}

// The slip and the way aside over what was rolled since the last look. With come - (1 - limit) rolled along
// the way, the slip between two places is at or over the limit where it does not grow: it is enough to know
// its greatest value of those places that lie a stretch or more behind.
void OutcomeFollower::look_back() {
  const double driven = 1.0 - limits_.max_slip_ratio;
  const auto height = [&](const Way& at) { return at.come_m - driven * at.rolled_m; };
  const Way now = way_.back();  // a halt begins the way anew
  const double stretch_m = checks_.slip_check_every_m, from_m = now.rolled_m - stretch_m;
  Way begin;
  if (from_m >= 0.0) {
    for (; begin_ + 1 < way_.size() && way_[begin_ + 1].rolled_m <= from_m; ++begin_)
      if (height(way_[begin_ + 1]) > height(best_begin_)) best_begin_ = way_[begin_ + 1];
    const Way &before = way_[begin_], &after = way_[begin_ + 1];
    const double share = (from_m - before.rolled_m) / (after.rolled_m - before.rolled_m);
    begin = {from_m, std::lerp(before.come_m, after.come_m, share),
             std::lerp(before.aside_m, after.aside_m, share)};
    if (slips_since(begin, now)) return halt(Rule::kSlipCheck);
    const double slid = std::atan2(std::abs(now.aside_m - begin.aside_m), now.come_m - begin.come_m);
    watch(row_of(Rule::kSideSlip), slid, limits_.max_side_slip_rad);
  }
  // A halt for the side slip was a look: the way aside begins anew.
  aside_m_ = way_.size() > 1 ? now.aside_m - begin.aside_m : 0.0;
  watch(row_of(Rule::kAside), std::abs(aside_m_), limits_.max_aside_m);
}

// Whether the slip since either place, a stretch or more behind, is at or over the limit.
bool OutcomeFollower::slips_since(const Way& begin, const Way& now) {
  const auto slip_from = [&](const Way& at) {
    return 1.0 - (now.come_m - at.come_m) / (now.rolled_m - at.rolled_m);
  };
  const double slip = std::max(slip_from(begin), slip_from(best_begin_));
  constexpr double kRounding = 1e-9;
  const bool over = slip >= limits_.max_slip_ratio - kRounding;
  note(Rule::kSlipCheck, slip, over);
  return over;
}

void OutcomeFollower::without_stance(const PreparedStation& station, std::size_t index) {
  begin(station, index);
  note(Rule::kStance, 1.0, true);
  halt(Rule::kStance);
}

bool OutcomeFollower::add(const PreparedStation& station, std::size_t index, const StationState& state) {
  begin(station, index);
  const bool moves = state.moving();
  if (moves && !sink(state)) return embed();
  for (const StationRules::Active& rule : station_rules_.active()) {
    if (!moves && !rule.row->of_shape) continue;
    const Measured measured = station_rules_.measure(rule, station.stance, state);
    watch(*rule.row, measured.value, rule.limit, measured.wheel);
  }
  if (!moves) return hold();
  budget(station, state);
  if (station.command.turn_in_place) return turn(station, state) || embed();
  if (station.drive_m <= 0.0) return true;
  if (!roll(station, state)) return embed();
  look_back();
  return true;
}

}  // namespace slipway::sim
