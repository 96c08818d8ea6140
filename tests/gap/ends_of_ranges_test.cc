#include "gap/diagnosis/describe/ends_of_ranges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string_view>

#include "gap/diagnosis/model/outside_cause.h"
#include "sim/effects/effect_catalogue.h"
#include "tests/sim/reference_models.h"

namespace slipway::gap {
namespace {

class EndsOfRanges : public ::testing::Test {
 protected:
  EndsOfRanges() {
    campaign_.rover = std::make_shared<sim::RoverModel>(sim::six_wheeler());
    campaign_.gravity_m_s2 = 3.71;
    campaign_.soils.resize(1);
  }
  FittedExplanation fit_of(sim::EffectVariant variant, std::string_view name) const {
    variant.effect = name;
    FittedExplanation fit{{}, Hypothesis(campaign_, {variant})};
    fit.x = fit.hypothesis.neutral();
    return fit;
  }
  FittedExplanation fit_of(std::string_view effect) const {
    return fit_of(sim::find_effect(effect)->variants(*campaign_.rover).front(), effect);
  }
  static std::size_t index_of(const FittedExplanation& fit, std::string_view name) {
    const auto parameters = fit.hypothesis.parameters();
    return static_cast<std::size_t>(std::find_if(parameters.begin(), parameters.end(),
                                                 [name](const Parameter& p) { return p.name == name; }) -
                                    parameters.begin());
  }
  DriveCampaign campaign_;
};

TEST_F(EndsOfRanges, AreNotedWhereTheDrivesMayAskForMore) {
  FittedExplanation fit = fit_of("gearbox_friction");
  const std::size_t loss = index_of(fit, "gearbox_friction.efficiency_loss");
  ASSERT_LT(loss, fit.x.size());
  fit.x[loss] = 0.5 * fit.hypothesis.parameters()[loss].highest;
  EXPECT_TRUE(notes_of_ends_of_ranges(fit).empty());
  fit.x[loss] = fit.hypothesis.parameters()[loss].highest;
  const std::vector<std::string> notes = notes_of_ends_of_ranges(fit);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].find("gearbox_friction.efficiency_loss is estimated at the end of its range (0.9)"),
            std::string::npos)
      << notes[0];
}

TEST_F(EndsOfRanges, AreNoNewsWhereAnEffectDoesNothingNorOfCausesFromOutside) {
  for (const sim::Effect& effect : sim::effect_catalogue()) {
    if (effect.variants == nullptr) continue;
    for (const sim::EffectVariant& variant : effect.variants(*campaign_.rover))
      EXPECT_TRUE(notes_of_ends_of_ranges(fit_of(variant, effect.name)).empty()) << effect.name;
  }
  FittedExplanation pull =
      fit_of(find_outside("pull_along_travel")->variants(campaign_).front(), "pull_along_travel");
  pull.x.back() = pull.hypothesis.parameters().back().highest;
  EXPECT_TRUE(notes_of_ends_of_ranges(pull).empty());
}

}  // namespace
}  // namespace slipway::gap
