// Whether a rover that ships gets up a slope: the balance and the rover in motion must give the same answer.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>

#include "api/files/catalogue.h"
#include "core/angle.h"
#include "sim/dynamic/dynamic_drive.h"
#include "sim/quasi_static/quasi_static.h"
#include "tests/sim/reference_models.h"

namespace slipway::api {
namespace {

constexpr double kMars_m_s2 = 3.71;

struct Climb {
  sim::StationState balance;
  sim::DynamicDrive drive;
};

Climb climb(const sim::RoverModel& rover, const sim::Soil& soil, double slope_deg) {
  const sim::FunctionGround ground(
      [rise = std::tan(rad_from_deg(slope_deg))](double x, double) { return rise * x; });
  Climb out;
  sim::QuasiStaticSolver solver(rover, kMars_m_s2);
  out.balance = solver.solve(sim::stance_on_plane(rover, {.pitch_rad = -rad_from_deg(slope_deg)}), soil,
                             {.speed_m_s = rover.cruise_speed_m_s});
  sim::DriveLeg leg;
  leg.command.speed_m_s = rover.cruise_speed_m_s;
  leg.length_m = 2.0;
  NoProgress progress;
  auto drive = sim::simulate_drive(rover, kMars_m_s2, ground, {{soil}, soil}, {}, std::vector{leg}, {},
                                   nullptr, progress);
  EXPECT_TRUE(drive) << rover.name << " " << slope_deg << ": " << drive.error().detail;
  if (drive) out.drive = std::move(*drive);
  return out;
}

TEST(FidelityLevels, AgreeOnWhereARoverGets) {
  const Catalogue catalogue = load_catalogue(SLIPWAY_DATA_FOLDER).value();
  for (const auto& [rover_name, rover] : catalogue.rovers) {
    for (const auto& [soil_name, soil] : catalogue.soils) {
      if (soil.mean.slip_curve != nullptr) continue;
      for (double slope_deg = 0.0; slope_deg <= 30.0; slope_deg += 2.5) {
        const Climb at = climb(*rover, soil.mean, slope_deg);
        const bool finishes = at.drive.end == sim::DriveEnd::kFinished;
        EXPECT_EQ(at.balance.moving(), finishes)
            << rover_name << " on " << soil_name << ", " << slope_deg
            << " deg: " << sim::describe(at.balance.outcome) << " slip " << at.balance.slip_ratio << "; "
            << sim::describe(at.drive.end) << " slip " << at.drive.max_slip_ratio.value << " final "
            << sim::final_slip_ratio(at.drive) << " " << at.drive.reason;
      }
    }
  }
}

}  // namespace
}  // namespace slipway::api
