#include "gap/drive_campaign.h"

#include <fmt/format.h>

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

DriveCampaign subset_of(const DriveCampaign& campaign, std::span<const std::size_t> drives) {
  DriveCampaign subset;
  subset.name = campaign.name;
  subset.gravity_m_s2 = campaign.gravity_m_s2;
  subset.rover = campaign.rover;
  subset.soils = campaign.soils;
  subset.terrains = campaign.terrains;
  subset.measurement_std = campaign.measurement_std;
  subset.notes = campaign.notes;
  subset.fingerprint = campaign.fingerprint;
  subset.retuning = campaign.retuning;
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
