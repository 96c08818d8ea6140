#include "gap/possible_drives.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>

#include "core/angle.h"

namespace slipway::gap {
namespace {

constexpr std::array kTilts_deg{0.0, 5.0, 10.0, 15.0};
constexpr std::array kHeadings_deg{0.0, 90.0, 180.0, -90.0};  // from straight uphill, to the left
constexpr std::array kSpeedShares{1.0, 0.5, -1.0, -0.5};      // of cruise speed
constexpr std::array kArcs_1_m{0.3, -0.3};
constexpr double kMostTiltOfArcs_deg = 10.0;
constexpr std::array kTemperatures_c{20.0, -40.0};

// Uphill is along x; one soil.
class Plane final : public sim::Ground {
 public:
  explicit Plane(double tilt_rad)
      : rise_(std::tan(tilt_rad)), normal_(-std::sin(tilt_rad), 0.0, std::cos(tilt_rad)) {}
  std::optional<sim::GroundPoint> at(double x_m, double /*y_m*/) const override {
    return sim::GroundPoint{rise_ * x_m, normal_};
  }
  std::optional<std::size_t> soil_at(double /*x_m*/, double /*y_m*/) const override { return 0; }

 private:
  double rise_;
  Eigen::Vector3d normal_;
};

// No model tells drives that nobody has made nearer than this, whatever those that were made scatter by: of
// currents a share of what is usual, since downhill there is hardly any.
constexpr double kCurrentShare = 0.05;
double least_error(Channel channel, double usual) {
  switch (channel) {
    case Channel::kSlip:
    case Channel::kSideSlip:
      return 0.01;
    case Channel::kYawRate:
      return 3e-4;
    case Channel::kCurrent:
      return kCurrentShare * usual;
    case Channel::kSinkage:
      return 0.001;
    default:
      return 0.0;
  }
}

double median_of(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// What windows of the campaign measure, each channel of each wheel once, with its usual size and sensor
// error.
std::vector<Observation> measured_channels(std::span<const DriveWindow> windows) {
  struct Told {
    std::vector<double> errors, sizes;
  };
  std::map<std::pair<Channel, int>, Told> told;
  for (const DriveWindow& window : windows)
    for (const Observation& o : window.observations) {
      if (o.channel == Channel::kRoll || o.channel == Channel::kPitch) continue;
      told[{o.channel, o.wheel}].errors.push_back(o.sensor_std);
      told[{o.channel, o.wheel}].sizes.push_back(std::abs(o.value));
    }
  std::vector<Observation> channels;
  for (auto& [key, of_windows] : told) {
    const double usual = median_of(of_windows.sizes);
    channels.push_back({key.first, key.second, usual,
                        std::hypot(median_of(of_windows.errors), least_error(key.first, usual))});
  }
  return channels;
}

std::vector<NextDrive> grid_of(const DriveCampaign& campaign, bool temperatures) {
  std::vector<NextDrive> drives;
  for (const double tilt : kTilts_deg)
    for (const double heading : kHeadings_deg)
      for (const double share : kSpeedShares)
        for (const double temperature : kTemperatures_c) {
          if (tilt == 0.0 && heading != 0.0) continue;
          if (!temperatures && temperature != kTemperatures_c[0]) continue;
          NextDrive drive{.tilt_deg = tilt,
                          .heading_deg = heading,
                          .speed_m_s = share * campaign.rover->cruise_speed_m_s,
                          .motor_temp_c = temperature};
          drives.push_back(drive);
          if (tilt > kMostTiltOfArcs_deg || share < 0.0 || temperature != kTemperatures_c[0]) continue;
          for (const double curvature : kArcs_1_m) {
            drive.curvature_1_m = curvature;
            drives.push_back(drive);
          }
        }
  return drives;
}

}  // namespace

PossibleDrives possible_drives(const DriveCampaign& campaign, std::span<const DriveWindow> made) {
  PossibleDrives possible;
  const bool temperatures = std::any_of(
      made.begin(), made.end(), [](const DriveWindow& w) { return w.command.motor_temp_c.has_value(); });
  possible.drives = grid_of(campaign, temperatures);
  DriveCampaign& c = possible.campaign;
  c.gravity_m_s2 = campaign.gravity_m_s2;
  c.rover = campaign.rover;
  c.soils = campaign.soils;
  c.measurement_std = campaign.measurement_std;
  c.retuning = campaign.retuning;
  for (const double tilt : kTilts_deg)
    c.terrains.push_back({"", std::make_shared<Plane>(rad_from_deg(tilt)), ""});
  const std::vector<Observation> channels = measured_channels(made);
  for (const NextDrive& asked : possible.drives) {
    MeasuredDriveSeries drive;
    drive.terrain = static_cast<std::size_t>(std::find(kTilts_deg.begin(), kTilts_deg.end(), asked.tilt_deg) -
                                             kTilts_deg.begin());
    drive.command.speed_m_s = asked.speed_m_s;
    drive.command.curvature_1_m = asked.curvature_1_m;
    if (temperatures) drive.command.motor_temp_c = asked.motor_temp_c;
    DriveWindow window;
    window.drive = c.drives.size();
    window.command = drive.command;
    window.stations = {{0.0, 0.0, rad_from_deg(asked.heading_deg)}};
    window.observations = channels;
    c.drives.push_back(std::move(drive));
    possible.windows.push_back(std::move(window));
  }
  return possible;
}

}  // namespace slipway::gap
