// Tests of the generator's own record of where hidden causes act.
#include "effect_traces.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace slipway::gap_benchmark {
namespace {

SealedCampaign made(std::vector<std::string> causes, bool on_hills = false, std::size_t max_drives = 8) {
  CampaignCase made_of;
  made_of.causes = std::move(causes);
  made_of.on_hills = on_hills;
  made_of.max_drives = max_drives;
  made_of.seed = 5;
  RandomStream random(made_of.seed);
  return make_campaign(made_of, random);
}

std::array<double, kTraceChannels.size()> sums_of(const std::vector<EffectTrace>& traces) {
  std::array<double, kTraceChannels.size()> sums{};
  for (const EffectTrace& trace : traces)
    for (std::size_t c = 0; c < sums.size(); ++c) sums[c] += trace.mean_square[c].value_or(0.0);
  return sums;
}

std::string main_channel_of(std::vector<std::string> causes) {
  const auto sums = sums_of(effect_traces(made(std::move(causes))));
  return kTraceChannels[static_cast<std::size_t>(std::max_element(sums.begin(), sums.end()) - sums.begin())];
}

TEST(EffectTraces, CausesHiddenInTheMotorsActOnTheCurrentAlone) {
  for (const char* cause : {"motor_temperature", "gearbox_friction", "current_gain_drift"}) {
    const std::vector<EffectTrace> traces = effect_traces(made({cause}));
    ASSERT_GT(traces.size(), 8u);
    const auto sums = sums_of(traces);
    EXPECT_GT(sums[kCurrent] / static_cast<double>(traces.size()), 1.0) << cause;
    for (const std::size_t other : {kSlip, kSideSlip, kYawRate, kRoll, kPitch, kSinkage})
      EXPECT_LT(sums[other], 1e-6 * sums[kCurrent]) << cause << ' ' << kTraceChannels[other];
  }
}

TEST(EffectTraces, OtherCausesActMostWhereTheirPhysicsSay) {
  EXPECT_EQ(main_channel_of({"wheel_radius"}), "slip");
  EXPECT_EQ(main_channel_of({"steering_offset"}), "side_slip");
}

TEST(EffectTraces, ABiasOfTheInclinometerIsInItsReadings) {
  SealedCampaign campaign = made({});
  campaign.effects["attitude_bias"]["roll_deg"] = 1.0;
  campaign.world.hidden.roll_bias_rad = 0.0174533;
  for (MadeDrive& drive : campaign.drives)
    for (DriveRow& row : drive.rows) row.roll_rad -= campaign.world.hidden.roll_bias_rad;
  const auto sums = sums_of(effect_traces(campaign));
  EXPECT_GT(sums[kRoll], 0.0);
  EXPECT_LT(sums[kPitch], 1e-9);
  EXPECT_LT(sums[kCurrent], 1e-9 * sums[kRoll]);
}

TEST(EffectTraces, ACampaignWithNothingHiddenHasNoRows) {
  EXPECT_TRUE(effect_traces(made({})).empty());
  EXPECT_EQ(traces_rows("s01", {}), "");
}

TEST(EffectTraces, TheSameWorldReplayedIsTheDrive) {
  const SealedCampaign campaign = made({"bulldozing"});
  for (const MadeDrive& drive : campaign.drives)
    for (const NamedTerrain& terrain : campaign.terrains) {
      if (terrain.name != drive.order.terrain) continue;
      RandomStream random(drive.soil_seed);
      const auto again = replay_drive(campaign.world, terrain.grid, drive.order, random, drive.rows);
      for (std::size_t i = 0; i < again.size(); ++i) {
        ASSERT_TRUE(again[i]);
        EXPECT_NEAR(again[i]->motion.forward_m_s, drive.rows[i].motion.forward_m_s, 1e-7);
        EXPECT_NEAR(again[i]->wheels[0].current_a, drive.rows[i].wheels[0].current_a, 1e-6);
        EXPECT_NEAR(again[i]->wheels[0].sinkage_m, drive.rows[i].wheels[0].sinkage_m, 1e-7);
      }
    }
}

TEST(EffectTraces, VariablesHaveTheDiagnosisSigns) {
  const SealedCampaign campaign = made({"gearbox_friction"}, false, 0);
  const std::vector<EffectTrace> traces = effect_traces(campaign);
  for (const EffectTrace& trace : traces) {
    const auto drive = std::find_if(campaign.drives.begin(), campaign.drives.end(),
                                    [&](const MadeDrive& d) { return d.order.id == trace.drive; });
    ASSERT_NE(drive, campaign.drives.end());
    const DriveOrder& order = drive->order;
    EXPECT_EQ(trace.variables[6], order.turn_in_place ? 1.0 : 0.0);
    EXPECT_EQ(trace.mean_square[kYawRate].has_value(), !order.turn_in_place);
    if (order.terrain != "tilt_15") continue;
    // The table rises east.
    if (order.start_yaw_rad == 0.0)
      EXPECT_NEAR(trace.variables[0], order.speed_m_s < 0.0 ? -15.0 : 15.0, 1.5);
    if (order.start_yaw_rad > 1.5 && order.start_yaw_rad < 1.6) EXPECT_LT(trace.variables[1], -10.0);
  }
}

TEST(EffectTraces, AreRowsOfAsManyCellsAsTheHeaderHas) {
  EffectTrace trace{"D001", {1.0, 2.0, 0.1, 0.04, 0.0, 20.0, 0.0, 15.0}, {}};
  trace.mean_square[kCurrent] = 2.5;
  const std::string header = traces_header(), row = traces_rows("s01", {trace});
  EXPECT_EQ(std::count(header.begin(), header.end(), ','), std::count(row.begin(), row.end(), ','));
  EXPECT_EQ(row, "s01,D001,1,2,0.1,0.04,0,20,0,15,,,,,,2.5,\n");
}

}  // namespace
}  // namespace slipway::gap_benchmark
