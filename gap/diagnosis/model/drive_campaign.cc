#include "gap/diagnosis/model/drive_campaign.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "core/angle.h"

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

bool same_reading(double a, double b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

// "D1, D2, D3, ..."
std::string first_of(std::span<const std::string> drives) {
  constexpr std::size_t kMaxNamed = 5;
  const std::size_t named = std::min(kMaxNamed, drives.size());
  return fmt::format("{}{}", fmt::join(drives.first(named), ", "), named < drives.size() ? ", ..." : "");
}

}  // namespace

void note_turned_against_command(DriveCampaign& campaign) {
  std::vector<std::string> against;
  for (const MeasuredDriveSeries& drive : campaign.drives)
    if (turned_as_commanded(campaign, drive) < 0.0) against.push_back(drive.id);
  if (against.empty()) return;
  campaign.notes.push_back(
      fmt::format("{} of {} drives ({}): the wheels turned against the commanded direction", against.size(),
                  campaign.drives.size(), first_of(against)));
}

bool same_rows(const MeasuredDriveSeries& a, const MeasuredDriveSeries& b) {
  const auto same = [](const DriveSample& one, const DriveSample& other) {
    bool equal = same_reading(one.time_s, other.time_s) && same_reading(one.p_MB.x(), other.p_MB.x()) &&
                 same_reading(one.p_MB.y(), other.p_MB.y()) &&
                 same_reading(one.attitude.yaw_rad, other.attitude.yaw_rad);
    for (std::size_t k = 0; equal && k < one.wheels.size(); ++k)
      equal = same_reading(one.wheels[k].current_a, other.wheels[k].current_a);
    return equal;
  };
  return std::any_of(a.samples.begin(), a.samples.end(),
                     [](const DriveSample& sample) { return sample.p_MB.allFinite(); }) &&
         std::equal(a.samples.begin(), a.samples.end(), b.samples.begin(), b.samples.end(), same);
}

void take_same_rows_as_repeats(DriveCampaign& campaign) {
  std::vector<std::string> repeats;
  for (std::size_t d = 1; d < campaign.drives.size(); ++d) {
    MeasuredDriveSeries& drive = campaign.drives[d];
    if (drive.repeat_of) continue;
    const auto earlier = std::span(campaign.drives).first(d);
    const auto same = std::find_if(earlier.begin(), earlier.end(), [&](const MeasuredDriveSeries& other) {
      return other.terrain == drive.terrain && same_rows(other, drive);
    });
    if (same == earlier.end()) continue;
    drive.repeat_of = same->repeat_of.value_or(same->id);
    repeats.push_back(drive.id);
  }
  if (repeats.empty()) return;
  campaign.notes.push_back(fmt::format(
      "{} of {} drives ({}) have the very rows of an earlier drive: they are taken for repeats of it; a "
      "recording that stands here under two names counts twice and should stand here once",
      repeats.size(), campaign.drives.size(), first_of(repeats)));
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

DriveCampaign drives_between(const DriveCampaign& campaign, std::size_t from, std::size_t to) {
  std::vector<std::size_t> drives(to - from);
  std::iota(drives.begin(), drives.end(), from);
  return subset_of(campaign, drives);
}

}  // namespace slipway::gap
