#include "gap/diagnosis/model/measured_rates.h"

#include <gtest/gtest.h>

#include <memory>

#include "gap/diagnosis/model/hypothesis.h"
#include "tests/sim/reference_models.h"

namespace slipway::gap {
namespace {

// One straight drive of which every row's rates are `shares` of the commanded ones.
DriveCampaign campaign_with_rates(const std::vector<double>& shares, std::size_t rows = 40) {
  DriveCampaign campaign;
  campaign.rover = std::make_shared<sim::RoverModel>(sim::six_wheeler());
  campaign.soils.resize(1);
  MeasuredDriveSeries drive;
  drive.command = {.speed_m_s = 0.04};
  const auto commanded = sim::wheel_commands(*campaign.rover, drive.command);
  for (std::size_t i = 0; i < rows; ++i) {
    DriveSample sample;
    sample.time_s = static_cast<double>(i);
    sample.wheels = sim::PerWheel<WheelReading>(commanded.size());
    for (std::size_t k = 0; k < shares.size(); ++k)
      sample.wheels[k].rate_rad_s = shares[k] * commanded[k].rate_rad_s;
    drive.samples.push_back(sample);
  }
  campaign.drives.push_back(drive);
  return campaign;
}

TEST(MeasuredRateShares, AreThoseOfAWheelThatTurnsSlowerThanTheOthers) {
  const auto shares = measured_rate_shares(campaign_with_rates({0.98, 0.98, 0.49, 0.98, 0.98, 0.98}));
  ASSERT_TRUE(shares);
  EXPECT_NEAR((*shares)[2], 0.5, 1e-12);
  EXPECT_NEAR((*shares)[0], 1.0, 1e-12) << "a rate that all wheels have is the rover's";
}

TEST(MeasuredRateShares, PassOverRowsInWhichTheWheelsStand) {
  DriveCampaign campaign = campaign_with_rates(std::vector<double>(6, 1.0));
  for (std::size_t i = 0; i < 25; ++i)
    for (WheelReading& wheel : campaign.drives[0].samples[i].wheels) wheel.rate_rad_s = 0.0;
  const auto shares = measured_rate_shares(campaign);
  ASSERT_TRUE(shares);
  EXPECT_NEAR((*shares)[3], 1.0, 1e-12);
}

TEST(MeasuredRateShares, AreNoneWhereARateIsMissingOrRowsAreFew) {
  EXPECT_FALSE(measured_rate_shares(campaign_with_rates(std::vector<double>(5, 1.0))));
  EXPECT_FALSE(measured_rate_shares(campaign_with_rates(std::vector<double>(6, 1.0), 5)));
}

double least_share(const DriveCampaign& campaign, const std::string& wheel) {
  std::vector<EffectVariant> variants = effect_variants(*campaign.rover, {});
  bound_by_measured_rates(campaign, variants);
  for (const EffectVariant& variant : variants)
    if (variant.effect == "dragging_wheel" && variant.label == wheel) return variant.free.front().lowest;
  ADD_FAILURE() << wheel;
  return 0.0;
}

TEST(BoundByMeasuredRates, AWheelDidNotTurnSlowerThanItWasMeasuredTo) {
  const DriveCampaign slow = campaign_with_rates({1.0, 1.0, 0.85, 1.0, 1.0, 1.0});
  const std::string dragged = slow.rover->wheels[2].name, other = slow.rover->wheels[0].name;
  EXPECT_NEAR(least_share(slow, dragged), 0.82, 1e-12);
  EXPECT_NEAR(least_share(slow, other), 0.97, 1e-12);
  EXPECT_NEAR(least_share(campaign_with_rates({}), dragged), 0.02, 1e-12) << "nothing was measured";
}

}  // namespace
}  // namespace slipway::gap
