// Slip is predicted as it is measured: 1 less the speed over the commanded one, uphill and downhill. A
// wheel's law has another slip where it skids (sim/wheel/slip_ratio.h), which is smaller by a tenth at 15 deg
// downhill.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "core/angle.h"
#include "gap/diagnosis/model/hypothesis.h"
#include "sim/quasi_static/quasi_static.h"
#include "tests/sim/reference_models.h"

namespace slipway::gap {
namespace {

constexpr double kGravity_m_s2 = 3.71;

// A plane that rises eastward.
class Plane : public sim::Ground {
 public:
  explicit Plane(double slope_rad) : slope_(slope_rad) {}
  std::optional<sim::GroundPoint> at(double x_m, double /*y_m*/) const override {
    return sim::GroundPoint{std::tan(slope_) * x_m, {-std::sin(slope_), 0.0, std::cos(slope_)}};
  }
  std::optional<std::size_t> soil_at(double /*x_m*/, double /*y_m*/) const override { return 0; }

 private:
  double slope_;
};

// Eastward on the plane, as the balance has the rover move there, or turning in place.
DriveCampaign drive_on(double slope_rad, const sim::DriveCommand& command) {
  const sim::RoverModel rover = sim::six_wheeler();
  sim::QuasiStaticSolver solver(rover, kGravity_m_s2);
  const Attitude attitude{0.0, -slope_rad, 0.0};
  const sim::StationState state =
      solver.solve(sim::stance_on_plane(rover, attitude), sim::sandy_loam(), command);
  EXPECT_TRUE(state.moving());
  DriveCampaign campaign;
  campaign.gravity_m_s2 = kGravity_m_s2;
  campaign.rover = std::make_shared<sim::RoverModel>(rover);
  campaign.measurement_std = {0.003, 0.003, 0.02, 0.003, 0.001};
  campaign.soils.push_back({"soil", sim::sandy_loam()});
  campaign.terrains.push_back({"plane", std::make_shared<Plane>(slope_rad), ""});
  MeasuredDriveSeries drive;
  drive.id = "drive";
  drive.command = command;
  drive.duration_s = 40.0;
  for (int i = 0; i <= 40; ++i) {
    DriveSample sample;
    sample.time_s = i;
    const double way_m = command.turn_in_place ? 0.0 : state.along_m_s * i;
    sample.p_MB = {std::cos(slope_rad) * way_m, 0.0, std::sin(slope_rad) * way_m};
    sample.attitude = attitude;
    if (command.turn_in_place) sample.attitude.yaw_rad = state.yaw_rate_rad_s * i;
    sample.wheels = sim::PerWheel<WheelReading>(rover.wheels.size());
    drive.samples.push_back(sample);
  }
  campaign.drives.push_back(drive);
  return campaign;
}

// The largest difference between measured and predicted slips, and the largest measured one.
std::pair<double, double> of_slip(const DriveCampaign& campaign) {
  const std::vector<DriveWindow> windows = cut_windows(campaign);
  const WindowModel model(campaign, windows);
  const std::vector<double> predicted =
      Hypothesis(campaign, {}).predict(model, Hypothesis(campaign, {}).neutral());
  double difference = 0.0, largest = 0.0;
  for (std::size_t w = 0; w < windows.size(); ++w)
    for (std::size_t i = 0; i < windows[w].observations.size(); ++i) {
      const Observation& seen = windows[w].observations[i];
      if (seen.channel != Channel::kSlip) continue;
      difference = std::max(difference, std::abs(seen.value - predicted[model.offset(w) + i]));
      largest = std::max(largest, std::abs(seen.value));
    }
  return {difference, largest};
}

TEST(SlipChannel, IsPredictedAsItIsMeasuredUphillAndDownhillForwardAndBackward) {
  for (const double slope_deg : {-15.0, -5.0, 0.0, 10.0})
    for (const double speed_m_s : {0.05, -0.05}) {
      sim::DriveCommand command;
      command.speed_m_s = speed_m_s;
      const auto [difference, largest] = of_slip(drive_on(rad_from_deg(slope_deg), command));
      EXPECT_GT(largest, std::abs(slope_deg) > 5.0 ? 0.03 : 0.0) << slope_deg << " deg";
      EXPECT_LT(difference, 0.002) << slope_deg << " deg at " << speed_m_s << " m/s, slip " << largest;
    }
}

TEST(SlipChannel, IsPredictedAsItIsMeasuredInATurnInPlace) {
  sim::DriveCommand command;
  command.turn_in_place = true;
  command.turn_rate_rad_s = 0.05;
  const auto [difference, largest] = of_slip(drive_on(0.0, command));
  EXPECT_GT(largest, 0.01);
  EXPECT_LT(difference, 0.002);
}

}  // namespace
}  // namespace slipway::gap
