#include "gap/diagnosis/search/selection.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "core/random.h"
#include "gap/diagnosis/model/noise_model.h"
#include "gap/diagnosis/verdict.h"
#include "tests/sim/reference_models.h"

namespace slipway::gap {
namespace {

Candidate candidate(std::vector<std::string> effects, double probability, bool with_unknown = false) {
  Candidate c;
  c.effects = std::move(effects);
  c.with_unknown = with_unknown;
  c.probability = probability;
  return c;
}

TEST(ChosenAmong, IsTheMostProbableOrASmallerSetWhereNoneIsCertain) {
  EXPECT_EQ(chosen_among(std::vector{candidate({"a", "b"}, 0.6), candidate({"a"}, 0.4)}), 0U);
  EXPECT_EQ(chosen_among(std::vector{candidate({"a", "b"}, 0.45), candidate({"a"}, 0.4)}), 1U);
  EXPECT_EQ(chosen_among(std::vector{candidate({"a", "b"}, 0.45), candidate({"a"}, 0.2)}), 0U);
  EXPECT_EQ(chosen_among(std::vector{candidate({"a", "b"}, 0.45), candidate({"c"}, 0.4)}), 0U);
}

TEST(ChosenAmong, IsSomethingUnknownWhereThatHasMoreThanHalfInAll) {
  EXPECT_EQ(chosen_among(
                std::vector{candidate({"a"}, 0.4), candidate({"b"}, 0.35, true), candidate({}, 0.25, true)}),
            1U);
  EXPECT_EQ(chosen_among(std::vector{candidate({"a"}, 0.6), candidate({}, 0.4, true)}), 0U);
}

// A weak side wall's resistance came as grousers of a probability of 0.3, beside something unknown of 0.4 and
// nothing of 0.15.
TEST(ChosenAmong, IsNoEffectThatIsLessProbableThanNoneOfTheLibraryInAll) {
  EXPECT_EQ(chosen_among(std::vector{candidate({}, 0.38, true), candidate({"a"}, 0.28), candidate({}, 0.15),
                                     candidate({"b"}, 0.15), candidate({"a", "b"}, 0.02)}),
            0U);
  EXPECT_EQ(chosen_among(std::vector{candidate({"a"}, 0.36), candidate({"a"}, 0.04, true),
                                     candidate({}, 0.25), candidate({}, 0.2, true), candidate({"b"}, 0.15)}),
            2U)
      << "the most probable of them";
  EXPECT_EQ(chosen_among(std::vector{candidate({"a"}, 0.4), candidate({}, 0.35), candidate({"b"}, 0.25)}),
            0U);
}

// A pull along the travel, and one that grows with speed and leans on the imprecision of any simulator.
TEST(BestForm, IsTheCauseFromOutsideThatTheFitAloneSpeaksFor) {
  const double alike_share = SelectionOptions{}.alike_form_share;
  DriveCampaign campaign;
  campaign.rover = std::make_shared<sim::RoverModel>(sim::six_wheeler());
  campaign.soils.resize(1);
  ExplanationSearch search;
  for (const double evidence : {-1000.0, -2640.0, -1967.0, -1500.0}) {
    search.fits.push_back({{}, Hypothesis(campaign, {})});
    search.fits.back().log_evidence = evidence;
  }
  const auto add = [&](std::vector<std::string> effects, double probability, std::size_t fit) {
    search.candidates.push_back(candidate(std::move(effects), probability));
    search.candidates.back().outside = true;
    search.candidates.back().fit = fit;
  };
  add({"pull_with_speed"}, 0.41, 1);
  add({"pull_along_travel"}, 0.40, 2);
  add({"pull_along_travel", "grousers"}, 0.35, 3);
  EXPECT_EQ(best_form(search, 0, alike_share), 1U) << "not the one with another effect beside it";
  EXPECT_EQ(best_form(search, 1, alike_share), 1U);
  search.candidates[1].probability = 0.2;
  EXPECT_EQ(best_form(search, 0, alike_share), 0U);
  search.candidates.push_back(candidate({}, 0.5, true));
  EXPECT_EQ(best_form(search, 3, alike_share), 3U) << "of no known form";
}

TEST(Weigh, BelievesAShareOfTheEvidenceAndNowAndThenATenthOfIt) {
  std::vector<Candidate> c{candidate({"a"}, 0.0), candidate({"b"}, 0.0)};
  c[0].log_evidence = 200.0;  // a tenth of the share leaves a little to the other
  c[0].log_prior = c[1].log_prior = std::log(0.5);
  weigh(c, EvidenceOptions{});
  EXPECT_NEAR(c[0].probability + c[1].probability, 1.0, 1e-12);
  EXPECT_GT(c[1].probability, 1e-4) << "no simulator is exact: one answer is never certain";
  EXPECT_LT(c[1].probability, 0.05);
  EvidenceOptions all_of_it;
  all_of_it.whole = true;
  c[0].log_evidence = std::log(3.0);
  weigh(c, all_of_it);
  EXPECT_NEAR(c[0].probability, 0.75, 1e-12) << "Bayes's theorem";
}

// A third more of it tells that something is missing, whichever it is.
TEST(Weigh, BelievesMoreOfTheEvidenceThatSomethingIsMissingThanOfWhichItIs) {
  std::vector<Candidate> c{candidate({}, 0.0), candidate({"a"}, 0.0), candidate({}, 0.0, true)};
  c[1].log_evidence = 9.0;
  c[2].log_evidence = 3.0;
  EvidenceOptions options;
  options.shares = {EvidenceShare{0.5, 1.0}};
  options.of_missing = 2.0;
  weigh(c, options);
  EXPECT_NEAR(std::log(c[1].probability / c[0].probability), 9.0, 1e-12);
  EXPECT_NEAR(std::log(c[1].probability / c[2].probability), 3.0, 1e-12);
  c[1].log_evidence = -2.0;
  c[2].log_evidence = -8.0;
  weigh(c, options);
  EXPECT_NEAR(std::log(c[1].probability / c[0].probability), -1.0, 1e-12) << "nothing is missing";
}

// Counting a group twice is having its rows twice.
TEST(GroupedEvidence, IsTheEvidenceOfTheDrivesAsOftenAsTheyCount) {
  constexpr Eigen::Index kRows = 9;
  const std::vector<std::size_t> group_of_row{0, 0, 1, 1, 1, 2, 0, 2, 1};
  const std::vector<int> times{2, 0, 1};
  Eigen::VectorXd r(kRows);
  Eigen::MatrixXd a(kRows, 2);
  for (Eigen::Index i = 0; i < kRows; ++i) {
    r[i] = random_normal(1, static_cast<std::uint64_t>(i));
    for (Eigen::Index c = 0; c < 2; ++c)
      a(i, c) = random_normal(2 + static_cast<std::uint64_t>(c), static_cast<std::uint64_t>(i));
  }
  const GroupedEvidence evidence(r, a, group_of_row, 3);
  EXPECT_NEAR(evidence.counted(std::vector<int>{1, 1, 1}), log_marginal(r, a), 1e-10);
  std::vector<Eigen::Index> rows;
  for (Eigen::Index i = 0; i < kRows; ++i)
    for (int k = 0; k < times[group_of_row[static_cast<std::size_t>(i)]]; ++k) rows.push_back(i);
  EXPECT_NEAR(evidence.counted(times),
              log_marginal(Eigen::VectorXd(r(rows)), Eigen::MatrixXd(a(rows, Eigen::all))), 1e-10);
}

// Healthy drives have columns of a discrepancy term that fit them a little better, too; with drives of
// another physics, and a reference, one of them came to 0.499.
TEST(Verdict, IsNotDetectedWhereSomethingUnknownMayBeChance) {
  DriveCampaign campaign;
  campaign.rover = std::make_shared<sim::RoverModel>(sim::six_wheeler());
  campaign.soils.resize(1);
  const DiagnosisOptions options;
  const auto judged = [&](double probability, double evidence) {
    ExplanationSearch search;
    search.fits.push_back({{}, Hypothesis(campaign, {})});
    search.candidates = {candidate({}, probability, true), candidate({}, 1.0 - probability)};
    search.candidates[0].log_evidence = evidence;
    Diagnosis d;
    judge(campaign, {}, search, {}, options, d);
    EXPECT_NE(d.reason.find(fmt::format("{:.2f}", probability)), std::string::npos) << d.reason;
    return d.verdict;
  };
  const double evidence = options.verdict.min_unknown_evidence,
               least = options.verdict.min_unknown_probability;
  EXPECT_EQ(judged(least + 0.01, evidence + 0.5), Verdict::kUnknown);
  EXPECT_EQ(judged(least + 0.01, evidence - 0.5), Verdict::kNotDetected);
  EXPECT_EQ(judged(least - 0.01, evidence + 0.5), Verdict::kNotDetected);
  EXPECT_EQ(judged(0.50, 25.8), Verdict::kNotDetected) << "healthy drives, 7311 s07";
}

// 7401 s11: motors that change with the temperature had a probability of 0.82 on drives whose soils
// were mis-set, and a quarter of the resampled campaigns showed nothing missing.
TEST(Verdict, IsNotDetectedWhereResampledDrivesOftenShowNothingMissing) {
  const auto judged = [](double nothing, bool partial) {
    Diagnosis d;
    d.verdict = Verdict::kEffects;
    d.partial = partial;
    d.effects.push_back({"motor_temperature", "", 0.82, {}});
    d.candidates.resize(3);
    d.candidates[0].effects = {"motor_temperature"};
    d.candidates[0].chosen_share = 0.97 - nothing;
    d.candidates[1].chosen_share = nothing;
    d.candidates[2].with_unknown = true;
    d.candidates[2].chosen_share = 0.03;
    judge_resamples({}, VerdictOptions{}, d);
    return d;
  };
  EXPECT_EQ(judged(0.08, false).verdict, Verdict::kEffects);
  EXPECT_EQ(judged(0.26, true).verdict, Verdict::kEffects) << "something is missing beside it";
  const Diagnosis chance = judged(0.26, false);
  EXPECT_EQ(chance.verdict, Verdict::kNotDetected);
  EXPECT_TRUE(chance.effects.empty());
  EXPECT_NE(chance.reason.find("26 %"), std::string::npos) << chance.reason;
  EXPECT_NE(chance.reason.find("motor_temperature"), std::string::npos) << chance.reason;
}

}  // namespace
}  // namespace slipway::gap
