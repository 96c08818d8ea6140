#include "gap/diagnosis/model/outside_cause.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <set>

#include "core/angle.h"
#include "gap/diagnosis/model/hypothesis.h"
#include "tests/sim/reference_models.h"

namespace slipway::gap {
namespace {

DriveCampaign campaign_of_one_soil() {
  DriveCampaign campaign;
  campaign.rover = std::make_shared<sim::RoverModel>(sim::six_wheeler());
  campaign.gravity_m_s2 = 3.71;
  campaign.soils.resize(1);
  return campaign;
}

sim::Stance level(double yaw_rad) {
  return sim::stance_on_plane(sim::six_wheeler(), {.roll_rad = 0.0, .pitch_rad = 0.0, .yaw_rad = yaw_rad});
}

TEST(OutsideCatalogue, HasNamesOfItsOwnAndActsOrShows) {
  const DriveCampaign campaign = campaign_of_one_soil();
  std::set<std::string_view> names;
  for (const OutsideCause& cause : outside_catalogue()) {
    EXPECT_TRUE(names.insert(cause.name).second) << cause.name;
    EXPECT_EQ(sim::find_effect(cause.name), nullptr) << cause.name << " is an effect's name";
    EXPECT_TRUE(cause.act != nullptr || cause.show != nullptr) << cause.name;
    EXPECT_TRUE(cause.show == nullptr || cause.form == "sensor") << cause.name;
    EXPECT_EQ(find_outside(cause.name), &cause);
    for (const sim::EffectVariant& variant : cause.variants(campaign)) {
      ASSERT_FALSE(variant.free.empty());
      OutsideValues values(variant.fixed.begin(), variant.fixed.end());
      for (const auto& free : variant.free) values[free.field] = free.std;
      EXPECT_FALSE(cause.words(values, campaign).empty());
    }
  }
  EXPECT_EQ(find_outside("grousers"), nullptr);
}

TEST(WrenchOf, APullAgainstTheTravelHoldsBackEitherWay) {
  const sim::RoverModel rover = sim::six_wheeler();
  OutsideForces forces;
  forces.along_n = -25.0;
  const sim::OutsideWrench forward = wrench_of(forces, rover, level(0.3), {.speed_m_s = 0.04}),
                           backward = wrench_of(forces, rover, level(0.3), {.speed_m_s = -0.04});
  EXPECT_NEAR((forward.force_n - Eigen::Vector3d(-25.0, 0.0, 0.0)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((backward.force_n - Eigen::Vector3d(25.0, 0.0, 0.0)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((forward.moment_nm - rover.com_m.cross(forward.force_n)).norm(), 0.0, 1e-12);
  EXPECT_EQ(wrench_of(forces, rover, level(0.0), {.turn_in_place = true}).force_n.norm(), 0.0);
  forces.height_m = 0.2;
  EXPECT_NEAR(wrench_of(forces, rover, level(0.3), {.speed_m_s = 0.04}).moment_nm.y() - forward.moment_nm.y(),
              -5.0, 1e-12)
      << "nose up";
  forces = {};
  forces.along_by_speed_n = -10.0;
  EXPECT_NEAR(wrench_of(forces, rover, level(0.0), {.speed_m_s = 2.0 * rover.cruise_speed_m_s}).force_n.x(),
              -20.0, 1e-12);
}

TEST(WrenchOf, APushToTheSideAheadOfTheCentreOfMassTurnsTheRoverAsItIsPushed) {
  const sim::RoverModel rover = sim::six_wheeler();
  OutsideForces forces;
  forces.in_body_n = {-10.0, 25.0};
  const sim::OutsideWrench at_mass = wrench_of(forces, rover, level(0.3), {.speed_m_s = 0.04});
  forces.ahead_m = 0.2;
  const sim::OutsideWrench ahead = wrench_of(forces, rover, level(0.3), {.speed_m_s = 0.04});
  EXPECT_NEAR((ahead.moment_nm - at_mass.moment_nm - Eigen::Vector3d(0.0, 0.0, 5.0)).norm(), 0.0, 1e-12);
  EXPECT_EQ(ahead.force_n, at_mass.force_n);
}

TEST(WrenchOf, APushOnTheMapKeepsItsDirectionThereAndALoadIsUpright) {
  const sim::RoverModel rover = sim::six_wheeler();
  OutsideForces forces;
  forces.on_map_n = {0.0, 30.0};
  for (const double yaw : {0.0, 1.0, -2.5}) {
    const sim::Stance stance = level(yaw);
    const Eigen::Vector3d on_map =
        stance.R_MB * wrench_of(forces, rover, stance, {.speed_m_s = 0.04}).force_n;
    EXPECT_NEAR((on_map - Eigen::Vector3d(0.0, 30.0, 0.0)).norm(), 0.0, 1e-12) << yaw;
  }
  forces = {};
  forces.load_n = 12.0;
  const sim::Stance climbing =
      sim::stance_on_plane(rover, {.roll_rad = 0.0, .pitch_rad = rad_from_deg(-10.0), .yaw_rad = 0.0});
  EXPECT_NEAR((climbing.R_MB * wrench_of(forces, rover, climbing, {.speed_m_s = 0.04}).force_n).z(), -12.0,
              1e-12);
  forces = {};
  forces.along_by_slope_n = -8.0;
  EXPECT_NEAR(wrench_of(forces, rover, climbing, {.speed_m_s = 0.04}).force_n.x(), -8.0, 1e-9) << "at 10 deg";
}

TEST(SoilDrift, IsAParabolaOverTheDrives) {
  const SoilDrift drift{.last = -0.1, .middle = 0.2};
  EXPECT_NEAR(drift.factor({.order = -1.0}), 1.0, 1e-12);
  EXPECT_NEAR(drift.factor({.order = 0.0}), 1.0 - 0.05 + 0.2, 1e-12);
  EXPECT_NEAR(drift.factor({.order = 1.0}), 0.9, 1e-12);
  EXPECT_GT((SoilDrift{.last = -3.0, .middle = 0.0}.factor({.order = 1.0})), 0.0);
}

TEST(SoilDrift, GrowsAlongEachDriveAndOverTheMap) {
  EXPECT_NEAR((SoilDrift{.end = -0.1}.factor({.order = -1.0, .along = 1.0})), 0.9, 1e-12);
  EXPECT_NEAR((SoilDrift{.over = {0.1, 0.2}}.factor({.order = -1.0, .on_map = {-1.0, 0.5}})), 1.0, 1e-12);
}

// Of the whole rover neither the force nor the moment changes: what weighs less on one wheel weighs more on
// others.
TEST(OutsideCauses, AMomentInsideTheSuspensionIsNoneOnTheRover) {
  const DriveCampaign campaign = campaign_of_one_soil();
  for (sim::EffectVariant variant : find_outside("moment_inside_suspension")->variants(campaign)) {
    variant.effect = "moment_inside_suspension";
    const Hypothesis hypothesis(campaign, {variant});
    std::vector<double> x = hypothesis.neutral();
    x.back() = 7.0;
    const OutsideForces forces = hypothesis.state(x).outside;
    ASSERT_GE(forces.at_wheel_n.size(), 3U);
    Eigen::Vector3d force = Eigen::Vector3d::Zero(), moment = forces.moment_nm;
    for (const auto& [wheel, at] : forces.at_wheel_n) {
      force += at;
      moment += campaign.rover->wheels[wheel].position_m.cross(at);
    }
    EXPECT_NEAR(force.norm(), 0.0, 1e-12);
    EXPECT_NEAR(moment.norm(), 0.0, 1e-12);
  }
}

TEST(OutsideCauses, EachHasAWayToActAndWordsForBothSigns) {
  DriveCampaign campaign = campaign_of_one_soil();
  campaign.drives.resize(5);
  for (const OutsideCause& cause : outside_catalogue()) {
    EXPECT_TRUE(cause.act != nullptr || cause.show != nullptr) << cause.name;
    for (sim::EffectVariant variant : cause.variants(campaign)) {
      variant.effect = cause.name;
      const Hypothesis hypothesis(campaign, {variant});
      std::vector<double> x = hypothesis.neutral();
      const auto said = [&](double to) {
        for (std::size_t p = hypothesis.nuisance_count(); p < x.size(); ++p) {
          const Parameter& parameter = hypothesis.parameters()[p];
          x[p] = std::clamp(to * parameter.std, parameter.lowest, parameter.highest);
        }
        return cause.words(hypothesis.outside_values(cause.name, x), campaign);
      };
      EXPECT_NE(said(1.0), said(-1.0)) << cause.name << " " << variant.label;
    }
  }
}

sim::EffectVariant first_variant(std::string_view cause, const DriveCampaign& campaign) {
  sim::EffectVariant variant = find_outside(cause)->variants(campaign).front();
  variant.effect = cause;
  return variant;
}

// A place was missing once, and pushes ahead of the centre of mass were told as a wrong inclinometer.
TEST(Hypothesis, APushHasAPlaceOnTheBody) {
  const DriveCampaign campaign = campaign_of_one_soil();
  for (const char* cause : {"push_in_body", "push_on_map"}) {
    const Hypothesis hypothesis(campaign, {first_variant(cause, campaign)});
    std::vector<double> x = hypothesis.neutral();
    x[x.size() - 2] = 0.35;
    x.back() = 0.1;
    EXPECT_EQ(hypothesis.state(x).outside.height_m, 0.35) << cause;
    EXPECT_EQ(hypothesis.state(x).outside.ahead_m, 0.1) << cause;
  }
}

TEST(Hypothesis, ARimThatSlipsOnItsHubTurnsSlowerThanItsWheelIsMeasuredTo) {
  DriveCampaign campaign = campaign_of_one_soil();
  EXPECT_TRUE(find_outside("rim_slip")->variants(campaign).empty())
      << "without measured rates it is a wheel that drags";
  MeasuredDriveSeries drive;
  drive.command = {.speed_m_s = 0.04};
  for (int i = 0; i < 20; ++i) {
    DriveSample sample;
    const auto commanded = sim::wheel_commands(*campaign.rover, drive.command);
    sample.wheels = sim::PerWheel<WheelReading>(commanded.size());
    for (std::size_t k = 0; k < commanded.size(); ++k) sample.wheels[k].rate_rad_s = commanded[k].rate_rad_s;
    drive.samples.push_back(sample);
  }
  campaign.drives.push_back(drive);
  const Hypothesis hypothesis(campaign, {first_variant("rim_slip", campaign)});
  std::vector<double> x = hypothesis.neutral();
  EXPECT_EQ(hypothesis.state(x).rover.wheels[0].rate_share, 1.0);
  x.back() = 0.3;
  const ModelState state = hypothesis.state(x);
  EXPECT_NEAR(state.rover.wheels[0].rate_share, 0.7, 1e-12);
  EXPECT_EQ(state.rover.wheels[1].rate_share, 1.0);
  EXPECT_TRUE(state.effects.empty());
}

TEST(Hypothesis, SoilsThatDriftAreLeftAloneByOneDriveAndByNoDrift) {
  DriveCampaign campaign = campaign_of_one_soil();
  campaign.drives.resize(2);
  EXPECT_TRUE(find_outside("soil_drift")->variants(campaign).empty());
  campaign.drives.resize(5);
  const Hypothesis hypothesis(campaign, {first_variant("soil_drift", campaign)});
  std::vector<double> x = hypothesis.neutral();
  EXPECT_FALSE(hypothesis.state(x).soil_drift.any());
  x.back() = -0.12;
  EXPECT_EQ(hypothesis.state(x).soil_drift.middle, -0.12);
  EXPECT_EQ(
      find_outside("soil_drift")->words(hypothesis.outside_values("soil_drift", x), campaign),
      "the soils' strength changes from drive to drive: 12.0 % weaker in the middle and 0.0 % stronger at "
      "the end than in the first drive");
}

TEST(Hypothesis, FitsACauseFromOutsideAsItFitsAnEffect) {
  const DriveCampaign campaign = campaign_of_one_soil();
  const OutsideCause& pull = *find_outside("pull_along_travel");
  sim::EffectVariant variant = pull.variants(campaign).front();
  variant.effect = pull.name;
  const Hypothesis hypothesis(campaign, {variant});
  std::vector<double> x = hypothesis.neutral();
  EXPECT_FALSE(hypothesis.state(x).outside.any()) << "neutral: nothing acts";
  x[x.size() - 2] = -25.0;
  const ModelState state = hypothesis.state(x);
  EXPECT_EQ(state.outside.along_n, -25.0);
  EXPECT_TRUE(state.effects.empty());
  EXPECT_TRUE(hypothesis.settings(x).empty()) << "none of the library's";
  EXPECT_EQ(hypothesis.parameters().back().name, "pull_along_travel.height_m");
  EXPECT_EQ(pull.words(hypothesis.outside_values(pull.name, x), campaign),
            "a steady pull of 25 N against the travel, at the body");
}

}  // namespace
}  // namespace slipway::gap
