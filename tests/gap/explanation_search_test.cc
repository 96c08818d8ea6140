#include "gap/diagnosis/search/explanation_search.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "gap/diagnosis/describe/found_causes.h"
#include "gap/diagnosis/search/selection.h"
#include "sim/effects/effect_catalogue.h"
#include "tests/sim/reference_models.h"

namespace slipway::gap {
namespace {

DriveCampaign campaign_of_one_soil() {
  DriveCampaign campaign;
  campaign.rover = std::make_shared<sim::RoverModel>();
  campaign.soils.resize(1);
  campaign.rover = std::make_shared<sim::RoverModel>(sim::six_wheeler());
  return campaign;
}

EffectVariant variant(const std::string& effect, const std::string& field, double std) {
  EffectVariant v;
  v.effect = effect;
  v.free = {{field, std, -10.0, 10.0}};
  return v;
}

TEST(Priors, AddUpToOneOverAllSetsThatStandAlone) {
  const PriorOptions options;
  constexpr double kOutside = 5.0;
  for (const double effects : {2.0, 7.0, 16.0}) {
    const double pairs = 0.5 * effects * (effects - 1.0);
    const LogPrior nothing = log_prior_of_nothing(options), one = log_prior_of_one(options, effects),
                   two = log_prior_of_two(options, effects);
    const LogPrior outside = log_prior_of_outside(options, kOutside),
                   both = log_prior_of_one_and_outside(options, effects, kOutside);
    EXPECT_NEAR(std::exp(nothing.alone) + std::exp(nothing.with_something_else) +
                    kOutside * std::exp(outside.alone) + effects * kOutside * std::exp(both.alone) +
                    effects * (std::exp(one.alone) + std::exp(one.with_something_else)) +
                    pairs * std::exp(two.alone),
                1.0, 1e-12)
        << effects;
    EXPECT_NEAR(two.with_something_else - two.alone, std::log(options.something_else), 1e-12);
  }
  EXPECT_NEAR(std::exp(log_prior_of_two(options, 1.0).alone), options.two_effects, 1e-12)
      << "no pair: finite";
}

// A search that is cancelled before anything was fitted has nothing to weigh.
TEST(Weigh, LeavesNoCandidatesAlone) {
  rank({}, EvidenceOptions{});
}

TEST(Weigh, SumsOverTheWaysInWhichAnEffectCouldBeAtWork) {
  std::vector<Candidate> c(2);
  c[0].log_evidence = 10.0;
  c[0].log_prior = std::log(0.1);
  c[0].other_variants = {{0.0, -4.0}, {}, {-2.0}};  // of three effects
  c[1].log_prior = std::log(0.7);
  EvidenceOptions options;
  options.share = 0.5;
  weigh(c, options);
  const double effect = 0.1 * (std::exp(5.0) + std::exp(5.0) + std::exp(3.0)) * (1.0 + std::exp(-1.0));
  EXPECT_NEAR(c[0].probability, effect / (effect + 0.7), 1e-12);
}

TEST(WorthNaming, AsksEachEffectForAGoodPartOfItsUsualSize) {
  const DriveCampaign campaign = campaign_of_one_soil();
  FittedExplanation fit{
      {}, Hypothesis(campaign, {variant("slip_sinkage", "n1", 0.3), variant("wheel_radius", "scale", 0.02)})};
  fit.x = fit.hypothesis.neutral();
  const std::size_t first = fit.hypothesis.nuisance_count();
  fit.x[first] += 0.3 * 0.31;
  fit.x[first + 1] -= 0.02 * 0.29;
  EXPECT_NEAR(size_of(fit, "slip_sinkage"), 0.31, 1e-9);
  EXPECT_NEAR(size_of(fit, "wheel_radius"), 0.29, 1e-9);
  EXPECT_FALSE(worth_naming(fit, 0.3));
  EXPECT_TRUE(worth_naming(fit, 0.28));
}

TEST(WorthNaming, DoesNotAskForWhatOnlySaysInWhichForm) {
  const DriveCampaign campaign = campaign_of_one_soil();
  const sim::EffectVariant soon = sim::find_effect("side_bulldozing")->variants(*campaign.rover)[1];
  EffectVariant walls = soon;
  walls.effect = "side_bulldozing";
  FittedExplanation fit{{}, Hypothesis(campaign, {walls})};
  fit.x = fit.hypothesis.neutral();
  const std::size_t share = fit.hypothesis.nuisance_count(), angle = share + 1;
  fit.x[share] += 0.1 * walls.free[0].std;
  fit.x[angle] -= walls.free[1].std;
  EXPECT_NEAR(size_of(fit, "side_bulldozing"), 0.1, 1e-9);
}

TEST(WentFar, IsOfTheParameterThatWentFarthest) {
  const DriveCampaign campaign = campaign_of_one_soil();
  FittedExplanation null{{}, Hypothesis(campaign, {})};
  null.x = null.hypothesis.neutral();
  EXPECT_FALSE(went_far(null, 2.5));
  null.x[2] -= 2.6 * null.hypothesis.parameters()[2].std;
  EXPECT_TRUE(went_far(null, 2.5));
  EXPECT_FALSE(went_far(null, 2.7));
}

TEST(Hypothesis, SaysWhichQuantityOfWhichSoilAParameterIs) {
  DriveCampaign campaign;
  campaign.soils.resize(2);
  campaign.soils[0].name = "sand";
  campaign.soils[1].name = "frictionless";
  const Hypothesis hypothesis(campaign, {});
  int frictions = 0;
  for (const Parameter& p : hypothesis.parameters()) {
    if (p.quantity != SoilQuantity::kFriction) continue;
    EXPECT_EQ(p.name, "friction/" + campaign.soils[static_cast<std::size_t>(p.soil)].name);
    EXPECT_EQ(p.soil, frictions++);
  }
  EXPECT_EQ(frictions, 2);
}

class MostProbableFits : public ::testing::Test {
 protected:
  MostProbableFits() {
    for (const double mark : {1.0, 2.0, 3.0}) {
      search_.fits.push_back({{}, Hypothesis(campaign_, {})});
      search_.fits.back().log_evidence = mark;
    }
  }
  void candidate(std::size_t fit, std::vector<std::string> effects) {
    search_.candidates.emplace_back();
    search_.candidates.back().fit = fit;
    search_.candidates.back().effects = std::move(effects);
  }
  std::vector<double> marks(std::size_t most) const {
    std::vector<double> found;
    for (const FittedExplanation& fit : most_probable_fits(search_, most)) found.push_back(fit.log_evidence);
    return found;
  }

