#include "gap/diagnosis/held_out/correction_choice.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "tests/sim/reference_models.h"

namespace slipway::gap {
namespace {

// Candidates {a}, {b}, nothing, {a} and something unknown, {c}: each with a fit of its own.
ExplanationSearch search_of(const DriveCampaign& campaign) {
  ExplanationSearch search;
  const auto add = [&](std::vector<std::string> effects, bool with_unknown = false) {
    Candidate c;
    c.effects = std::move(effects);
    c.with_unknown = with_unknown;
    c.fit = search.fits.size();
    search.fits.push_back({{}, Hypothesis(campaign, {})});
    search.candidates.push_back(std::move(c));
  };
  add({"a"});
  add({"b"});
  add({});
  add({"a"}, true);
  add({"c"});
  return search;
}

class ChosenCorrections : public ::testing::Test {
 protected:
  ChosenCorrections() {
    campaign_.rover = std::make_shared<sim::RoverModel>(sim::six_wheeler());
    campaign_.soils.resize(1);
    search_ = search_of(campaign_);
  }
  CorrectionChoice chosen(const SelectionBootstrap& selection, std::size_t most_believed) const {
    return choose_corrections(prepared_, search_, selection, 0, most_believed, options_);
  }
  DriveCampaign campaign_;
  ExplanationSearch search_;
  PreparedCampaign prepared_;
  DiagnosisOptions options_;
};

TEST_F(ChosenCorrections, GiveResamplesWhatTheyWouldHaveChosen) {
  const CorrectionChoice choice =
      chosen({.chosen = {0, 1, 2, 3, 4, 1}, .share = {0.5, 0.3, 0.1, 0.09, 0.01}}, 0);
  // {a}; then {b}, and twice none. So rare a choice as {c} counts as {a}.
  EXPECT_EQ(choice.corrections.size(), 4U);
  EXPECT_EQ(choice.of_resample, (std::vector<std::size_t>{0, 1, 2, 3, 0, 1}));
}

TEST_F(ChosenCorrections, GiveWhatWasMostBelievedTheNamesThatWereTakenFromIt) {
  const CorrectionChoice choice = chosen({.chosen = {1, 0, 1}, .share = {0.3, 0.7, 0.0, 0.0, 0.0}}, 1);
  EXPECT_EQ(choice.corrections.size(), 1U);
  EXPECT_EQ(choice.of_resample, (std::vector<std::size_t>{0, 0, 0}));
}

}  // namespace
}  // namespace slipway::gap
