#include "research/validation/cuadriga/cuadriga_model.h"

#include <gtest/gtest.h>

#include "api/files/catalogue.h"
#include "core/angle.h"
#include "research/validation/cuadriga/cuadriga_windows.h"

namespace slipway::validation {
namespace {

const std::filesystem::path kData = SLIPWAY_DATA_FOLDER;
const CuadrigaParameters kParameters{1.5e6, rad_from_deg(40.0), 0.0035, 9.0, 6.5, 0.0};

TEST(CuadrigaModel, SlipCountsFromLevelDrivingAndTheTableIsTheSolver) {
  const auto catalogue = api::load_catalogue(kData);
  ASSERT_TRUE(catalogue);
  const sim::RoverModel& rover = *catalogue->rovers.at("cuadriga");
  const auto table = ClimbTable::tabulate(rover, ground_of(kParameters));
  ASSERT_TRUE(table);
  const CuadrigaModel model(kParameters, *table);
  EXPECT_DOUBLE_EQ(model.slip({}), 0.0);
  for (const double degrees : {-13.1, 3.3, 9.9, 18.2}) {
    const auto solved = solve_climb(rover, ground_of(kParameters), rad_from_deg(degrees), 0.0);
    ASSERT_TRUE(solved);
    const ClimbState state = table->at({rad_from_deg(degrees), 0.0});
    EXPECT_NEAR(state.slip_ratio, solved->slip_ratio, 1e-3) << degrees;
    EXPECT_NEAR(current_of(kParameters, state), current_of(kParameters, *solved), 0.01) << degrees;
  }
}

TEST(CuadrigaModel, TurnsCostCurrentAndLeftTurnsAsMuchAsRightOnes) {
  const auto catalogue = api::load_catalogue(kData);
  ASSERT_TRUE(catalogue);
  const auto table = ClimbTable::tabulate(*catalogue->rovers.at("cuadriga"), ground_of(kParameters));
  ASSERT_TRUE(table);
  const CuadrigaModel model(kParameters, *table);
  const double left = model.current_a({0.0, rad_from_deg(5.0)});
  EXPECT_GT(left, model.current_a({}) + 0.5);
  EXPECT_EQ(left, model.current_a({0.0, rad_from_deg(-5.0)}));
}

TEST(CuadrigaModel, ASoilTooWeakForTheSteepestDriveIsNoAnswer) {
  const auto catalogue = api::load_catalogue(kData);
  ASSERT_TRUE(catalogue);
  CuadrigaParameters weak = kParameters;
  weak.friction_angle_rad = rad_from_deg(25.0);
  EXPECT_FALSE(ClimbTable::tabulate(*catalogue->rovers.at("cuadriga"), ground_of(weak)));
}

TEST(CuadrigaWindows, TheTurnRateComesFromNeighboursInTheSameLog) {
  const auto windows = load_cuadriga_windows(kData / "validation" / "cuadriga_windows.csv");
  ASSERT_TRUE(windows);
  const CuadrigaWindow &first = (*windows)[0], &second = (*windows)[1], &third = (*windows)[2];
  EXPECT_NEAR(first.turn_rate_rad_s,
              (second.heading_rad - first.heading_rad) / (second.time_s - first.time_s), 1e-12);
  EXPECT_NEAR(second.turn_rate_rad_s, (third.heading_rad - first.heading_rad) / (third.time_s - first.time_s),
              1e-12);
}

}  // namespace
}  // namespace slipway::validation
