#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "gap/diagnosis/diagnosis.h"
#include "gap/diagnosis/model/drive_campaign.h"

namespace slipway::gap {

// The commands and conditions of a drive, in the quantities of NextDrive.
struct DriveKind {
  double tilt_deg = 0.0;
  double heading_deg = 0.0;  // of the rover's x axis from straight uphill, positive to the left
  double speed_m_s = 0.0;    // negative is backward; 0 for a turn in place
  double curvature_1_m = 0.0;
  std::optional<double> motor_temp_c = {};  // mean over wheels and rows; empty where it was not recorded
  bool turn_in_place = false;
};

// The kind of a recorded drive. Tilt and heading are those of the map's mean gradient along and across the
// rover at the measured poses; on hills they are averages over the drive.
DriveKind kind_of(const DriveCampaign& campaign, std::size_t drive);
DriveKind kind_of(const NextDrive& drive);

// A distance between kinds of drives.
class DriveDistance {
 public:
  // Each quantity is in units of its spread (standard deviation) over the possible drives. Gradients are
  // taken along and across the rover, with one spread, so that headings do not matter on level ground.
  explicit DriveDistance(std::span<const DriveKind> pool);
  // The distance in units of the spreads; the motor temperature is left out where one of them has none.
  double between(const DriveKind& a, const DriveKind& b) const;

 private:
  double tilt_deg_ = 1.0, speed_m_s_ = 1.0, sense_ = 1.0, curvature_1_m_ = 1.0, motor_temp_c_ = 1.0,
         turn_ = 1.0;
};

// The one of `among` (indices into `kinds`, not empty) that is nearest to the wanted kind; the first of
// equals.
std::size_t nearest_drive(const DriveDistance& distance, std::span<const DriveKind> kinds,
                          std::span<const std::size_t> among, const DriveKind& asked);

}  // namespace slipway::gap
