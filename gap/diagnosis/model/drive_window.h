#pragma once

#include <cstddef>
#include <vector>

#include "core/pose.h"
#include "gap/diagnosis/model/channel.h"
#include "gap/diagnosis/model/drive_campaign.h"
#include "sim/rover/drive_command.h"

namespace slipway::gap {

// A stretch of a drive, anchored at its own measured poses so that the error of one does not travel to the
// next.
struct DriveWindow {
  std::size_t drive = 0;  // index into DriveCampaign::drives
  double start_s = 0.0, end_s = 0.0;
  std::vector<Pose2> stations;  // measured, smoothed, evenly spaced over the window's time
  // The heading at the start of the drive's first window, plus or minus whole turns so that stations'
  // headings less this are what they have turned since.
  double first_yaw_rad = 0.0;
  sim::DriveCommand command;  // with the motors' mean temperature where it was measured
  double distance_m = 0.0;    // commanded
  std::vector<Observation> observations;
  // Slip above kCensoredSlip: only that it was so great is said, by a wide error.
  bool censored = false;

  double mid_s() const { return 0.5 * (start_s + end_s); }
  const Pose2& middle() const { return stations[stations.size() / 2]; }
};
constexpr double kCensoredSlip = 0.9;

struct WindowOptions {
  double length_m = 1.5;  // commanded; more where rows are so far apart that it would not hold three
  double turn_rad = 0.8;  // of a turn in place
  int stations = 3;
  double outlier = 6.0;  // sensor's deviations off the neighbours' median: such a reading is passed over
  int outlier_neighbours = 2;              // on either side
  double pause_share = 0.75;               // of a window: none reaches across a longer pause in the rows
  bool currents_in_sense_of_rate = false;  // this and the next: found in the campaign's own readings
  bool currents_split_evenly = false;
};
bool currents_in_sense_of_rate(const DriveCampaign& campaign);
// In every row all wheels have one current: what was recorded is the total. It is compared as a mean, since
// the wheels of a rover on a slope do not share alike.
bool currents_split_evenly(const DriveCampaign& campaign);

// Windows of every drive, in the drives' order. A drive shorter than a window is one. None reaches across a
// pause in the rows that is nearly as long as itself. Where rates were measured, rows before the wheels first
// turn at half of the commanded rates, and after they last do, are left out. Angles that lie beyond `outlier`
// deviations of their neighbours' median, and currents beyond twice as many, are passed over; windows with
// fewer than two poses have no slip, side slip and yaw rate. Drives that are final_only are one window
// without currents.
std::vector<DriveWindow> cut_windows(const DriveCampaign& campaign, const WindowOptions& options = {});

}  // namespace slipway::gap
