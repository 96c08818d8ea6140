// Whether a rover that ships gets up a slope: the balance and the rover in motion must give the same answer.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <string>

#include "api/files/catalogue.h"
#include "core/angle.h"
#include "sim/dynamic/dynamic_drive.h"
#include "sim/quasi_static/quasi_static.h"
#include "tests/sim/reference_models.h"

namespace slipway::api {
namespace {

struct Climb {
  sim::StationState balance;
  sim::DynamicDrive drive;
};

Climb climb(const sim::RoverModel& rover, double gravity_m_s2, const sim::Soil& soil, double slope_deg) {
  const sim::FunctionGround ground(
      [rise = std::tan(rad_from_deg(slope_deg))](double x, double) { return rise * x; });
  Climb out;
  sim::QuasiStaticSolver solver(rover, gravity_m_s2);
  out.balance = solver.solve(sim::stance_on_plane(rover, {.pitch_rad = -rad_from_deg(slope_deg)}), soil,
                             {.speed_m_s = rover.cruise_speed_m_s});
  sim::DriveLeg leg;
  leg.command.speed_m_s = rover.cruise_speed_m_s;
  leg.length_m = 90.0 * rover.cruise_speed_m_s;
  NoProgress progress;
  const sim::DynamicOptions options{.feedback = sim::Feedback::kHeading, .give_up_s = 30.0};
  auto drive = sim::simulate_drive(rover, gravity_m_s2, ground, {{soil}, soil}, {}, std::vector{leg}, options,
                                   nullptr, progress);
  EXPECT_TRUE(drive) << rover.name << " " << slope_deg << ": " << drive.error().detail;
  if (drive) out.drive = std::move(*drive);
  return out;
}

std::string text_of(const Climb& at) {
  return fmt::format("the balance: {}, slip {:.2f}; in motion: {}, slip {:.2f} of the whole drive, {}",
                     sim::describe(at.balance.outcome), at.balance.slip_ratio, sim::describe(at.drive.end),
                     sim::final_slip_ratio(at.drive), at.drive.reason);
}

// Rovers where they drive: Cuadriga's accelerations would tip it over on Mars.
TEST(FidelityLevels, AgreeOnWhatEveryRoverThatShipsCanClimb) {
  const Catalogue catalogue = load_catalogue(SLIPWAY_DATA_FOLDER).value();
  const bool all = std::getenv("SLIPWAY_ALL_SOILS") != nullptr;
  int climbed = 0, stuck = 0;
  for (const auto& [rover_name, rover] : catalogue.rovers) {
    const double gravity_m_s2 = rover_name == "cuadriga" ? 9.81 : 3.71;
    for (const auto& [soil_name, soil] : catalogue.soils) {
      if (soil.mean.slip_curve != nullptr) continue;
      if (!all && soil_name != "jlu_mars_1_loose" && soil_name != "mpf_drift" && soil_name != "vl1_blocky")
        continue;
      for (double slope_deg = 0.0; slope_deg <= 25.0; slope_deg += all ? 2.5 : 5.0) {
        const Climb at = climb(*rover, gravity_m_s2, soil.mean, slope_deg);
        const bool arrives = at.drive.end == sim::DriveEnd::kFinished;
        EXPECT_EQ(at.balance.moving(), arrives)
            << rover_name << " on " << soil_name << ", " << slope_deg << " deg: " << text_of(at);
        ++(arrives ? climbed : stuck);
      }
    }
  }
  EXPECT_GT(climbed, 20);
  EXPECT_GT(stuck, 20);
}

}  // namespace
}  // namespace slipway::api
