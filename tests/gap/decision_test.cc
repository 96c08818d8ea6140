// Decisions from records made by hand, against Bayes's theorem, the chi-square distribution and a loss table.
#include "gap/diagnosis/decide/decision.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "gap/diagnosis/decide/adequacy.h"
#include "gap/diagnosis/decide/calibration.h"
#include "gap/diagnosis/decide/posterior.h"
#include "gap/diagnosis/describe/decision_words.h"

namespace slipway::gap {
namespace {

using Explanation = SearchRecord::Explanation;

// Explanations whose priors are as given, of equal evidence, so that priors are their probabilities; every
// cause closes half of the gap.
SearchRecord record_of(const std::vector<std::pair<Explanation, double>>& explanations) {
  SearchRecord record;
  record.fits.resize(1);
  record.hidden_share = 0.0;
  std::map<std::string, double> causes;
  for (const auto& [explanation, probability] : explanations) {
    record.explanations.push_back(explanation);
    record.explanations.back().log_prior = std::log(probability);
    for (const std::string& effect : explanation.effects) causes[effect] = 0.5;
  }
  for (const auto& [name, share] : causes) record.causes.push_back({name, share});
  weigh(record, 1.0);
  return record;
}
Explanation of(std::vector<std::string> effects, bool with_unknown = false,
               std::vector<std::string> outside = {}) {
  Explanation e;
  e.effects = std::move(effects);
  e.outside = std::move(outside);
  e.with_unknown = with_unknown;
  return e;
}
Decision decided(const SearchRecord& record, const DecisionOptions& options = {}) {
  return decide(record, 0.3, options);
}
using Names = std::vector<std::string>;

TEST(Posterior, IsBayessTheoremOnAShareOfTheEvidence) {
  SearchRecord record = record_of({{of({"com_offset"}), 0.2}, {of({}), 0.8}});
  record.explanations[0].log_evidence = 0.0;  // of nothing, which was more probable
  record.explanations[1].log_evidence = 10.0;
  weigh(record, 0.5);
  const double effect = 0.2 * std::exp(5.0) / (0.2 * std::exp(5.0) + 0.8);
  EXPECT_EQ(record.explanations[0].effects, Names{"com_offset"}) << "the most probable comes first";
  EXPECT_NEAR(record.explanations[0].probability, effect, 1e-12);
  EXPECT_NEAR(marginals_of(record).nothing, 1.0 - effect, 1e-12);
}

TEST(Posterior, SumsOverTheVariantsOfACause) {
  SearchRecord record = record_of({{of({"com_offset"}), 0.1}, {of({}), 0.7}});
  record.explanations[1].other_variants = {{0.0, -4.0}};
  weigh(record, 0.5);
  const double effect = 0.1 * (1.0 + 1.0 + std::exp(-2.0));
  EXPECT_NEAR(marginals_of(record).of_cause.at("com_offset"), effect / (effect + 0.7), 1e-12);
}

TEST(Posterior, MarginalsAreSumsOverExplanations) {
  const Marginals m = marginals_of(record_of({{of({"com_offset", "grousers"}), 0.4},
                                              {of({"com_offset"}, true), 0.2},
                                              {of({}, false, {"force_on_body"}), 0.1},
                                              {of({}), 0.3}}));
  EXPECT_NEAR(m.of_cause.at("com_offset"), 0.6, 1e-12);
  EXPECT_NEAR(m.of_cause.at("grousers"), 0.4, 1e-12);
  EXPECT_NEAR(m.of_cause.at("force_on_body"), 0.1, 1e-12);
  EXPECT_NEAR(m.unknown, 0.3, 1e-12);
  EXPECT_NEAR(m.nothing, 0.3, 1e-12);
}

// The 0.999 quantile of chi-square is 10.828 with one degree of freedom and 13.816 with two.
TEST(Adequacy, IsTheTailOfChiSquare) {
  SearchRecord record;
  record.fits.resize(1);
  record.fits[0].shifts = {{"c1", -std::sqrt(10.828), true}};
  EXPECT_NEAR(adequacy_of(record, 0).conflict_p, 1e-3, 1e-6);
  EXPECT_EQ(adequacy_of(record, 0).furthest, "c1");
  record.scatter_deviations = {std::sqrt(13.816 - 10.828)};
  EXPECT_NEAR(adequacy_of(record, 0).conflict_p, 1e-3, 1e-6);
}

TEST(Adequacy, CountsNeitherLessScatterNorWhatMayLieAtAnEndNorWhatAReferenceTaught) {
  SearchRecord record;
  record.fits.resize(1);
  record.fits[0].shifts = {{"shear_coupling", 30.0, false}};
  record.scatter_deviations = {-30.0};
  EXPECT_EQ(adequacy_of(record, 0).conflict_p, 1.0);
  record.fits[0].shifts = {{"c1", 30.0, true}};
  EXPECT_LT(adequacy_of(record, 0).conflict_p, 1e-12);
  record.with_reference = true;
  EXPECT_EQ(adequacy_of(record, 0).conflict_p, 1.0);
}

// The 0.999 quantile of chi-square with ten degrees of freedom is 29.588.
TEST(Adequacy, AsksHowDrivesThatWereHeldOutAreTold) {
  SearchRecord record;
  record.windows = 10;
  record.with_reference = true;
  record.fits = {{.held_out_rms = std::sqrt(2.9588), .shifts = {}}, {.held_out_rms = 1.0, .shifts = {}}};
  EXPECT_NEAR(adequacy_of(record, 0).held_out_p, 1e-3, 1e-6);
  EXPECT_EQ(adequacy_of(record, 0).p(), adequacy_of(record, 0).held_out_p);
  EXPECT_GT(adequacy_of(record, 1).held_out_p, 0.4);
  // An effect that closes so much may leave more over, since its equation need not be the library's: here
  // 0.3 of 2, in deviations, beside the noise.
  record.fits[1].held_out_rms = std::sqrt(2.9588 * 1.36);
  record.fits[0].held_out_rms = record.fits[1].held_out_rms + 2.0;
  EXPECT_NEAR(adequacy_of(record, 1).held_out_p, 1e-3, 1e-6);
}

TEST(Calibration, GrowsWithProbabilityAndShareAndStaysWithinItsEnds) {
  for (const bool with_reference : {false, true}) {
    const Calibration& q = calibration(with_reference);
    EXPECT_LT(q(0.5, 0.5), q(0.9, 0.5));
    EXPECT_LT(q(0.9, 0.05), q(0.9, 0.5));
    EXPECT_GT(q(0.0, 0.01), 0.0);
    EXPECT_EQ(q(1.0, 0.0), 0.0) << "closes nothing";
    EXPECT_LT(q(1.0, 1.0), 1.0);
  }
}

// With q = 3/4, naming and not naming cost the same where a wrong name costs three missed ones.
TEST(Decision, NamesTheSetOfLeastExpectedLoss) {
  const SearchRecord record =
      record_of({{of({"com_offset"}), 0.7}, {of({"grousers"}), 0.25}, {of({}), 0.05}});
  const double q = decided(record).calibrated.at("com_offset");
  DecisionOptions options;
  options.missed_name = 1.0;
  options.wrong_name = q / (1.0 - q) * 0.99;
  EXPECT_EQ(decided(record, options).names, Names{"com_offset"});
  options.wrong_name = q / (1.0 - q) * 1.01;
  EXPECT_TRUE(decided(record, options).names.empty());
  EXPECT_EQ(decided(record, options).verdict, Verdict::kUnknown) << "something is missing all the same";
}

TEST(Decision, LeavesOutTheSecondEffectThatIsNotSure) {
  const SearchRecord record =
      record_of({{of({"com_offset", "grousers"}), 0.3}, {of({"com_offset"}), 0.69}, {of({}), 0.01}});
  const Decision d = decided(record);
  EXPECT_EQ(d.names, Names{"com_offset"});
  EXPECT_EQ(record.explanations[d.answer].effects, Names{"com_offset"});
  EXPECT_NEAR(d.set_probability, 0.69, 1e-12);
  EXPECT_EQ(d.verdict, Verdict::kEffects);
}

// An effect of 438 nats lost its name because it closed 4 % of the gap.
TEST(Decision, NamesWhatIsCertainThoughItClosesLittleAndNotWhatIsLikelyAndClosesNothing) {
  SearchRecord record = record_of({{of({"com_offset"}), 0.999}, {of({}), 0.001}});
  record.causes[0].share = 0.04;
  EXPECT_EQ(decided(record).names, Names{"com_offset"});
  SearchRecord likely = record_of({{of({"com_offset"}), 0.8}, {of({}), 0.2}});
  likely.causes[0].share = 0.0;
  EXPECT_TRUE(decided(likely).names.empty());
}

// What a reference taught leaves sets of effects on healthy drives that close nothing.
TEST(Decision, RaisesNoAlarmForEffectsThatCloseNothing) {
  SearchRecord record = record_of({{of({"com_offset"}), 0.4}, {of({"grousers"}), 0.4}, {of({}), 0.2}});
  record.with_reference = true;
  for (SearchRecord::Cause& cause : record.causes) cause.share = 0.02;
  EXPECT_TRUE(finds_nothing_missing(decided(record).verdict));
  for (SearchRecord::Cause& cause : record.causes) cause.share = 0.8;
  EXPECT_EQ(decided(record).verdict, Verdict::kUnknown);
}

TEST(Decision, SaysASetWhereWhatElseIsAtWorkIsOpen) {
  const Decision d = decided(record_of({{of({"com_offset", "grousers"}), 0.3},
                                        {of({"com_offset", "hardpan"}), 0.3},
                                        {of({"com_offset"}), 0.39},
                                        {of({}), 0.01}}));
  EXPECT_EQ(d.names, Names{"com_offset"});
  EXPECT_EQ(d.verdict, Verdict::kEffectSet);
}

TEST(Decision, IsPartialWhereSomethingUnknownBesideTheNamesIsMoreProbableThanNot) {
  const SearchRecord record =
      record_of({{of({"com_offset"}, true), 0.6}, {of({"com_offset"}), 0.39}, {of({}), 0.01}});
  const Decision d = decided(record);
  EXPECT_TRUE(d.partial);
  EXPECT_EQ(d.names, Names{"com_offset"});
  EXPECT_FALSE(record.explanations[d.answer].unknown()) << "the drives are corrected by the names alone";
  EXPECT_TRUE(record.explanations[d.beside].unknown());
}

TEST(Decision, ThatSomethingIsMissingWeighsAFalseAlarmAgainstAMissedOne) {
  const SearchRecord record = record_of({{of({}), 0.6}, {of({}, true), 0.4}});
  DecisionOptions options;
  EXPECT_EQ(decided(record, options).verdict, Verdict::kNoGap);
  options.missed_alarm = 1.6;
  EXPECT_EQ(decided(record, options).verdict, Verdict::kUnknown);
}

TEST(Decision, OfNothingMissingTellsParametersAndWhatCouldNotBeSeen) {
  SearchRecord record = record_of({{of({}), 0.9}, {of({}, true), 0.1}});
  record.parameters_gain = 10.0;  // 0.3 of it: 20 to 1
  EXPECT_EQ(decided(record).verdict, Verdict::kParameters);
  record.parameters_gain = 1.0;
  EXPECT_EQ(decided(record).verdict, Verdict::kNoGap);
  record.hidden_share = 0.6;
  EXPECT_EQ(decided(record).verdict, Verdict::kNotDetected);
}

TEST(Decision, SaysNothingIsMissingOnlyWhereTheDrivesDoNotSayThatTheyChanged) {
  SearchRecord record = record_of({{of({}), 0.9}, {of({}, true), 0.1}});
  record.drives_changed = true;
  EXPECT_EQ(decided(record).verdict, Verdict::kUnknown);
  EXPECT_TRUE(decided(record).names.empty());
}

// Another wheel law looks like several effects of the ground: they are one class there, and what is of the
// rover alone keeps its name.
TEST(Decision, NamesNoLawOfAllWheelsWhereTheWheelModelIsNotAdequate) {
  SearchRecord record =
      record_of({{of({"com_offset", "multipass"}), 0.98}, {of({"com_offset"}, true), 0.01}, {of({}), 0.01}});
  EXPECT_EQ(decided(record).names, (Names{"com_offset", "multipass"}));
  record.fits[0].shifts = {{"c1", 9.0, true}};
  const Decision d = decided(record);
  EXPECT_FALSE(d.adequate);
  EXPECT_EQ(d.names, Names{"com_offset"});
  EXPECT_TRUE(d.partial);
  EXPECT_NEAR(d.marginals.of_cause.at("multipass"), 0.98, 1e-12) << "probabilities stay what they are";
  record.explanations[0].effects = {"multipass"};
  EXPECT_EQ(decided(record).verdict, Verdict::kUnknown);
  EXPECT_NE(words_of(decided(record), record, {}, {}).reason.find("not adequate"), std::string::npos);
}

TEST(Decision, TellsWhichEffectsMayBeAnotherWheelLaw) {
  for (const char* const law : {"multipass", "gearbox_friction", "bulldozing", "slip_sinkage"})
    EXPECT_TRUE(may_be_wheel_law(law)) << law;
  for (const char* const other :
       {"dragging_wheel", "motor_temperature", "com_offset", "soft_patch", "force_on_body"})
    EXPECT_FALSE(may_be_wheel_law(other)) << other;
}

}  // namespace
}  // namespace slipway::gap
