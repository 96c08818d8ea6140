#include "gap/diagnosis/model_check.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/angle.h"
#include "gap/diagnosis/model/drive_resampling.h"
#include "gap/diagnosis/model/nuisance_catalogue.h"

namespace slipway::gap {
namespace {

const ChannelCheck& find(const std::vector<ChannelCheck>& checks, Channel channel, SlopeClass slope) {
  const auto found = std::find_if(checks.begin(), checks.end(), [&](const ChannelCheck& c) {
    return c.channel == channel && c.slope == slope;
  });
  if (found == checks.end()) throw std::out_of_range("no such check");
  return *found;
}

// A value of a current: what either model is off by, on level ground.
PredictedValue predicted(std::size_t group, double nominal_error, double corrected_error) {
  return {Channel::kCurrent, group, 0.0, 1.0, 1.0 + nominal_error, 1.0 + corrected_error, 1.0};
}

TEST(ModelCheck, ErrorsThatAreHalvedInEveryDriveAreHalfWayDownForSure) {
  std::vector<PredictedValue> values;
  for (std::size_t group = 0; group < 6; ++group)
    for (const double error : {-4.0, 2.0, 2.0}) values.push_back(predicted(group, error, 0.5 * error));
  const auto checks = score_predicted(values, {});
  const ChannelCheck& c = find(checks, Channel::kCurrent, SlopeClass::kAll);
  EXPECT_EQ(c.values, 18U);
  EXPECT_EQ(c.drives, 6U);
  EXPECT_NEAR(c.rms.nominal, std::sqrt(8.0), 1e-12);
  EXPECT_NEAR(c.median.nominal, 2.0, 1e-12);
  for (const ErrorChange& change : {c.rms, c.median}) {
    EXPECT_NEAR(change.corrected, 0.5 * change.nominal, 1e-12);
    EXPECT_NEAR(change.down_percent, 50.0, 1e-12);
    ASSERT_TRUE(change.down_interval);
    EXPECT_NEAR(change.down_interval->low, 50.0, 1e-12);
    EXPECT_NEAR(change.down_interval->high, 50.0, 1e-12);
  }
}

TEST(ModelCheck, AWorseModelIsDownByLessThanNothing) {
  std::vector<PredictedValue> values;
  for (std::size_t group = 0; group < 6; ++group) values.push_back(predicted(group, 1.0, 1.5));
  const auto checks = score_predicted(values, {});
  EXPECT_NEAR(find(checks, Channel::kCurrent, SlopeClass::kAll).rms.down_percent, -50.0, 1e-12);
}

// Better in some drives, worse in others: the interval reaches over nothing.
TEST(ModelCheck, DrivesThatDisagreeWidenTheInterval) {
  std::vector<PredictedValue> values;
  for (std::size_t group = 0; group < 8; ++group)
    values.push_back(predicted(group, 1.0, group % 2 == 0 ? 0.2 : 1.4));
  const auto checks = score_predicted(values, {});
  const ErrorChange& rms = find(checks, Channel::kCurrent, SlopeClass::kAll).rms;
  EXPECT_NEAR(rms.down_percent, 0.0, 1e-9);
  ASSERT_TRUE(rms.down_interval);
  EXPECT_LT(rms.down_interval->low, -10.0);
  EXPECT_GT(rms.down_interval->high, 10.0);
}

TEST(ModelCheck, RepeatsAreOneDriveAndFewDrivesHaveNoInterval) {
  DriveCampaign campaign;
  for (const char* const id : {"a", "b", "a2", "c", "b2"}) {
    campaign.drives.emplace_back();
    campaign.drives.back().id = id;
  }
  campaign.drives[2].repeat_of = "a";
  campaign.drives[4].repeat_of = "b";
  const std::vector<std::size_t> groups = repeat_groups(campaign);
  EXPECT_EQ(groups, (std::vector<std::size_t>{0, 1, 0, 2, 1}));
  std::vector<PredictedValue> values;
  for (const std::size_t group : groups) values.push_back(predicted(group, 1.0, 0.5));
  const auto checks = score_predicted(values, {});
  const ChannelCheck& c = find(checks, Channel::kCurrent, SlopeClass::kAll);
  EXPECT_EQ(c.drives, 3U);
  EXPECT_FALSE(c.rms.down_interval);
}

TEST(ModelCheck, IntervalsAndSlopesAreThoseOfTheValues) {
  std::vector<PredictedValue> values{predicted(0, 1.0, 0.5), predicted(1, 1.0, 1.0), predicted(2, 1.0, 1.6),
                                     predicted(3, 1.0, 1.7)};
  values[0].gradient_rad = rad_from_deg(9.0);
  values[1].gradient_rad = rad_from_deg(-9.0);
  values[2].gradient_rad = rad_from_deg(7.0);
  values[3].gradient_rad = rad_from_deg(-7.0);
  const auto checks = score_predicted(values, {});
  const ChannelCheck& all = find(checks, Channel::kCurrent, SlopeClass::kAll);
  EXPECT_NEAR(all.within_50, 0.25, 1e-12);
  EXPECT_NEAR(all.within_90, 0.75, 1e-12);
  EXPECT_NEAR(find(checks, Channel::kCurrent, SlopeClass::kUp).rms.corrected, 0.5, 1e-12);
  EXPECT_NEAR(find(checks, Channel::kCurrent, SlopeClass::kDown).rms.corrected, 1.0, 1e-12);
  EXPECT_EQ(find(checks, Channel::kCurrent, SlopeClass::kLevel).values, 2U);
  EXPECT_EQ(checks.size(), kSlopeClasses.size()) << "channels without values have no row";
}

// A corrected model is a nominal one for the next fit: nothing of it may be reset.
TEST(NuisanceCatalogue, LeavesAModelAsItIsAtNought) {
  sim::Soil soil;
  soil.c1 = 0.3;
  soil.c2 = 0.1;
  soil.exit_angle_ratio = 0.2;
  soil.shear_coupling = 0.5;
  sim::RoverModel rover;
  rover.pull_below_axle = 1.0;
  rover.drive.no_load_current_a = 0.2;
  const sim::Soil before = soil;
  const sim::RoverModel rover_before = rover;
  for (const Nuisance& row : nuisance_catalogue()) {
    if (row.on_soil != nullptr) row.on_soil(0.0, soil);
    if (row.on_rover != nullptr) row.on_rover(0.0, rover);
  }
  for (const auto field :
       {&sim::Soil::c1, &sim::Soil::c2, &sim::Soil::exit_angle_ratio, &sim::Soil::shear_coupling,
        &sim::Soil::cohesion_pa, &sim::Soil::shear_modulus_x_m, &sim::Soil::shear_modulus_y_m})
    EXPECT_EQ(soil.*field, before.*field);
  EXPECT_NEAR(soil.friction_angle_rad, before.friction_angle_rad, 1e-12);
  EXPECT_EQ(rover.pull_below_axle, rover_before.pull_below_axle);
  EXPECT_EQ(rover.drive.no_load_current_a, rover_before.drive.no_load_current_a);
  EXPECT_EQ(rover.drive.torque_constant_nm_per_a, rover_before.drive.torque_constant_nm_per_a);
}

}  // namespace
}  // namespace slipway::gap
