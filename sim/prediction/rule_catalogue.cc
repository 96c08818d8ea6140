#include "sim/prediction/rule_catalogue.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/number_words.h"

namespace slipway::sim {
namespace {

constexpr double kDegrees = deg_from_rad(1.0), kHours = 1.0 / 3600.0, kWattHours = 1.0 / 3600.0;

Measured tilt(const RoverModel&, const Stance&, const StationState& state) {
  return {state.attitude.tilt_rad()};
}

Measured pitch(const RoverModel&, const Stance&, const StationState& state) {
  return {std::abs(state.attitude.pitch_rad)};
}

Measured roll(const RoverModel&, const Stance&, const StationState& state) {
  return {std::abs(state.attitude.roll_rad)};
}

Measured suspension(const RoverModel&, const Stance& stance, const StationState&) {
  return {
      std::max({std::abs(stance.rocker_rad), std::abs(stance.bogie_rad[0]), std::abs(stance.bogie_rad[1])})};
}

Measured clearance(const RoverModel&, const Stance& stance, const StationState&) {
  return {stance.belly_clearance_m};
}

Measured current(const RoverModel&, const Stance&, const StationState& state) {
  return largest_current(state);
}

Measured sinkage(const RoverModel&, const Stance&, const StationState& state) {
  return deepest_sinkage(state);
}

constexpr std::array<RuleRow, kRules> kCatalogue{{
    {.rule = Rule::kSlipCheck,
     .name = "slip_check",
     .quantity = "slip",
     .words = "slip over a stretch between checks",
     .unit = "1",
     .trips = Trips::kAtOrAbove,
     .limit = &DriveLimits::max_slip_ratio,
     .key = "max_slip",
     .most = 1.0,
     .help = "slip over a stretch between checks, 0 to 1"},
    {.rule = Rule::kTilt,
     .name = "tilt",
     .quantity = "tilt",
     .words = "tilt",
     .unit = "deg",
     .factor = kDegrees,
     .limit = &DriveLimits::max_tilt_rad,
     .key = "max_tilt_deg",
     .most = 60.0,
     .help = "tilt of the body, deg",
     .of_shape = true,
     .at = tilt},
    {.rule = Rule::kPitch,
     .name = "pitch",
     .quantity = "pitch",
     .words = "pitch, up or down",
     .unit = "deg",
     .factor = kDegrees,
     .limit = &DriveLimits::max_pitch_rad,
     .key = "max_pitch_deg",
     .most = 60.0,
     .help = "pitch of the body, up or down, deg",
     .of_shape = true,
     .at = pitch},
    {.rule = Rule::kRoll,
     .name = "roll",
     .quantity = "roll",
     .words = "roll, left or right",
     .unit = "deg",
     .factor = kDegrees,
     .limit = &DriveLimits::max_roll_rad,
     .key = "max_roll_deg",
     .most = 60.0,
     .help = "roll of the body, left or right, deg",
     .of_shape = true,
     .at = roll},
    {.rule = Rule::kSuspension,
     .name = "suspension",
     .quantity = "suspension angle",
     .words = "angle of a rocker or bogie",
     .unit = "deg",
     .factor = kDegrees,
     .limit = &DriveLimits::max_suspension_rad,
     .key = "max_suspension_deg",
     .most = 60.0,
     .help = "angle of any rocker or bogie, deg",
     .cause = "rough_ground",
     .of_shape = true,
     .at = suspension},
    {.rule = Rule::kCurrent,
     .name = "current",
     .quantity = "current",
     .words = "current of a drive motor",
     .unit = "A",
     .limit = &DriveLimits::max_current_a,
     .key = "max_current_a",
     .most = 100.0,
     .help = "current of any drive motor, A",
     .at = current},
    {.rule = Rule::kSinkage,
     .name = "sinkage",
     .quantity = "sinkage",
     .words = "sinkage of a wheel",
     .unit = "m",
     .limit = &DriveLimits::max_sinkage_m,
     .key = "max_sinkage_m",
     .most = 1.0,
     .help = "sinkage of any wheel, m",
     .cause = "load",
     .at = sinkage},
    {.rule = Rule::kClearance,
     .name = "clearance",
     .quantity = "clearance",
     .words = "clearance of the belly",
     .unit = "m",
     .trips = Trips::kBelow,
     .limit = &DriveLimits::min_clearance_m,
     .key = "min_clearance_m",
     .most = 2.0,
     .least_allowed = true,
     .help = "clearance of the belly over the ground, m",
     .cause = "rough_ground",
     .of_shape = true,
     .at = clearance},
    {.rule = Rule::kSideSlip,
     .name = "side_slip",
     .quantity = "side slip",
     .words = "side slip over a stretch between checks",
     .unit = "deg",
     .factor = kDegrees,
     .limit = &DriveLimits::max_side_slip_rad,
     .key = "max_side_slip_deg",
     .most = 90.0,
     .help = "angle between where the rover goes and where it should, over a stretch between checks, deg"},
    {.rule = Rule::kAside,
     .name = "aside",
     .quantity = "way aside",
     .words = "way to the side between checks",
     .unit = "m",
     .limit = &DriveLimits::max_aside_m,
     .key = "max_aside_m",
     .most = 100.0,
     .help = "way to the side between two checks, m"},
    {.rule = Rule::kDriveTime,
     .name = "drive_time",
     .quantity = "drive time",
     .words = "time of a sol's drive",
     .unit = "h",
     .factor = kHours,
     .limit = &DriveLimits::max_drive_s,
     .key = "max_drive_h",
     .most = 1000.0,
     .help = "driving time of a sol, h"},
    {.rule = Rule::kEnergy,
     .name = "energy",
     .quantity = "energy",
     .words = "energy of a sol's drive",
     .unit = "Wh",
     .factor = kWattHours,
     .limit = &DriveLimits::max_energy_j,
     .key = "max_energy_wh",
     .most = 1e6,
     .help = "energy of the drive motors in a sol, Wh"},
    {.rule = Rule::kStance,
     .name = "stance",
     .quantity = "stance",
     .words = "wheels that find no ground to stand on",
     .unit = "1",
     .cause = "rough_ground"},
    {.rule = Rule::kImmobilised,
     .name = "immobilised",
     .quantity = "slip",
     .words = "the ground holds the rover",
     .unit = "1",
     .trips = Trips::kAtOrAbove},
    {.rule = Rule::kEmbedding,
     .name = "embedding",
     .quantity = "sinkage over the radius",
     .words = "wheels dig in: sinkage over the radius",
     .unit = "1"},
}};

std::string in_four_digits(double value) {
  return std::abs(value) < 1000.0 ? fmt::format("{:.4g}", value) : plain_number(value);
}

std::string number_words(double value, double limit) {
  const bool near = std::isfinite(limit) && std::abs(value - limit) < 0.02 * std::abs(limit);
  return near ? in_four_digits(value) : plain_number(value);
}

std::string unit_words(const RuleRow& row) {
  return row.unit == "1" ? std::string() : fmt::format(" {}", row.unit);
}

}  // namespace

bool RuleRow::tripped_by(double value, double limit_value) const {
  switch (trips) {
    case Trips::kAtOrAbove:
      return value >= limit_value;
    case Trips::kAbove:
      return value > limit_value;
    case Trips::kBelow:
      break;
  }
  return value < limit_value;
}

std::span<const RuleRow> rule_catalogue() {
  return kCatalogue;
}

const RuleRow& row_of(Rule rule) {
  return kCatalogue[static_cast<std::size_t>(rule)];
}

std::string_view describe(Rule rule) {
  return row_of(rule).name;
}

double limit_of(Rule rule, const DriveLimits& limits, const SlipChecks& checks) {
  if (const auto member = row_of(rule).limit) return limits.*member;
  return rule == Rule::kEmbedding ? checks.embedding_sinkage_share : 1.0;
}

std::string value_words(Rule rule, double value, double limit) {
  const RuleRow& row = row_of(rule);
  return number_words(value * row.factor, limit * row.factor) + unit_words(row);
}

std::string describe(const BrokenLimit& broken) {
  const RuleRow& row = row_of(broken.rule);
  return fmt::format("{} {} at {:.1f} m, limit {}{}", row.quantity,
                     value_words(broken.rule, broken.value, broken.limit), broken.distance_m,
                     in_four_digits(broken.limit * row.factor), unit_words(row));
}

StationRules::StationRules(const RoverModel& rover, const DriveLimits& limits)
    : rover_(rover), max_slip_ratio_(limits.max_slip_ratio) {
  for (const RuleRow& row : kCatalogue)
    if (row.at && row.limit && std::isfinite(limits.*row.limit)) active_.push_back({&row, limits.*row.limit});
}

bool StationRules::broken_by(const Stance& stance, const DriveCommand& command, const StationState& state,
                             bool of_soil_alone) const {
  if (!command.turn_in_place && std::abs(state.slip_ratio) >= max_slip_ratio_) return true;
  return std::any_of(active_.begin(), active_.end(), [&](const Active& rule) {
    if (of_soil_alone && rule.row->of_shape && rule.row->rule != Rule::kTilt) return false;
    return rule.row->tripped_by(measure(rule, stance, state).value, rule.limit);
  });
}

std::vector<BrokenLimit> broken_limits(const DriveExtremes& extremes, const DriveLimits& limits) {
  std::vector<BrokenLimit> broken;
  for (const auto& [rule, peak] : {std::pair{Rule::kSlipCheck, &extremes.max_slip_ratio},
                                   {Rule::kTilt, &extremes.max_tilt_rad},
                                   {Rule::kCurrent, &extremes.max_current_a},
                                   {Rule::kSinkage, &extremes.max_sinkage_m}}) {
    const double limit = limits.*row_of(rule).limit;
    if (row_of(rule).tripped_by(peak->value, limit))
      broken.push_back({rule, peak->value, limit, peak->distance_m});
  }
  return broken;
}

Measured largest_current(const StationState& state) {
  Measured largest;
  for (std::size_t k = 0; k < state.wheels.size(); ++k)
    if (const double amps = std::abs(state.wheels[k].current_a); amps > largest.value)
      largest = {amps, static_cast<int>(k)};
  return largest;
}

Measured deepest_sinkage(const StationState& state) {
  Measured deepest;
  for (std::size_t k = 0; k < state.wheels.size(); ++k)
    if (state.wheels[k].sinkage_m > deepest.value) deepest = {state.wheels[k].sinkage_m, static_cast<int>(k)};
  return deepest;
}

}  // namespace slipway::sim
