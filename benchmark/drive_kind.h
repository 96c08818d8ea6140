#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "gap/diagnosis/diagnosis.h"
#include "gap/diagnosis/model/drive_campaign.h"

namespace slipway::gap {

// What was asked of a drive, in the words of NextDrive.
struct DriveKind {
  double tilt_deg = 0.0;
  double heading_deg = 0.0;  // of the nose, from straight uphill, positive to the left; also of one backward
  double speed_m_s = 0.0;    // negative: backward; 0 of a turn in place
  double curvature_1_m = 0.0;
  std::optional<double> motor_temp_c = {};  // mean over wheels and rows; nothing: not recorded
  bool turn_in_place = false;
};

// Of a recorded drive: tilt and heading are those of the mean gradient of the map, along and across the nose,
// at the poses that were measured. On hills they are an average over what the drive met.
DriveKind kind_of(const DriveCampaign& campaign, std::size_t drive);
DriveKind kind_of(const NextDrive& drive);

// How far one kind of drive is from another.
class DriveDistance {
 public:
  // Each quantity counts by its spread (standard deviation) over the drives that could be made. Gradients
  // count along and across the nose, by one spread, so that headings do not matter on level ground.
  explicit DriveDistance(std::span<const DriveKind> pool);
  // In spreads; a motor temperature that one of them does not have is not compared.
  double between(const DriveKind& a, const DriveKind& b) const;

 private:
  double tilt_deg_ = 1.0, speed_m_s_ = 1.0, sense_ = 1.0, curvature_1_m_ = 1.0, motor_temp_c_ = 1.0,
         turn_ = 1.0;
};

// Which of `among` (indices into `kinds`, not empty) is nearest to what is asked for; the first of equals.
std::size_t nearest_drive(const DriveDistance& distance, std::span<const DriveKind> kinds,
                          std::span<const std::size_t> among, const DriveKind& asked);

}  // namespace slipway::gap
