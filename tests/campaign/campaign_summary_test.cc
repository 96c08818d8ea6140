#include "campaign/campaign_summary.h"

#include <gtest/gtest.h>

#include "core/angle.h"
#include "tables.h"

namespace slipway::campaign {
namespace {

TEST(CampaignSummary, BandsAreLinearBetweenOrderStatistics) {
  const auto band = band_of({4.0, 0.0, 1.0, 3.0, 2.0});
  ASSERT_TRUE(band);
  EXPECT_EQ(band->count, 5);
  EXPECT_DOUBLE_EQ(band->lowest, 0.0);
  EXPECT_DOUBLE_EQ(band->p05, 0.2);
  EXPECT_DOUBLE_EQ(band->p50, 2.0);
  EXPECT_DOUBLE_EQ(band->p95, 3.8);
  EXPECT_DOUBLE_EQ(band->highest, 4.0);
  EXPECT_FALSE(band_of({}));
}

DriveRecord made_up(const std::string& id, double slip, Pose2 final) {
  DriveRecord record;
  record.id = id;
  record.end = "finished";
  record.answered = true;
  record.commanded_m = 0.3;
  record.final_slip_ratio = slip;
  record.commanded = {0.3, 0.0, 0.0};
  record.final = final;
  return record;
}

TEST(CampaignSummary, CountsEndsAndMeasuresRepeatsAgainstEachOther) {
  const auto table = read_table(kSmallTable);
  ASSERT_TRUE(table);
  std::map<std::string, DriveRecord> records;
  records["ahead-level-h000-r1"] = made_up("", 0.1, {0.28, 0.0, rad_from_deg(-2.0)});
  records["ahead-level-h000-r2"] = made_up("", 0.3, {0.22, 0.0, rad_from_deg(4.0)});
  DriveRecord& turn = records["turn"] = made_up("", 0.0, {0.0, 0.0, rad_from_deg(-9.0)});
  turn.commanded_m = 0.0;
  turn.commanded = {0.0, 0.0, rad_from_deg(-10.0)};
  DriveRecord& unanswered = records["ahead-slope-h000-r1"];
  unanswered.end = "no_data";
  const auto summaries = summarise(*table, expand(*table), records);
  ASSERT_EQ(summaries.size(), 2U);
  const TerrainSummary& level = summaries[0];
  EXPECT_EQ(level.terrain, "level");
  EXPECT_EQ(level.drives, 3);
  EXPECT_EQ(level.ends.at("finished"), 3);
  EXPECT_DOUBLE_EQ(level.slip_ratio->p50, 0.2);
  EXPECT_NEAR(level.heading_error_rad->highest, rad_from_deg(4.0), 1e-12);
  EXPECT_NEAR(level.position_error_m->highest, 0.08, 1e-12);
  EXPECT_NEAR(level.turn_error_rad->p50, rad_from_deg(1.0), 1e-12);
  EXPECT_EQ(level.repeat_spread_m->count, 1);
  EXPECT_NEAR(level.repeat_spread_m->p50, 0.03, 1e-12);
  EXPECT_NEAR(level.repeat_spread_rad->p50, rad_from_deg(3.0), 1e-12);
  EXPECT_EQ(summaries[1].ends.at("no_data"), 1);
  EXPECT_FALSE(summaries[1].slip_ratio);
}

TEST(CampaignSummary, HeadingErrorsAreTheShorterWayRound) {
  DriveRecord record = made_up("", 0.0, {0.0, 0.0, rad_from_deg(179.0)});
  record.commanded.yaw_rad = rad_from_deg(-179.0);
  EXPECT_NEAR(heading_error_rad(record), rad_from_deg(-2.0), 1e-12);
}

}  // namespace
}  // namespace slipway::campaign
