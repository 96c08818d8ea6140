#include "gap/diagnosis/model/drive_campaign.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
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
