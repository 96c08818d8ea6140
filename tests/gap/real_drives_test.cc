// Drives of a real rover that ship, as a campaign.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>

#include "api/files/campaign/drive_campaign_source.h"
#include "api/files/catalogue.h"
#include "gap/diagnosis/model/drive_window.h"
#include "gap/diagnosis/model/window_model.h"

namespace slipway::gap {
namespace {

TEST(RealDrives, CuadrigasLogsAreADriveEachWithATotalOfCurrent) {
  const std::filesystem::path data = SLIPWAY_DATA_FOLDER;
  const auto catalogue = api::load_catalogue(data);
  ASSERT_TRUE(catalogue);
  const auto campaign = api::load_drive_campaign(data / "drive-campaigns" / "cuadriga_2018_2019", *catalogue);
  ASSERT_TRUE(campaign);
  EXPECT_EQ(campaign->drives.size(), 24U);
  EXPECT_TRUE(currents_split_evenly(*campaign));
  const std::vector<DriveWindow> windows = cut_windows(*campaign);
  EXPECT_GT(windows.size(), 200U);
  for (const DriveWindow& window : windows) {
    EXPECT_NEAR(window.end_s - window.start_s, 4.0, 0.01);
    ASSERT_EQ(window.observations.size(), 4U) << "slip, side slip, yaw rate, one current";
    EXPECT_EQ(window.observations[3].channel, Channel::kCurrent);
    EXPECT_EQ(window.observations[3].wheel, -1);
    EXPECT_GT(window.observations[0].value, -0.8);
    EXPECT_LT(window.observations[0].value, 0.8);
  }
  const WindowModel model(*campaign, windows, Footing::kPlane);
  // Two lie where the map, a surface model, has trees: planes steeper than 35 deg.
  std::size_t unused = 0;
  for (std::size_t w = 0; w < windows.size(); ++w) unused += model.used(w) ? 0 : 1;
  EXPECT_EQ(unused, 2U);
  EXPECT_TRUE(std::isnan(model.attitude_misfit_rad())) << "no attitude was measured";

  // Where predictions start from changes none of them.
  ModelState state{.rover = *campaign->rover, .soils = {}, .effects = {}};
  for (const NominalSoil& soil : campaign->soils) state.soils.push_back(soil.soil);
  ModelState softer = state;
  softer.soils[0].friction_angle_rad *= 0.9;
  WindowModel started(*campaign, windows, Footing::kPlane);
  started.start_from(softer, 2);
  const std::vector<double> plain = model.predict(state), same = started.predict(state, 2);
  for (std::size_t i = 0; i < plain.size(); ++i)
    if (std::isfinite(plain[i])) {
      EXPECT_NEAR(same[i], plain[i], 1e-6 * (1.0 + std::abs(plain[i]))) << i;
    }
  ModelState hardly_softer = state;
  hardly_softer.soils[0].friction_angle_rad *= 0.9999;
  // Of one rover the balances' geometry is shared, which changes no number.
  const std::vector<WindowModel::NearState> states{{state, true}, {state, false}};
  const std::vector<std::vector<double>> both = model.predict_near(hardly_softer, states, 2);
  const std::vector<double>& near = both[0];
  EXPECT_EQ(std::memcmp(near.data(), both[1].data(), near.size() * sizeof(double)), 0);
  std::size_t moving = 0;
  for (std::size_t i = 0; i < plain.size(); ++i)
    if (std::isfinite(plain[i]) && std::isfinite(near[i])) {
      ++moving;
      EXPECT_NEAR(near[i], plain[i], 1e-6 * (1.0 + std::abs(plain[i]))) << i;
    }
  EXPECT_GT(moving, plain.size() / 2);
  const std::vector<double> alone = started.predict(state, 1);
  EXPECT_EQ(std::memcmp(same.data(), alone.data(), same.size() * sizeof(double)), 0)
      << "the same bytes on any number of threads";
}

}  // namespace
}  // namespace slipway::gap
