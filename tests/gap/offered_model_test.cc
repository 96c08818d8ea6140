#include "gap/diagnosis/describe/offered_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string_view>

#include "tests/sim/reference_models.h"

namespace slipway::gap {
namespace {

class OfferedModel : public ::testing::Test {
 protected:
  OfferedModel() {
    campaign_.rover = std::make_shared<sim::RoverModel>(sim::six_wheeler());
    campaign_.soils.resize(1);
  }
  // Of a verdict whose re-tuned model leaves so much of what the nominal one leaves of slip, and of current.
  Diagnosis offered(Verdict verdict, double log_density_gain, double slip = 1.0, double current = 1.0,
                    std::string_view at_its_end = {}) {
    FittedExplanation reported{{}, Hypothesis(campaign_, {})};
    reported.x = reported.hypothesis.neutral();
    for (std::size_t p = 0; p < reported.x.size(); ++p)
      if (const Parameter& parameter = reported.hypothesis.parameters()[p]; parameter.name == at_its_end)
        reported.x[p] = parameter.highest;
    const auto count = static_cast<Eigen::Index>(reported.x.size());
    reported.covariance = Eigen::MatrixXd::Identity(count, count);
    Diagnosis d;
    d.verdict = verdict;
    d.gap.resize(2);
    d.gap[0].channel = Channel::kSlip;
    d.gap[1].channel = Channel::kCurrent;
    for (ChannelClosure& channel : d.gap) channel.nominal.value = 1.0;
    d.gap[0].retuned.value = d.gap[0].with_effects.value = slip;
    d.gap[1].retuned.value = d.gap[1].with_effects.value = current;
    offer_model(reported, log_density_gain, HeldOutOptions{}, d);
    return d;
  }
  DriveCampaign campaign_;
};

TEST_F(OfferedModel, OfNamedEffectsIsWhatTellsHeldOutDrivesBetter) {
  for (const Verdict verdict : {Verdict::kEffects, Verdict::kEffectSet}) {
    EXPECT_TRUE(offered(verdict, 0.1, 0.5).model);
    for (const double gain : {0.0, -3.0, std::nan("")}) {
      const Diagnosis none = offered(verdict, gain, 0.5);
      EXPECT_FALSE(none.model) << gain;
      ASSERT_EQ(none.notes.size(), 1U);
      EXPECT_NE(none.notes[0].find("did not improve drives held out"), std::string::npos) << none.notes[0];
    }
  }
}

TEST_F(OfferedModel, OfNoGapIsNever) {
  for (const Verdict verdict : {Verdict::kNoGap, Verdict::kNotDetected, Verdict::kInsufficient}) {
    const Diagnosis d = offered(verdict, 1.0, 0.1, 0.1);
    EXPECT_FALSE(d.model);
    EXPECT_TRUE(d.notes.empty());
  }
}

// A partial answer came with a model that told held-out slip six times worse than the nominal one.
TEST_F(OfferedModel, PredictsNoChannelWorseThanTheNominalOneWhateverTheVerdict) {
  for (const Verdict verdict : {Verdict::kEffects, Verdict::kParameters, Verdict::kUnknown}) {
    EXPECT_TRUE(offered(verdict, 1.0, 0.5, 1.0).model);
    const Diagnosis worse = offered(verdict, 1.0, 0.5, 1.3);
    EXPECT_FALSE(worse.model);
    ASSERT_EQ(worse.notes.size(), 1U);
    EXPECT_NE(worse.notes[0].find("current 30 % worse"), std::string::npos) << worse.notes[0];
    EXPECT_FALSE(offered(verdict, 1.0, 1.0, 1.0).model) << "none better";
  }
}

TEST_F(OfferedModel, HasNoParameterAtAnEndOfWhatItMayBe) {
  const Diagnosis d = offered(Verdict::kParameters, 1.0, 0.5, 0.5, "friction");
  EXPECT_FALSE(d.model);
  ASSERT_EQ(d.notes.size(), 1U);
  EXPECT_NE(d.notes[0].find("friction would stand at the end"), std::string::npos) << d.notes[0];
}

}  // namespace
}  // namespace slipway::gap
