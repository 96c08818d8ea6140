#include "gap/diagnosis/naming.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "gap/diagnosis/search/selection.h"

namespace slipway::gap {
namespace {

Candidate candidate(std::vector<std::string> effects, double probability, bool with_unknown = false,
                    bool outside = false) {
  Candidate c;
  c.effects = std::move(effects);
  c.probability = probability;
  c.with_unknown = with_unknown;
  c.outside = outside;
  return c;
}

ExplanationSearch search_of(std::vector<Candidate> candidates) {
  ExplanationSearch search;
  search.candidates = std::move(candidates);
  return search;
}

// Causes from outside close `outside` of the gap; every cause closes `of_rest` of what the others leave.
Naming named(const ExplanationSearch& search, const std::vector<EffectMarginal>& marginals,
             const VerdictOptions& options = {}, double outside = 1.0, double of_rest = 0.0,
             const Beliefs& beliefs = {[](const Candidate&) { return 0.0; },
                                       [](const Candidate&) { return false; }}) {
  const auto of_gap = [&](const std::string& cause) {
    for (const EffectMarginal& m : marginals)
      if (m.name == cause) return m.closed_share;
    return outside;
  };
  const CauseShares shares{of_gap, [=](const std::string&) { return of_rest; }};
  return name_effects(search, chosen_among(search.candidates), marginals, shares, beliefs, options);
}

const std::vector<std::string> kDrag{"dragging_wheel"};

// Hundreds of deviations large and in every explanation, with something else left over beside it.
TEST(Naming, DoesNotWithholdWhatIsInEveryExplanationAndClosesMost) {
  const ExplanationSearch search = search_of({candidate({"dragging_wheel"}, 0.5, true),
                                              candidate({"dragging_wheel", "hardpan"}, 0.3, true),
                                              candidate({"dragging_wheel"}, 0.199), candidate({}, 0.001)});
  const std::vector<EffectMarginal> marginals{{"dragging_wheel", 0.999, 0.93}, {"hardpan", 0.3, 0.02}};
  const Naming naming = named(search, marginals);
  EXPECT_EQ(naming.effects, kDrag);
  EXPECT_TRUE(naming.partial);
  EXPECT_EQ(naming.candidate, 0U);
  VerdictOptions old;
  old.name_by_marginals = false;
  EXPECT_TRUE(named(search, marginals, old).effects.empty()) << "an unknown cause hid all names";
}

TEST(Naming, NamesNothingBesideAnUnknownCauseThatIsUncertainOrClosesLittle) {
  const ExplanationSearch search =
      search_of({candidate({"dragging_wheel"}, 0.6, true), candidate({}, 0.3, true), candidate({}, 0.1)});
  EXPECT_TRUE(named(search, {{"dragging_wheel", 0.6, 0.9}}).effects.empty()) << "a shadow, perhaps";
  EXPECT_TRUE(named(search, {{"dragging_wheel", 0.99, 0.2}}).effects.empty()) << "most is something else";
  EXPECT_FALSE(named(search, {{"dragging_wheel", 0.99, 0.2}}).partial);
}

// Drives of another physics without a reference (7411 s01): a shifted load with a log evidence of 315 closed
// 31 %, beside a multipass that was another wheel law and something else.
TEST(Naming, NamesWhatHasStrongEvidenceAndIsNoLawOfAllWheelsBesideAnUnknownCause) {
  const auto names = [](const std::string& effect, double closed, double evidence) {
    const ExplanationSearch search =
        search_of({candidate({"multipass", effect}, 0.9, true), candidate({effect}, 0.1, true)});
    return named(search, {{"multipass", 0.9, 0.4, 500.0}, {effect, 0.85, closed, evidence}}).effects;
  };
  EXPECT_EQ(names("com_offset", 0.31, 63.0), std::vector<std::string>{"com_offset"});
  EXPECT_TRUE(names("com_offset", 0.31, 38.0).empty()) << "a shadow, perhaps";
  EXPECT_TRUE(names("com_offset", 0.09, 63.0).empty()) << "it closes next to nothing";
  EXPECT_TRUE(names("gearbox_friction", 0.31, 63.0).empty()) << "another law would look like it";
}

// 6201 s04: both effects of a pair were in all explanations, and something else besides.
TEST(Naming, NamesSeveralBesideAnUnknownCauseOfWhichEachClosesMostOfWhatTheOthersLeave) {
  const ExplanationSearch search =
      search_of({candidate({"gearbox_friction", "multipass"}, 0.56, true),
                 candidate({"gearbox_friction", "multipass"}, 0.44), candidate({}, 0.001)});
  const auto names = [&](double probability, double closed, double of_rest) {
    return named(search, {{"multipass", 1.0, 0.48}, {"gearbox_friction", probability, closed}}, {}, 1.0,
                 of_rest);
  };
  EXPECT_EQ(names(0.999, 0.40, 0.75).effects, (std::vector<std::string>{"gearbox_friction", "multipass"}));
  EXPECT_TRUE(names(0.999, 0.40, 0.75).partial);
  EXPECT_EQ(names(0.95, 0.08, 0.68).effects.size(), 2U);
  EXPECT_TRUE(names(0.89, 0.40, 0.75).effects.empty()) << "a shadow, perhaps";
  EXPECT_TRUE(names(0.999, 0.04, 0.75).effects.empty()) << "next to nothing";
  EXPECT_TRUE(names(0.999, 0.40, 0.45).effects.empty()) << "most of what is left is something else";
}

// Drives of another physics: currents scatter by 13 to 15 times what was believed, and another wheel law
// looks like a multi-pass effect. It was named beside a shifted load that is there.
TEST(Naming, NamesNoWheelLawBesideAnUnknownCauseWhereWhatWasChosenIsBentBeyondBelief) {
  const ExplanationSearch search =
      search_of({candidate({"com_offset", "multipass"}, 0.85, true), candidate({"com_offset"}, 0.1, true),
                 candidate({"multipass"}, 0.04, true), candidate({}, 0.01)});
  const auto names = [&](bool beyond) {
    const Beliefs beliefs{[](const Candidate&) { return 0.0; }, [=](const Candidate&) { return beyond; }};
    return named(search, {{"com_offset", 0.999, 0.32, 205.0}, {"multipass", 0.998, 0.38, 400.0}}, {}, 1.0,
                 0.6, beliefs);
  };
  EXPECT_EQ(names(false).effects, (std::vector<std::string>{"com_offset", "multipass"}));
  EXPECT_EQ(names(true).effects, std::vector<std::string>{"com_offset"});
  EXPECT_TRUE(names(true).partial);
}

TEST(Naming, LeavesOutWhatClosesNextToNothing) {
  const ExplanationSearch search = search_of(
      {candidate({"grousers", "hardpan"}, 0.8), candidate({"grousers"}, 0.15), candidate({}, 0.05)});
  const Naming naming = named(search, {{"grousers", 0.95, 0.9}, {"hardpan", 0.8, 0.02}});
  EXPECT_EQ(naming.effects, std::vector<std::string>{"grousers"});
  EXPECT_FALSE(naming.partial);
  EXPECT_EQ(naming.candidate, 1U) << "fitted without it";
  const Naming none = named(search, {{"grousers", 0.95, 0.01}, {"hardpan", 0.8, 0.02}});
  EXPECT_TRUE(none.effects.empty());
  EXPECT_EQ(none.candidate, 2U) << "the explanation in which nothing is missing";
}

// In four of four sealed pairs whose second effect was left out, the angle of greatest stress was 4.7 to 6.9
// deviations off without it (beside a motor that is weak in the cold a frontal wedge closed 0.1 and 3 %).
TEST(Naming, LeavesOutNothingThatAClosureWouldStandInFor) {
  const ExplanationSearch search = search_of({candidate({"motor_temperature", "bulldozing"}, 0.73),
                                              candidate({"motor_temperature"}, 0.2), candidate({}, 0.07)});
  const auto names = [&](double of_pair, double alone, double first_closes) {
    const std::vector<EffectMarginal> marginals{{"motor_temperature", 1.0, first_closes},
                                                {"bulldozing", 0.73, 0.03}};
    const Beliefs beliefs{[=](const Candidate& c) { return c.effects.size() == 2 ? of_pair : alone; },
                          [](const Candidate&) { return false; }};
    return named(search, marginals, {}, 1.0, 0.0, beliefs).effects.size();
  };
  EXPECT_EQ(names(1.0, 4.8, 0.77), 2U);
  EXPECT_EQ(names(1.0, 2.7, 0.77), 1U);
  EXPECT_EQ(names(4.5, 4.8, 0.77), 1U) << "it stands in for something else";
  EXPECT_EQ(names(1.0, 4.8, 0.03), 0U) << "together they close next to nothing";
}

// 5502 s26: a healthy campaign, of which a crust that closed 8 % had 17 of log evidence.
TEST(Naming, LeavesOutWhatClosesLittleAndHasLittleEvidence) {
  const auto names = [](double log_evidence, double closed) {
    std::vector<Candidate> candidates{candidate({"duricrust"}, 0.84), candidate({}, 0.16)};
    candidates[0].log_evidence = -300.0 + log_evidence;  // up to a constant
    candidates[1].log_evidence = -300.0;
    return named(search_of(candidates), {{"duricrust", 0.84, closed}}).effects.size();
  };
  EXPECT_EQ(names(17.0, 0.08), 0U);
  EXPECT_EQ(names(17.0, 0.11), 1U);
  EXPECT_EQ(names(60.0, 0.08), 1U) << "something is missing, if not this: the answer is doubted as a whole";
}

// 5501 s01: a multipass in every explanation stood beside a crust that was not there, and soils that both of
// them bent beyond belief took the names of both back.
TEST(Naming, OfWhatIsBentBeyondBeliefKeepsWhatIsAsGoodAsCertain) {
  const ExplanationSearch search = search_of(
      {candidate({"multipass", "duricrust"}, 0.85), candidate({"multipass"}, 0.14), candidate({}, 0.01)});
  const auto names = [&](double of_multipass, std::size_t bent_from) {
    const std::vector<EffectMarginal> marginals{{"multipass", of_multipass, 0.67}, {"duricrust", 0.9, 0.07}};
    const Beliefs beliefs{[](const Candidate&) { return 0.0; },
                          [=](const Candidate& c) { return c.effects.size() >= bent_from; }};
    return named(search, marginals, {}, 1.0, 0.0, beliefs).effects;
  };
  EXPECT_EQ(names(0.997, 2), std::vector<std::string>{"multipass"});
  EXPECT_EQ(names(0.997, 3).size(), 2U);
  EXPECT_EQ(names(0.98, 2).size(), 2U) << "none is certain: the answer is doubted as a whole";
  EXPECT_EQ(names(0.997, 1).size(), 2U) << "the wheel law is another: so is this";
}

// 7401 s06: a wheel that is smaller stood on soil 5.5 deviations off; cleats beside it, about as probable,
// leave the soil where it was believed to be.
TEST(Naming, TakesALargerSetThatBendsNothingWhereItIsAboutAsProbable) {
  const auto names = [](double of_pair, double grousers_close, std::size_t bent_below,
                        const std::string& second = "grousers") {
    const ExplanationSearch search =
        search_of({candidate({"wheel_radius"}, 0.45), candidate({"wheel_radius", second}, of_pair),
                   candidate({}, 0.01)});
    const std::vector<EffectMarginal> marginals{{"wheel_radius", 0.9, 0.72}, {second, 0.44, grousers_close}};
    const Beliefs beliefs{[](const Candidate&) { return 0.0; },
                          [=](const Candidate& c) { return c.effects.size() < bent_below; }};
    return named(search, marginals, {}, 1.0, 0.0, beliefs).effects;
  };
  EXPECT_EQ(names(0.38, 0.38, 2), (std::vector<std::string>{"wheel_radius", "grousers"}));
  EXPECT_EQ(names(0.20, 0.38, 2), std::vector<std::string>{"wheel_radius"}) << "less than half as probable";
  EXPECT_EQ(names(0.38, 0.01, 2), std::vector<std::string>{"wheel_radius"}) << "cleats close next to nothing";
  EXPECT_EQ(names(0.38, 0.38, 3), std::vector<std::string>{"wheel_radius"}) << "that bends the soil, too";
  EXPECT_EQ(names(0.38, 0.38, 1), std::vector<std::string>{"wheel_radius"}) << "nothing is bent";
  EXPECT_EQ(names(0.38, 0.38, 2, "soft_patch"), std::vector<std::string>{"wheel_radius"})
      << "the soil beside a patch is not asked how far off it is";
}

// 7501 s24: soil that weakens with slip, by another equation, left 5 % of the gap where the rover slipped
// most, which came as a patch of 0.75 m. A patch beside motors that change with the temperature closes as
// little.
TEST(Naming, OfAPatchBesideALawOfTheGroundAsksForAShareOfWhatThatCloses) {
  const auto names = [](const std::string& law, double of_patch) {
    const ExplanationSearch search =
        search_of({candidate({law, "soft_patch"}, 0.84), candidate({law}, 0.1), candidate({}, 0.06)});
    return named(search, {{law, 0.9, 0.92}, {"soft_patch", 0.84, of_patch}}).effects.size();
  };
  EXPECT_EQ(names("slip_sinkage", 0.052), 1U);
  EXPECT_EQ(names("slip_sinkage", 0.09), 2U);
  EXPECT_EQ(names("motor_temperature", 0.07), 2U);
}

// Where the wheel law was another one (5701 s01, level L3) a wheel that drags stood beside a multipass that
// the key does not have, on soils that both of them bent.
TEST(Naming, OfAnotherWheelLawKeepsWhatIsNoLawOfAllWheels) {
  const ExplanationSearch search =
      search_of({candidate({"dragging_wheel", "multipass"}, 0.99), candidate({"dragging_wheel"}, 0.01)});
  const Beliefs bent{[](const Candidate&) { return 0.0; }, [](const Candidate&) { return true; }};
  EXPECT_EQ(named(search, {{"dragging_wheel", 1.0, 0.58, 150.0}, {"multipass", 1.0, 0.19, 90.0}}, {}, 1.0,
                  0.0, bent)
                .effects,
            kDrag);
}

TEST(Naming, AnotherWheelLawMayBeAnyLawThatAllWheelsHave) {
  for (const char* law : {"slip_sinkage", "multipass", "grousers", "bulldozing", "side_bulldozing",
                          "duricrust", "hardpan", "rate_shear", "gearbox_friction"})
    EXPECT_TRUE(may_be_wheel_law(law)) << law;
  for (const char* other : {"motor_temperature", "soft_patch", "dragging_wheel", "com_offset", "wheel_radius",
                            "steering_offset", "attitude_bias", "tether"})
    EXPECT_FALSE(may_be_wheel_law(other)) << other;
}

// What a wrong equation of one soil law leaves, another may mimic. A larger radius mimics no soil law, and a
// shifted load has no other equation: beside it, what explains the little that is left is there.
TEST(Naming, KeepsAWeakEffectWhereEitherOfTheTwoHasOneForm) {
  const auto names_both = [](const std::string& first, const std::string& second, double of_gap,
                             double of_rest) {
    const ExplanationSearch search = search_of({candidate({first, second}, 0.7), candidate({first}, 0.3)});
    return named(search, {{first, 1.0, 0.9}, {second, 0.7, of_gap}}, {}, 1.0, of_rest).effects.size() == 2;
  };
  EXPECT_TRUE(names_both("grousers", "wheel_radius", 0.02, 0.2));
  EXPECT_FALSE(names_both("grousers", "wheel_radius", 0.02, 0.04));
  EXPECT_TRUE(names_both("com_offset", "slip_sinkage", 0.0001, 0.1));
  EXPECT_FALSE(names_both("com_offset", "slip_sinkage", 0.0001, 0.04));
  EXPECT_FALSE(names_both("multipass", "duricrust", 0.04, 0.3));
  EXPECT_FALSE(names_both("multipass", "duricrust", 0.07, 0.3))
      << "of the 0.9 of multipass, 0.08 may be its form";
  EXPECT_TRUE(names_both("multipass", "duricrust", 0.09, 0.0));
  EXPECT_FALSE(names_both("com_offset", "pull_along_travel", 0.02, 0.3)) << "not a cause from outside";
}

TEST(Naming, TakesTheParametersFromTheExplanationWithTheForceAndCorrectsByTheEffectAlone) {
  const ExplanationSearch search = search_of(
      {candidate({"pull_along_travel", "motor_temperature"}, 0.9, false, true),
       candidate({"motor_temperature"}, 0.06), candidate({"pull_along_travel"}, 0.04, false, true)});
  const Naming naming = named(search, {{"motor_temperature", 0.96, 0.7}});
  EXPECT_EQ(naming.effects, std::vector<std::string>{"motor_temperature"});
  EXPECT_TRUE(naming.partial);
  EXPECT_EQ(naming.candidate, 0U);
  EXPECT_EQ(naming.correction, 1U);
}

// Headings that read too little came as a larger wheel (0.72) beside distances that read too much; a load
// that the library could not name as an attitude bias (0.98) beside a push.
TEST(Naming, BesideACauseOfKnownFormNamesWhatIsAsGoodAsCertainThoughItClosesLess) {
  const auto named_at = [](double probability, bool known_form) {
    const ExplanationSearch search =
        search_of({known_form ? candidate({"push_on_map", "gearbox_friction"}, probability, false, true)
                              : candidate({"gearbox_friction"}, probability, true),
                   known_form ? candidate({"push_on_map"}, 1.0 - probability, false, true)
                              : candidate({}, 1.0 - probability, true)});
    return named(search, {{"gearbox_friction", probability, 0.21}}).effects.size();
  };
  EXPECT_EQ(named_at(0.995, true), 1U);
  EXPECT_EQ(named_at(0.98, true), 0U) << "it may be the shadow of what the library lacks";
  EXPECT_EQ(named_at(0.995, false), 0U) << "what is left has no form";
}

TEST(Naming, BesideACauseOfKnownFormNamesWhatIsMoreProbableThanNotAndClosesMost) {
  const ExplanationSearch search = search_of({candidate({"pull_with_slope", "bulldozing"}, 0.55, false, true),
                                              candidate({"pull_with_slope"}, 0.45, false, true)});
  EXPECT_EQ(named(search, {{"bulldozing", 0.55, 0.8}}).effects, std::vector<std::string>{"bulldozing"});
  EXPECT_TRUE(named(search, {{"bulldozing", 0.55, 0.4}}).effects.empty()) << "it closes less than half";
  EXPECT_TRUE(named(search, {{"bulldozing", 0.45, 0.8}}).effects.empty()) << "it is less probable than not";
}

// Soil that weakens with slip, beside currents that drift (7504 s01): the drift closes 72 % of the gap, and
// the soil 87 % of what that leaves. An attitude bias beside a push had looked like a load that was withheld.
TEST(Naming, BesideACauseOfKnownFormNamesALawThatClosesMostOfWhatThatLeaves) {
  const auto names = [](const std::string& effect, double closed, double of_rest, bool bent = false) {
    const ExplanationSearch search = search_of({candidate({effect, "current_drift"}, 0.88, false, true),
                                                candidate({"current_drift"}, 0.12, false, true)});
    const Beliefs beliefs{[](const Candidate&) { return 0.0; }, [=](const Candidate&) { return bent; }};
    return named(search, {{effect, 0.88, closed}}, {}, 0.7, of_rest, beliefs).effects.size();
  };
  EXPECT_EQ(names("slip_sinkage", 0.26, 0.87), 1U);
  EXPECT_EQ(names("slip_sinkage", 0.26, 0.17), 0U) << "most of what the drift leaves is something else";
  EXPECT_EQ(names("slip_sinkage", 0.04, 0.87), 0U) << "it closes next to nothing";
  EXPECT_EQ(names("slip_sinkage", 0.26, 0.87, true), 0U) << "the wheel law is another one";
  EXPECT_EQ(names("attitude_bias", 0.26, 0.87), 0U) << "it may be the shadow of what the library lacks";
}

TEST(Naming, LeavesOutACauseFromOutsideThatClosesNextToNothingBesideEffects) {
  const ExplanationSearch search = search_of({candidate({"soft_patch", "soil_drift"}, 0.52, false, true),
                                              candidate({"soft_patch"}, 0.41), candidate({}, 0.07)});
  const std::vector<EffectMarginal> marginals{{"soft_patch", 0.93, 0.9}};
  EXPECT_EQ(named(search, marginals, {}, 0.04).chosen, 1U);
  EXPECT_FALSE(named(search, marginals, {}, 0.04).partial);
  EXPECT_EQ(named(search, marginals, {}, 0.06).chosen, 0U);
  EXPECT_TRUE(named(search, marginals, {}, 0.06).partial);
  const ExplanationSearch alone =
      search_of({candidate({"soil_drift"}, 0.9, false, true), candidate({}, 0.1)});
  EXPECT_EQ(named(alone, {}, {}, 0.0).chosen, 0U) << "nothing else says what is there";
}

TEST(Naming, OfACauseFromOutsideAloneIsNone) {
  const ExplanationSearch search = search_of(
      {candidate({"pull_along_travel"}, 0.7, false, true), candidate({"com_offset", "grousers"}, 0.3)});
  EXPECT_EQ(library_effects_of(search.candidates[0]), std::vector<std::string>{});
  EXPECT_EQ(outside_causes_of(search.candidates[0]), std::vector<std::string>{"pull_along_travel"});
  EXPECT_TRUE(named(search, {{"com_offset", 0.3, 0.6}, {"grousers", 0.3, 0.3}}).effects.empty());
}

}  // namespace
}  // namespace slipway::gap
