#include "gap/drive_campaign.h"

#include <fmt/format.h>

#include <cmath>

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

}  // namespace slipway::gap
