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

TEST(OutsideCatalogue, HasNamesOfItsOwnAndEitherActsOrShows) {
  const DriveCampaign campaign = campaign_of_one_soil();
  std::set<std::string_view> names;
  for (const OutsideCause& cause : outside_catalogue()) {
    EXPECT_TRUE(names.insert(cause.name).second) << cause.name;
    EXPECT_EQ(sim::find_effect(cause.name), nullptr) << cause.name << " is an effect's name";
    EXPECT_NE(cause.act == nullptr, cause.show == nullptr) << cause.name;
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