 private:
  DriveCampaign campaign_ = campaign_of_one_soil();
  ExplanationSearch search_;
};

TEST_F(MostProbableFits, TakeEachFitOnce) {
  candidate(2, {"multipass"});
  candidate(2, {"multipass"});
  candidate(0, {"digging"});
  candidate(1, {"ploughing"});
  EXPECT_EQ(marks(2), (std::vector{3.0, 1.0}));
}

TEST_F(MostProbableFits, HaveThePartsOfTheBestSetHoweverImprobable) {
  candidate(2, {"multipass", "digging"});
  candidate(0, {"ploughing"});
  candidate(1, {"digging"});
  EXPECT_EQ(marks(1), (std::vector{3.0, 2.0}));
}

TEST(HiddenShare, CountsVariantsThatWouldNotHaveBeenSeen) {
  DescriptionOptions options;
  options.surely_seen = 6.0;
  std::vector<ScreenedVariant> screened(4);
  screened[0].visibility = 11.9;
  screened[1].visibility = 12.1;
  screened[2].visibility = 50.0;
  screened[3].visibility = 0.0;
  EXPECT_DOUBLE_EQ(hidden_share(screened, options), 0.5);
  EXPECT_DOUBLE_EQ(hidden_share({}, options), 1.0) << "nothing was looked for";
}

}  // namespace
}  // namespace slipway::gap
