#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/pose.h"
#include "gap/diagnosis/model/channel.h"
#include "gap/diagnosis/model/drive_campaign.h"
#include "gap/diagnosis/model/drive_window.h"

namespace slipway::gap {

// Readings of one quantity over a window.
struct Readings {
  std::vector<double> time_s, value;

  std::size_t count() const { return value.size(); }
  double mean() const;
  // Without what lies far from its neighbours' median, for readings of one standard deviation. They may
  // change at a constant rate: neighbours are moved along the median of what it is from one reading to the
  // next.
  Readings kept(double std, const WindowOptions& options) const;
};

// What the rows of a window say: what channels are read from.
class WindowReadings {
 public:
  // Rows [from, to] of the drive. All arguments must outlive it.
  WindowReadings(const DriveCampaign& campaign, const MeasuredDriveSeries& drive, std::size_t from,
                 std::size_t to, const WindowOptions& options);

  // By the measured poses; nothing where there are fewer than two. Roll and pitch are means, and not there in
  // drives of which only the final pose was recorded.
  struct Motion {
    std::optional<Measured> slip, side_slip, yaw_rate, roll, pitch;
    std::vector<Pose2> stations;  // evenly spaced over the window's time
    double first_yaw_rad = 0.0;   // of the line through the headings, at the window's start
    bool censored = false;        // slip above kCensoredSlip
  };
  const Motion& motion() const { return motion_; }

  // Readings of a wheel, times `sense`; none in drives of which only the final pose was recorded.
  Readings of_wheel(std::size_t wheel, double WheelReading::*quantity, double sense = 1.0) const;
  // -1 where the wheel is commanded backwards and its current is recorded by the format's sign: with it, the
  // current is positive in the sense of the rate.
  double sense_of_current(std::size_t wheel) const;
  // Of the motors, over all wheels that have one; nothing where none was measured.
  std::optional<double> motor_temp_c() const;

  const MeasurementStd& measurement_std() const { return campaign_.measurement_std; }
  const WindowOptions& options() const { return options_; }
  const DriveCampaign& campaign() const { return campaign_; }
  const MeasuredDriveSeries& drive() const { return drive_; }

 private:
  void read_poses();
  void read_motion(const Readings& x, const Readings& y, const Readings& yaw, double roll_rad,
                   double pitch_rad);

  const DriveCampaign& campaign_;
  const MeasuredDriveSeries& drive_;
  std::size_t from_, to_;
  const WindowOptions& options_;
  sim::PerWheel<sim::WheelCommand> commanded_;
  Motion motion_;
};

}  // namespace slipway::gap
