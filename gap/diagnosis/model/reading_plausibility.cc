#include "gap/diagnosis/model/reading_plausibility.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/angle.h"
#include "core/quantile.h"
#include "gap/diagnosis/model/window_readings.h"
#include "sim/rover/motor.h"

namespace slipway::gap {
namespace {

// How far a drive led from its first pose, at most, over the commanded way; nothing of a turn in place.
std::optional<double> way_share(const MeasuredDriveSeries& drive) {
  const DriveSample *first = nullptr, *last = nullptr;
  double way_m = 0.0;
  for (const DriveSample& sample : drive.samples) {
    if (!sample.p_MB.head<2>().allFinite()) continue;
    if (first == nullptr) first = &sample;
    last = &sample;
    way_m = std::max(way_m, (sample.p_MB - first->p_MB).head<2>().norm());
  }
  if (first == last || drive.command.turn_in_place) return std::nullopt;
  const double commanded_m = std::abs(drive.command.speed_m_s) * (last->time_s - first->time_s);
  if (!(commanded_m > 0.0)) return std::nullopt;
  return way_m / commanded_m;
}

// Of what was read of all wheels, of its size; nothing where nothing was.
std::optional<double> median_size(const DriveCampaign& campaign, const ReadingLimit& limit) {
  std::vector<double> sizes;
  for (const MeasuredDriveSeries& drive : campaign.drives)
    for (const DriveSample& sample : drive.samples)
      for (std::size_t k = 0; k < sample.wheels.size(); ++k)
        if (const double value = limit.of(sample, k); std::isfinite(value)) sizes.push_back(std::abs(value));
  if (sizes.empty()) return std::nullopt;
  return median(std::move(sizes));
}

}  // namespace

double greatest_commanded_rate(const DriveCampaign& campaign, const MeasuredDriveSeries& drive) {
  double fastest = 0.0;
  for (const sim::WheelCommand& wheel : sim::wheel_commands(*campaign.rover, drive.command))
    fastest = std::max(fastest, std::abs(wheel.rate_rad_s));
  return fastest;
}

std::vector<ReadingLimit> reading_limits(const DriveCampaign& campaign) {
  constexpr double kLifts =
      10.0;  // times what lifts the rover by one wheel: no motor of its size survives it
  constexpr double kLikelyRates = 3.0, kPossibleRates = 20.0;  // over the greatest commanded rate
  constexpr double kSlowly_rad_s = 1e-6;                       // that a motor turns, not at which rate
  const sim::RoverModel& rover = *campaign.rover;
  const double radius_m = rover.wheels.front().radius_m;
  const double lifting_a =
      sim::motor_state(rover.drive, rover.mass_kg * campaign.gravity_m_s2 * radius_m, kSlowly_rad_s)
          .current_a;
  double rate_deg_s = 0.0;
  for (const MeasuredDriveSeries& drive : campaign.drives)
    rate_deg_s = std::max(rate_deg_s, deg_from_rad(greatest_commanded_rate(campaign, drive)));
  if (rate_deg_s == 0.0) rate_deg_s = std::numeric_limits<double>::infinity();  // nothing to compare with
  return {
      {"roll_deg", "roll angles", "deg", 45.0, 90.0, "no rover drives on steeper ground",
       "the rover would lie on its back",
       [](const DriveSample& s, std::size_t) { return deg_from_rad(s.attitude.roll_rad); }},
      {"pitch_deg", "pitch angles", "deg", 45.0, 90.0, "no rover drives on steeper ground",
       "the rover would lie on its back",
       [](const DriveSample& s, std::size_t) { return deg_from_rad(s.attitude.pitch_rad); }},
      {"_current_a", "currents", "A", lifting_a, kLifts * lifting_a, "this lifts the rover by one wheel",
       "this is ten times what lifts the rover by one wheel",
       [](const DriveSample& s, std::size_t k) { return s.wheels[k].current_a; }},
      {"_motor_temp_c", "motor temperatures", "C", 100.0, 200.0, "motors are kept below this",
       "windings burn above this",
       [](const DriveSample& s, std::size_t k) { return s.wheels[k].motor_temp_c; }},
      {"_sinkage_m", "sinkages", "m", radius_m, 2.0 * radius_m, "this is a wheel's radius",
       "the wheel would be buried",
       [](const DriveSample& s, std::size_t k) { return s.wheels[k].sinkage_m; }},
      {"_rate_deg_s", "wheel rates", "deg/s", kLikelyRates * rate_deg_s, kPossibleRates * rate_deg_s,
       "this is three times the greatest commanded rate", "this is twenty times the greatest commanded rate",
       [](const DriveSample& s, std::size_t k) { return deg_from_rad(s.wheels[k].rate_rad_s); }}};
}

std::optional<double> median_way_share(const DriveCampaign& campaign) {
  std::vector<double> shares;
  for (const MeasuredDriveSeries& drive : campaign.drives)
    if (const auto share = way_share(drive)) shares.push_back(*share);
  if (shares.empty()) return std::nullopt;
  return median(std::move(shares));
}

std::vector<std::string> notes_of_implausible_readings(const DriveCampaign& campaign) {
  std::vector<std::string> notes;
  const auto note = [&](std::string_view what) {
    notes.push_back(
        fmt::format("{}: check units and clock, since nothing that follows is right if one is wrong", what));
  };
  if (const auto way = median_way_share(campaign); way && (*way < kShortestWay || *way > kLongestWay))
    note(fmt::format("half of the drives went {} than {:.3g} of the commanded way",
                     *way < 1.0 ? "less" : "more", *way));
  for (const ReadingLimit& limit : reading_limits(campaign))
    if (const auto half = median_size(campaign, limit); half && *half > limit.likely)
      note(fmt::format("half of the {} are beyond {:.3g} {}, where {:.3g} {} is expected at most ({})",
                       limit.readings, *half, limit.unit, limit.likely, limit.unit, limit.likely_since));
  return notes;
}

}  // namespace slipway::gap
