#include "gap/diagnosis/describe/look_alikes.h"

#include <gtest/gtest.h>

#include <memory>

#include "tests/sim/reference_models.h"

namespace slipway::gap {
namespace {

ScreenedVariant screened(const std::string& effect, const Eigen::Vector3d& signature, double kept_share,
                         double visibility) {
  ScreenedVariant s;
  s.variant.effect = effect;
  s.signature = signature;
  s.reach = signature.normalized();
  s.kept_share = kept_share;
  s.visibility = visibility;
  s.taken_by = {1};
  return s;
}

ExplanationSearch search_of(std::vector<ScreenedVariant> effects, std::vector<ScreenedVariant> outside) {
  DriveCampaign campaign;
  campaign.rover = std::make_shared<sim::RoverModel>(sim::six_wheeler());
  campaign.soils.resize(1);
  ExplanationSearch search;
  search.fits.push_back({{}, Hypothesis(campaign, {})});
  search.screened = std::move(effects);
  search.screened_outside = std::move(outside);
  return search;
}

TEST(LookAlikes, ArePairsWithNearlyParallelTracesOfEffectsAndOfCausesFromOutside) {
  const ExplanationSearch search = search_of({screened("grousers", {10.0, 0.0, 0.0}, 0.9, 20.0),
                                              screened("wheel_radius", {10.0, 1.0, 0.0}, 0.9, 20.0),
                                              screened("attitude_bias", {0.0, 0.0, 5.0}, 0.9, 20.0)},
                                             {screened("pull_along_travel", {0.0, 0.6, -5.0}, 0.9, 20.0)});
  ASSERT_EQ(confusable_pairs(search, {}).size(), 1U);
  EXPECT_NEAR(confusable_pairs(search, {}).front().angle_deg, 5.71, 0.01);
  const std::vector<LookAlike> alike = look_alikes(search, {});
  ASSERT_EQ(alike.size(), 3U);
  EXPECT_EQ(alike[0].effect, "grousers");
  EXPECT_EQ(alike[0].like, "wheel_radius");
  EXPECT_EQ(alike[1].like, "grousers");
  EXPECT_EQ(alike[2].effect, "attitude_bias");
  EXPECT_EQ(alike[2].like, "pull_along_travel");
}

// One field alone is 45 deg away from the other effect's trace; both together are that trace.
TEST(LookAlikes, CountAllFieldsOfTheOtherEffectAndAllItsVariants) {
  ScreenedVariant steering = screened("steering_offset", {0.0, 0.0, 9.0}, 0.9, 20.0);
  ScreenedVariant grousers = screened("grousers", {10.0, 0.0, 0.0}, 0.9, 20.0);
  grousers.reach = Eigen::MatrixXd::Identity(3, 2);
  ScreenedVariant other_way = screened("steering_offset", {1.0, 1.0, 0.0}, 0.9, 20.0);
  const ScreenedVariant radius = screened("wheel_radius", {7.0, 7.0, 0.0}, 0.9, 20.0);
  const std::vector<LookAlike> alike =
      look_alikes(search_of({radius, grousers, steering, other_way}, {}), {});
  ASSERT_EQ(alike.size(), 2U) << "grousers do not look like a radius, and steering looks like neither";
  for (const LookAlike& of : alike) {
    EXPECT_EQ(of.effect, "wheel_radius");
    EXPECT_NEAR(of.angle_deg, 0.0, 1e-4);
  }
  EXPECT_EQ(confusable_pairs(search_of({radius, grousers}, {}), {}).size(), 1U);
}

TEST(LookAlikes, AreParametersWhereTheseDrivesWouldNotHaveShownTheEffectBesideThem) {
  const DescriptionOptions options;
  const auto with = [&](double kept_share, double visibility, double of_other_variant) {
    return look_alikes(search_of({screened("side_bulldozing", {0.1, 0.0, 0.0}, kept_share, visibility),
                                  screened("side_bulldozing", {0.1, 0.0, 0.0}, kept_share, of_other_variant)},
                                 {}),
                       options);
  };
  const std::vector<LookAlike> alike = with(0.2, 3.0, 2.0);
  ASSERT_EQ(alike.size(), 1U);
  EXPECT_EQ(alike[0].like, "parameters");
  EXPECT_EQ(alike[0].which, std::vector<std::string>{"n"}) << "the second parameter of the re-tuned ones";
  EXPECT_NEAR(alike[0].angle_deg, 11.54, 0.01);
  EXPECT_TRUE(with(0.2, 3.0, 7.0).empty()) << "in another way it would have shown";
  EXPECT_TRUE(with(0.8, 3.0, 2.0).empty()) << "small, and not because of the parameters";
}

}  // namespace
}  // namespace slipway::gap
