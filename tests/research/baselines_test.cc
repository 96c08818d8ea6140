#include "research/benchmark/baselines.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "api/files/campaign/drive_campaign_source.h"
#include "api/files/catalogue.h"
#include "gap/diagnosis/model/drive_resampling.h"

namespace slipway::gap {
namespace {

TEST(Baselines, SampleBySampleEveryWindowIsADriveThatShowsTheSame) {
  const std::filesystem::path data = SLIPWAY_DATA_FOLDER;
  const auto campaign = api::load_drive_campaign(data / "gap-practice/p04", api::Catalogue{});
  ASSERT_TRUE(campaign) << campaign.error().detail;
  const std::vector<DriveWindow> whole = cut_windows(*campaign);
  const DriveCampaign cut = each_window_a_drive(*campaign, {});
  const std::vector<DriveWindow> pieces = cut_windows(cut);
  ASSERT_GT(whole.size(), campaign->drives.size());
  ASSERT_EQ(pieces.size(), whole.size());
  for (std::size_t w = 0; w < whole.size(); ++w) {
    EXPECT_EQ(pieces[w].drive, w);
    EXPECT_EQ(pieces[w].start_s, whole[w].start_s);
    EXPECT_EQ(pieces[w].end_s, whole[w].end_s);
    ASSERT_EQ(pieces[w].observations.size(), whole[w].observations.size());
    for (std::size_t i = 0; i < whole[w].observations.size(); ++i) {
      EXPECT_EQ(pieces[w].observations[i].channel, whole[w].observations[i].channel);
      EXPECT_NEAR(pieces[w].observations[i].value, whole[w].observations[i].value, 1e-9);
    }
  }
  EXPECT_EQ(repeat_groups(cut).back() + 1, whole.size());
}

}  // namespace
}  // namespace slipway::gap
