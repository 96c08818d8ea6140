#include "gap/diagnosis/model/drive_campaign.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "core/angle.h"
#include "gap/diagnosis/model/window_readings.h"

namespace slipway::gap {

void adopt_measured_rates(DriveCampaign& campaign) {
  constexpr double kMargin = 1.02;  // sensors' noise
  const double greatest = campaign.rover->drive.max_wheel_rate_rad_s;
  double fastest = 0.0;
  for (const MeasuredDriveSeries& drive : campaign.drives)
    for (const DriveSample& sample : drive.samples)
      for (const WheelReading& wheel : sample.wheels)
        if (std::isfinite(wheel.rate_rad_s)) fastest = std::max(fastest, std::abs(wheel.rate_rad_s));
  if (fastest <= kMargin * greatest) return;
  auto rover = std::make_shared<sim::RoverModel>(*campaign.rover);
  rover->drive.max_wheel_rate_rad_s = fastest;
  campaign.rover = std::move(rover);
  campaign.notes.push_back(
      fmt::format("wheels were measured at up to {:.1f} deg/s, above the rover's greatest rate of {:.1f} "
                  "deg/s: the former is taken",
                  deg_from_rad(fastest), deg_from_rad(greatest)));
}

namespace {

// Turned in all, in the sense that was commanded; below 0: against it.
double turned_as_commanded(const DriveCampaign& campaign, const MeasuredDriveSeries& drive) {
  const auto commanded = sim::wheel_commands(*campaign.rover, drive.command);
  double sum = 0.0;
  for (const DriveSample& sample : drive.samples)
    for (std::size_t k = 0; k < commanded.size(); ++k)
      if (std::isfinite(sample.wheels[k].rate_rad_s))
        sum += sample.wheels[k].rate_rad_s * commanded[k].rate_rad_s;
  return sum;
}

}  // namespace

void note_turned_against_command(DriveCampaign& campaign) {
  constexpr std::size_t kMaxNamed = 5;
  std::vector<std::string> against;
  for (const MeasuredDriveSeries& drive : campaign.drives)
    if (turned_as_commanded(campaign, drive) < 0.0) against.push_back(drive.id);
  if (against.empty()) return;
  const std::size_t count = against.size();
  if (count > kMaxNamed) against.resize(kMaxNamed);
  campaign.notes.push_back(
      fmt::format("{} of {} drives ({}{}): the wheels turned against the commanded direction", count,
                  campaign.drives.size(), fmt::join(against, ", "), count > kMaxNamed ? ", ..." : ""));
}

namespace {

// Of what was read of all wheels, of its size; nothing where nothing was.
std::optional<double> median_size(const DriveCampaign& campaign, double WheelReading::*quantity) {
  std::vector<double> sizes;
  for (const MeasuredDriveSeries& drive : campaign.drives)
    for (const DriveSample& sample : drive.samples)
      for (const WheelReading& wheel : sample.wheels)
        if (std::isfinite(wheel.*quantity)) sizes.push_back(std::abs(wheel.*quantity));
  if (sizes.empty()) return std::nullopt;
  return upper_median(std::move(sizes));
}

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

std::optional<double> median_way_share(const DriveCampaign& campaign) {
  std::vector<double> shares;
  for (const MeasuredDriveSeries& drive : campaign.drives)
    if (const auto share = way_share(drive)) shares.push_back(*share);
  if (shares.empty()) return std::nullopt;
  return upper_median(std::move(shares));
}

}  // namespace

void note_implausible_readings(DriveCampaign& campaign) {
  // Of the commanded way: slip may be near 1, never far below 0.
  constexpr double kShortWay = 0.02, kLongWay = 3.0;
  constexpr double kHotMotor_c = 100.0;
  const sim::RoverModel& rover = *campaign.rover;
  const auto note = [&](std::string what) {
    campaign.notes.push_back(what +
                             ": check units and clock, since nothing that follows is right if one is wrong");
  };
  if (const auto way = median_way_share(campaign); way && (*way < kShortWay || *way > kLongWay))
    note(fmt::format("half of the drives went {} than {:.3g} of the commanded way",
                     *way < 1.0 ? "less" : "more", *way));
  const double lifting_nm = rover.mass_kg * campaign.gravity_m_s2 * rover.wheels.front().radius_m;
  const double lifting_a =
      rover.drive.no_load_current_a + lifting_nm / (rover.drive.torque_constant_nm_per_a *
                                                    rover.drive.gear_ratio * rover.drive.gear_efficiency);
  if (const auto current = median_size(campaign, &WheelReading::current_a); current && *current > lifting_a)
    note(fmt::format(
        "half of the currents are beyond {:.3g} A, where {:.3g} A would lift the rover by one wheel",
        *current, lifting_a));
  if (const auto temp = median_size(campaign, &WheelReading::motor_temp_c); temp && *temp > kHotMotor_c)
    note(fmt::format("half of the motors' temperatures are beyond {:.3g} C", *temp));
  if (const auto sinkage = median_size(campaign, &WheelReading::sinkage_m);
      sinkage && *sinkage > rover.wheels.front().radius_m)
    note(fmt::format("half of the sinkages are deeper than {:.3g} m, more than a wheel's radius", *sinkage));
}

DriveCampaign subset_of(const DriveCampaign& campaign, std::span<const std::size_t> drives) {
  DriveCampaign subset;
  subset.name = campaign.name;
  subset.gravity_m_s2 = campaign.gravity_m_s2;
  subset.rover = campaign.rover;
  subset.soils = campaign.soils;
  subset.terrains = campaign.terrains;
  subset.measurement_std = campaign.measurement_std;
  subset.parameter_std = campaign.parameter_std;
  subset.notes = campaign.notes;
  subset.fingerprint = campaign.fingerprint;
  subset.retuning = campaign.retuning;
  subset.reference = campaign.reference;
  std::set<std::string> kept;
  for (const std::size_t d : drives) kept.insert(campaign.drives[d].id);
  std::map<std::string, std::string> instead_of;  // of an original that is left out: its first repeat
  for (const std::size_t d : drives) {
    MeasuredDriveSeries drive = campaign.drives[d];
    if (drive.repeat_of && !kept.contains(*drive.repeat_of)) {
      const auto [first, is_first] = instead_of.try_emplace(*drive.repeat_of, drive.id);
      if (is_first)
        drive.repeat_of.reset();
      else
        drive.repeat_of = first->second;
    }
    subset.drives.push_back(std::move(drive));
  }
  return subset;
}

}  // namespace slipway::gap
