#include "research/benchmark/benchmark_score.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "research/benchmark/benchmark_figures.h"

namespace slipway::gap {
namespace {

const std::set<std::string> kLibrary{"bulldozing", "hardpan", "soft_patch"};

HiddenAnswer hidden(std::set<std::string> effects) {
  HiddenAnswer answer;
  answer.campaign = "s01";
  answer.effects = std::move(effects);
  return answer;
}

Diagnosis found(Verdict verdict, std::vector<std::string> effects, double probability) {
  Diagnosis d;
  d.verdict = verdict;
  for (const std::string& name : effects) d.effects.push_back({name, "", probability, {}});
  d.candidates.push_back({effects, probability, std::nullopt, 0, 0.0, verdict == Verdict::kUnknown});
  d.candidates.push_back({{}, 1.0 - probability, std::nullopt, 0});
  return d;
}

TEST(BenchmarkScore, TheVerySetUnderAVerdictOfItsClassIsExact) {
  const CaseScore right =
      score_case(hidden({"hardpan"}), found(Verdict::kEffects, {"hardpan"}, 0.8), kLibrary, 1.0);
  EXPECT_TRUE(right.exact && right.alike && right.verdict_right && right.held);
  EXPECT_NEAR(right.stated, 0.8, 1e-12);
  const CaseScore wrong =
      score_case(hidden({"hardpan"}), found(Verdict::kEffects, {"bulldozing"}, 0.95), kLibrary, 1.0);
  EXPECT_FALSE(wrong.exact || wrong.alike || wrong.held);
  EXPECT_TRUE(wrong.verdict_right && wrong.confident_wrong);
  // The right names beside something else are not the right answer.
  const CaseScore besides =
      score_case(hidden({"hardpan"}), found(Verdict::kUnknown, {"hardpan"}, 0.95), kLibrary, 1.0);
  EXPECT_FALSE(besides.exact || besides.confident_wrong);
  EXPECT_NEAR(besides.unknown_probability, 0.95, 1e-12);
}

TEST(BenchmarkScore, ALookAlikeCountsWhereTheTruthIsSecondAndTheAngleIsSmall) {
  Diagnosis d = found(Verdict::kEffects, {"bulldozing"}, 0.6);
  d.candidates[1] = {{"hardpan"}, 0.4, std::nullopt, 0};
  EXPECT_FALSE(score_case(hidden({"hardpan"}), d, kLibrary, 1.0).alike);
  d.confusable.push_back({"bulldozing", "hardpan", 12.0});
  EXPECT_TRUE(score_case(hidden({"hardpan"}), d, kLibrary, 1.0).alike);
  d.confusable.front().angle_deg = 29.0;
  EXPECT_FALSE(score_case(hidden({"hardpan"}), d, kLibrary, 1.0).alike);
  d.verdict = Verdict::kEffectSet;
  EXPECT_TRUE(score_case(hidden({"hardpan"}), d, kLibrary, 1.0).alike);
}

TEST(BenchmarkScore, NothingMissingIsNoAlarmWhicheverWayItIsSaid) {
  for (const Verdict verdict : {Verdict::kNoGap, Verdict::kNotDetected, Verdict::kParameters})
    EXPECT_FALSE(score_case(hidden({}), found(verdict, {}, 0.9), kLibrary, 1.0).false_alarm);
  EXPECT_TRUE(score_case(hidden({}), found(Verdict::kUnknown, {}, 0.9), kLibrary, 1.0).false_alarm);
  EXPECT_TRUE(
      score_case(hidden({}), found(Verdict::kEffectSet, {"hardpan"}, 0.4), kLibrary, 1.0).false_alarm);
}

TEST(BenchmarkScore, ACauseThatNoLibraryHasIsRightAsUnknown) {
  const CaseScore right = score_case(hidden({"tether"}), found(Verdict::kUnknown, {}, 0.9), kLibrary, 1.0);
  EXPECT_TRUE(right.exact && right.verdict_right);
  EXPECT_EQ(right.truth_kind, TruthKind::kOutsideLibrary);
  EXPECT_EQ(right.truth, "tether");
  const CaseScore wrong =
      score_case(hidden({"tether"}), found(Verdict::kEffects, {"hardpan"}, 0.99), kLibrary, 1.0);
  EXPECT_TRUE(!wrong.exact && wrong.confident_wrong);
}

TEST(BenchmarkScore, APartialAnswerHasTheRightNamesAndIsExactWhereSomethingIsBeside) {
  Diagnosis d = found(Verdict::kEffects, {"hardpan"}, 0.95);
  d.partial = true;
  d.candidates[0].with_unknown = true;
  const CaseScore alone = score_case(hidden({"hardpan"}), d, kLibrary, 1.0);
  EXPECT_TRUE(alone.partial && alone.names_right && !alone.exact && !alone.wrong_name);
  const CaseScore beside = score_case(hidden({"hardpan", "tether"}), d, kLibrary, 1.0);
  EXPECT_TRUE(beside.exact && beside.names_right && beside.verdict_right);
  const CaseScore shadow = score_case(hidden({"tether"}), d, kLibrary, 1.0);
  EXPECT_TRUE(shadow.wrong_name && !shadow.names_right && !shadow.verdict_right);
  const BenchmarkFigures f = figures_of(std::vector{alone, beside, shadow});
  EXPECT_EQ(f.wrong_name.hits, 1U);
  EXPECT_EQ(f.wrong_name.of, 3U);
  EXPECT_EQ(f.names_right.hits, 1U) << "of campaigns with effects of the library alone";
  EXPECT_EQ(f.outside_unnamed.hits, 1U);
  EXPECT_EQ(f.outside_unnamed.of, 2U);
}

TEST(BenchmarkScore, MarginalsAreRightWhereTheEffectIsHidden) {
  Diagnosis d = found(Verdict::kEffects, {"hardpan"}, 0.95);
  d.marginals = {{"hardpan", 0.95, 0.8}, {"bulldozing", 0.92, 0.1}, {"soft_patch", 0.0, 0.0}};
  const std::vector<ReliabilityBin> bins =
      figures_of(std::vector{score_case(hidden({"hardpan"}), d, kLibrary, 1.0)}).reliability;
  ASSERT_EQ(bins.size(), 10U);
  EXPECT_EQ(bins[9].right.of, 2U);
  EXPECT_EQ(bins[9].right.hits, 1U);
  EXPECT_NEAR(bins[9].mean_probability, 0.935, 1e-12);
  EXPECT_EQ(bins[0].right.of, 1U);
  EXPECT_EQ(bins[0].right.hits, 0U);
}

TEST(BenchmarkScore, ParametersAreALookAlikeWhereTheDiagnosisSaysSo) {
  Diagnosis d = found(Verdict::kParameters, {}, 0.9);
  EXPECT_FALSE(score_case(hidden({"hardpan"}), d, kLibrary, 1.0).alike);
  d.look_alikes.push_back({"hardpan", "parameters", {"stiffness"}, 4.0});
  EXPECT_TRUE(score_case(hidden({"hardpan"}), d, kLibrary, 1.0).alike);
  EXPECT_FALSE(score_case(hidden({"hardpan", "bulldozing"}), d, kLibrary, 1.0).alike) << "not the second";
  EXPECT_TRUE(
      score_withheld(hidden({"hardpan"}), "hardpan", d, found(Verdict::kParameters, {}, 0.9)).right());
}

TEST(BenchmarkScore, AnEffectOfOneWheelIsFoundAtThatWheelOrNot) {
  HiddenAnswer answer = hidden({"hardpan"});
  Diagnosis d = found(Verdict::kEffects, {"hardpan"}, 0.9);
  EXPECT_FALSE(score_case(answer, d, kLibrary, 1.0).wheel_right);
  answer.wheel_of["hardpan"] = 2.0;
  d.effects[0].parameters.push_back({"wheel", {2.0, 2.0, 2.0}});
  EXPECT_EQ(score_case(answer, d, kLibrary, 1.0).wheel_right, true);
  d.effects[0].parameters[0].value.value = 3.0;
  EXPECT_EQ(score_case(answer, d, kLibrary, 1.0).wheel_right, false);
}

// What is unknown may have anything beside it: its probability is that of all sets with it.
TEST(BenchmarkScore, AStatedProbabilityIsThatOfWhatIsSaid) {
  Diagnosis d = found(Verdict::kUnknown, {"hardpan"}, 0.6);
  d.effects.clear();
  d.candidates[1].with_unknown = true;
  EXPECT_NEAR(score_case(hidden({"tether"}), d, kLibrary, 1.0).stated, 1.0, 1e-12);
  // A smaller set than the most probable one.
  Diagnosis smaller = found(Verdict::kEffectSet, {"hardpan"}, 0.3);
  smaller.candidates.insert(smaller.candidates.begin(), {{"bulldozing", "hardpan"}, 0.45, std::nullopt, 0});
  EXPECT_NEAR(score_case(hidden({"hardpan"}), smaller, kLibrary, 1.0).stated, 0.3, 1e-12);
}

TEST(BenchmarkScore, WithheldEffectsBecomeUnknownOrALookAlike) {
  Diagnosis open = found(Verdict::kEffects, {"hardpan"}, 0.9);
  open.confusable.push_back({"bulldozing", "hardpan", 10.0});
  const HiddenAnswer answer = hidden({"hardpan"});
  EXPECT_TRUE(score_withheld(answer, "hardpan", open, found(Verdict::kUnknown, {}, 0.9)).unknown);
  EXPECT_TRUE(
      score_withheld(answer, "hardpan", open, found(Verdict::kEffects, {"bulldozing"}, 0.9)).look_alike);
  EXPECT_FALSE(
      score_withheld(answer, "hardpan", open, found(Verdict::kEffects, {"soft_patch"}, 0.9)).right());
  EXPECT_TRUE(score_withheld(answer, "hardpan", open, found(Verdict::kParameters, {}, 0.9)).absorbed);
}

// Of a pair of which one is withheld, the other is still to be named.
TEST(BenchmarkScore, APartialAnswerBesideAWithheldEffectNamesTheOther) {
  const Diagnosis open = found(Verdict::kEffects, {"hardpan", "bulldozing"}, 0.9);
  const HiddenAnswer pair = hidden({"hardpan", "bulldozing"});
  Diagnosis other = found(Verdict::kEffects, {"bulldozing"}, 0.95), wrong = other;
  EXPECT_FALSE(score_withheld(pair, "hardpan", open, other).unknown) << "as if nothing else were there";
  other.partial = true;
  EXPECT_TRUE(score_withheld(pair, "hardpan", open, other).unknown);
  wrong.effects.front().name = "soft_patch";
  wrong.partial = true;
  EXPECT_FALSE(score_withheld(pair, "hardpan", open, wrong).right());
}

// Against the tables of Clopper and Pearson: a tail of 5 % on either side.
TEST(BinomialInterval, IsClopperAndPearsons) {
  const RateInterval half = binomial_interval({5, 10});
  EXPECT_NEAR(half.low, 0.22244, 1e-5);
  EXPECT_NEAR(half.high, 0.77756, 1e-5);
  const RateInterval none = binomial_interval({0, 20});
  EXPECT_EQ(none.low, 0.0);
  EXPECT_NEAR(none.high, 1.0 - std::pow(0.05, 1.0 / 20.0), 1e-9);
  const RateInterval all = binomial_interval({20, 20});
  EXPECT_NEAR(all.low, std::pow(0.05, 1.0 / 20.0), 1e-9);
  EXPECT_EQ(all.high, 1.0);
}

TEST(AreaUnderRoc, IsOneWhereAllAreAboveAndAHalfWhereTheyAreAlike) {
  const std::vector<double> high{0.8, 0.9}, low{0.1, 0.2, 0.3};
  EXPECT_EQ(area_under_roc(high, low), 1.0);
  EXPECT_EQ(area_under_roc(low, high), 0.0);
  EXPECT_EQ(area_under_roc(high, high), 0.5);
  EXPECT_FALSE(area_under_roc(high, {}));
}

TEST(CalibrationError, IsTheDistanceOfWhatIsSaidFromWhatIs) {
  const std::vector<Statement> honest{{0.75, true}, {0.75, true}, {0.75, true}, {0.75, false}};
  EXPECT_NEAR(*calibration_error(honest), 0.0, 1e-12);
  EXPECT_NEAR(*brier_score(honest), 0.1875, 1e-12);
  const std::vector<Statement> boastful{{0.95, false}, {0.95, true}};
  EXPECT_NEAR(*calibration_error(boastful), 0.45, 1e-12);
}

TEST(DiscOverlap, IsIntersectionOverUnion) {
  EXPECT_NEAR(disc_overlap({0, 0, 2}, {0, 0, 2}), 1.0, 1e-12);
  EXPECT_NEAR(disc_overlap({0, 0, 2}, {0.5, 0, 1}), 0.25, 1e-12);
  EXPECT_EQ(disc_overlap({0, 0, 1}, {2, 0, 1}), 0.0);
  const double common = 2.0 * std::numbers::pi / 3.0 - std::sqrt(3.0) / 2.0;  // unit circles, one apart
  EXPECT_NEAR(disc_overlap({0, 0, 1}, {1, 0, 1}), common / (2.0 * std::numbers::pi - common), 1e-12);
}

TEST(BenchmarkFigures, CountsEachKindOfTruthByItself) {
  std::vector<CaseScore> cases;
  cases.push_back(score_case(hidden({"hardpan"}), found(Verdict::kEffects, {"hardpan"}, 0.8), kLibrary, 2.0));
  cases.back().closed_fraction = 0.6;
  cases.back().oracle_closed_fraction = 0.8;
  HiddenAnswer small = hidden({"bulldozing"});
  small.size = 0.5;
  cases.push_back(score_case(small, found(Verdict::kNotDetected, {}, 0.8), kLibrary, 4.0));
  cases.back().oracle_closed_fraction = 0.5;
  cases.push_back(score_case(hidden({"tether"}), found(Verdict::kUnknown, {}, 0.9), kLibrary, 6.0));
  HiddenAnswer shift = hidden({});
  shift.nominal_off = true;
  cases.push_back(score_case(shift, found(Verdict::kEffects, {"hardpan"}, 0.5), kLibrary, 8.0));
  const BenchmarkFigures f = figures_of(cases);
  EXPECT_EQ(f.exact.of, 2u);
  EXPECT_EQ(f.exact.hits, 1u);
  EXPECT_EQ(f.exact_sized.of, 1u);
  EXPECT_EQ(f.alarm_nothing.of, 0u);
  EXPECT_EQ(f.alarm_parameters.hits, 1u);
  EXPECT_EQ(f.unknown_auroc, 1.0);
  EXPECT_EQ(f.seconds, 5.0);
  EXPECT_NEAR(f.closed_of_oracle.value_or(-1.0), 0.5 * (0.6 / 0.8 + 0.0), 1e-12)
      << "nothing named closes nothing";
  EXPECT_EQ(confusion_of(cases)["parameters"]["hardpan"], 1);
}

}  // namespace
}  // namespace slipway::gap
