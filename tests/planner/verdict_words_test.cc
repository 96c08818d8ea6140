// What is said of a verdict: numbers with the digits that they take, and causes, places and grounds by name.
#include "planner/judge/verdict_words.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "core/angle.h"
#include "tests/planner/ground_fixture.h"

namespace slipway::planner {
namespace {

using sim::Rule;

TEST(VerdictWords, AShareHasTheDigitsThatItTakes) {
  EXPECT_EQ(percent(0.0), "0 %");
  EXPECT_EQ(percent(0.0004), "0.04 %");
  EXPECT_EQ(percent(0.042), "4.2 %");
  EXPECT_EQ(percent(0.12), "12 %");
  EXPECT_EQ(percent(0.199, 0.2), "19.9 %") << "near its bar";
  EXPECT_EQ(percent(0.0101, 0.01), "1.01 %");
  EXPECT_EQ(percent(0.3, 0.2), "30 %");
  EXPECT_EQ(percent(0.0, 0.2), "0 %");
}

sim::DrivePrediction drive_at(double pitch_deg, double roll_deg) {
  sim::DrivePrediction drive;
  drive.wheel_names = {"lf", "rf"};
  sim::StationPrediction at;
  at.station.pose = {10.0, 10.0, 0.0};
  at.station.distance_m = 5.0;
  at.attitude.pitch_rad = rad_from_deg(pitch_deg);
  at.attitude.roll_rad = rad_from_deg(roll_deg);
  at.soil = 0;
  drive.stations = {at};
  return drive;
}

sim::RuleRisk risk_of(Rule rule) {
  sim::RuleRisk risk;
  risk.rule = rule;
  return risk;
}

TEST(VerdictWords, TheCauseIsHowTheGroundTiltsTheRover) {
  const sim::RuleRisk slip = risk_of(Rule::kSlipCheck);
  EXPECT_EQ(cause_of(slip, drive_at(-8.0, 0.0)), "climb");
  EXPECT_EQ(cause_of(slip, drive_at(-8.0, 9.0)), "cross_slope");
  EXPECT_EQ(cause_of(slip, drive_at(2.0, 1.0)), "soil");
  EXPECT_EQ(cause_of(slip, drive_at(8.0, 0.0)), "soil") << "down is no reason to slip";
  EXPECT_EQ(cause_of(risk_of(Rule::kTilt), drive_at(3.0, 0.0)), "descent");
  EXPECT_EQ(cause_of(risk_of(Rule::kTilt), drive_at(-3.0, 1.0)), "climb")
      << "the ground's shape, however flat";
  sim::DrivePrediction backwards = drive_at(8.0, 0.0);
  backwards.stations[0].station.backwards = true;
  EXPECT_EQ(cause_of(slip, backwards), "climb");
  EXPECT_EQ(cause_of(risk_of(Rule::kSinkage), drive_at(-8.0, 0.0)), "load") << "always";
  EXPECT_EQ(cause_of(slip, {}), "soil") << "nothing is known of the place";
}

sim::RuleRisk risk_of(Rule rule, double from_m, double to_m) {
  sim::RuleRisk risk = risk_of(rule);
  risk.limit = 0.4;
  risk.value = {0.1, 0.2, 0.3};
  risk.trips.share = 0.25;
  risk.from_m = from_m;
  risk.to_m = to_m;
  return risk;
}

TEST(VerdictWords, AHaltIsToldByItsRuleItsPlaceItsGroundAndItsCause) {
  PlanProblem problem = problem_on(20, 20, 1.0, 1.0, [](double, double) { return 0.0; });
  sim::DrivePrediction drive = drive_at(-8.0, 0.0);
  const auto words = [&](const sim::RuleRisk& risk) { return halt_words(problem, drive, risk); };
  const std::string at_place = ", most at 5.0 m, (10.0, 10.0), on firm (class a), because of the climb";
  sim::RuleRisk slip = risk_of(Rule::kSlipCheck, 3.0, 8.2);
  EXPECT_EQ(words(slip), "slip 0.2, limit 0.4 from 3.0 to 8.2 m" + at_place) << "the median of all draws";
  slip.tripping = {0.5, 0.57, 0.6};
  EXPECT_EQ(words(slip), "slip 0.57, limit 0.4 from 3.0 to 8.2 m" + at_place) << "of those that trip";
  EXPECT_EQ(words(risk_of(Rule::kImmobilised, 3.0, 3.05)), "the ground holds the rover at 3.0 m" + at_place);
  sim::RuleRisk current = risk_of(Rule::kCurrent, 3.0, 3.0);
  current.wheel = 1;
  EXPECT_EQ(words(current), "current of wheel rf 0.2 A, limit 0.4 A at 3.0 m" + at_place);
  drive.stations[0].attitude.pitch_rad = 0.0;
  EXPECT_TRUE(words(slip).ends_with("because of the soil"));
  EXPECT_TRUE(words(risk_of(Rule::kSinkage, 3.0, 3.0)).ends_with("because of the load on the wheel"));
  drive.stations[0].attitude.pitch_rad = 0.2;
  EXPECT_TRUE(words(risk_of(Rule::kTilt, 3.0, 3.0)).ends_with("because of the descent"));
  drive.stations[0].attitude.roll_rad = 0.3;
  EXPECT_TRUE(words(slip).ends_with("because of a cross slope"));
  slip.station = 7;  // beyond what was predicted
  EXPECT_EQ(words(slip), "slip 0.57, limit 0.4 from 3.0 to 8.2 m, because of a cross slope");
}

TEST(VerdictWords, TheMainHaltIsToldWhereMostDrawsHalt) {
  const PlanProblem problem = problem_on(20, 20, 1.0, 1.0, [](double, double) { return 0.0; });
  sim::DrivePrediction drive = drive_at(0.0, 0.0);
  EXPECT_EQ(worst_station(drive), nullptr);
  EXPECT_EQ(main_halt(drive), nullptr);
  drive.outcomes.rules = {risk_of(Rule::kTilt, 3.0, 8.0)};
  EXPECT_EQ(main_halt(drive), nullptr) << "it trips and halts nothing";
  drive.outcomes.rules[0].halts = 0.2;
  drive.stations.push_back(drive.stations[0]);
  drive.stations[1].station.distance_m = 6.0;
  drive.stations[1].stops = 0.2;
  EXPECT_NE(halt_words(problem, drive, drive.outcomes.rules[0]).find("most at 6.0 m"), std::string::npos);
  EXPECT_EQ(worst_station({}), nullptr);
}

TEST(VerdictWords, GroundThatNoMapNamesIsToldByItsClassWhereItHasOne) {
  PlanProblem problem = problem_on(20, 20, 1.0, 1.0, [](double, double) { return 0.0; });
  sim::DrivePrediction drive = drive_at(0.0, 0.0);
  const auto words = [&] { return halt_words(problem, drive, risk_of(Rule::kTilt, 3.0, 3.0)); };
  drive.stations[0].on_unknown_ground = true;
  drive.stations.push_back(drive.stations[0]);  // a label is told once
  EXPECT_NE(words().find("on ground of unknown soil (class a)"), std::string::npos) << words();
  problem.soil_map = nullptr;
  EXPECT_NE(words().find("on unmapped ground"), std::string::npos) << words();
  drive.stations[0].on_unknown_ground = drive.stations[1].on_unknown_ground = false;
  EXPECT_NE(words().find("on firm,"), std::string::npos) << words();
}

TEST(VerdictWords, AClassOfTheSoilsOwnNameIsNotToldNorOneOfOtherGround) {
  PlanProblem problem = problem_on(1, 2, 10.0, 10.0, [](double, double) { return 0.0; });
  const std::vector<dem::SoilClass> legend{{0, "firm", "firm"}, {1, "b", "dune"}};
  problem.soil_map = std::make_shared<dem::SoilMap>(
      problem.terrain->geometry(), std::vector<std::int16_t>{0, 1}, std::vector<std::uint8_t>{1, 1}, legend);
  problem.beliefs.known = {firm_soil("firm"), firm_soil("dune")};
  sim::DrivePrediction drive = drive_at(0.0, 0.0);
  drive.stations.push_back(drive.stations[0]);
  drive.stations[0].station.pose = {5.0, 5.0, 0.0};
  drive.stations[1].station.pose = {15.0, 5.0, 0.0};
  drive.stations[1].soil = 1;
  sim::RuleRisk tilt = risk_of(Rule::kTilt, 3.0, 3.0);
  EXPECT_NE(halt_words(problem, drive, tilt).find("on firm,"), std::string::npos);
  tilt.station = 1;
  EXPECT_NE(halt_words(problem, drive, tilt).find("on dune (class b),"), std::string::npos);
}

TEST(VerdictWords, OnlyRulesThatTripOftenEnoughAreTold) {
  sim::DrivePrediction drive = drive_at(0.0, 0.0);
  drive.outcomes.rules = {risk_of(Rule::kTilt, 3.0, 3.0), risk_of(Rule::kEmbedding, 3.0, 3.0),
                          risk_of(Rule::kStance, 4.0, 6.0)};
  drive.outcomes.rules[0].trips.share = 0.004;
  drive.outcomes.rules[2].trips.share = 0.5;
  EXPECT_EQ(tripping_words(drive),
            (std::vector<std::string>{
                "stance trips in 50 % of the draws, from 4.0 to 6.0 m: the wheels find no ground to stand on",
                "embedding trips in 25 % of the draws, at 3.0 m: the wheels dig in"}));
}

TEST(VerdictWords, TheNearestLimitIsTheOneOfWhichTheLeastIsLeft) {
  sim::DrivePrediction drive = drive_at(0.0, 0.0);
  EXPECT_EQ(nearest_limit_words(drive), "");
  const auto with = [](Rule rule, double limit, sim::DrawnSpread value, std::size_t station) {
    sim::RuleRisk risk = risk_of(rule);
    risk.limit = limit;
    risk.value = value;
    risk.station = station;
    return risk;
  };
  drive.outcomes.rules = {with(Rule::kImmobilised, 1.0, {0.0, 0.0, 0.9}, 0),       // nobody sets its limit
                          with(Rule::kEnergy, sim::kNoLimit, {1.0, 1.0, 1.0}, 0),  // nobody has set it
                          with(Rule::kAside, 0.0, {0.0, 0.0, 0.0}, 0),             // nothing is a share of it
                          with(Rule::kCurrent, 1.0, {0.5, 0.9, 1.1}, 0),           // is passed
                          with(Rule::kSinkage, 0.08, {0.0, 0.02, 0.04}, 9),        // half is left
                          with(Rule::kClearance, 0.2, {0.25, 0.3, 0.4}, 0),        // a quarter is left
                          with(Rule::kTilt, 1.0, {0.1, 0.1, 0.5}, 0)};             // half is left
  EXPECT_EQ(
      nearest_limit_words(drive),
      "nearest to its limit comes the clearance: 0.25 m at 5 m in all but 5 % of the draws, limit 0.2 m");
  drive.outcomes.rules.erase(drive.outcomes.rules.begin() + 5);
  EXPECT_EQ(nearest_limit_words(drive),
            "nearest to its limit comes the sinkage: 0.04 m in all but 5 % of the draws, limit 0.08 m")
      << "at a place beyond what was predicted";
}

TEST(VerdictWords, TheGroundWithMostHaltsIsToldWhereThereAreAny) {
  PlanProblem problem;
  problem.beliefs.known = {firm_soil("firm"), firm_soil("dune")};
  sim::DrivePrediction drive;
  EXPECT_EQ(ground_words(problem, drive), "");
  drive.outcomes.grounds = {{0, 10.0, 0.1, 0.0}, {1, 20.0, 0.3, 0.0}, {std::nullopt, 5.0, 0.0, 0.0}};
  EXPECT_EQ(ground_words(problem, drive), "75 % of the halts happen on the 20 m of dune");
}

TEST(VerdictWords, ClosuresAreToldWhereTheDriveHangsOnThem) {
  PlanProblem problem;
  problem.beliefs.known = {firm_soil("firm"), firm_soil("dune")};
  sim::DrivePrediction drive;
  EXPECT_EQ(closure_words(problem, drive), "");
  drive.closures = sim::ClosureReach{{0.2, 0, 0.18, 0.32, false, {}}, {0.3, 1, 0.5, 0.6, false, {}}};
  EXPECT_EQ(closure_words(problem, drive), "") << "either way it holds";
  drive.closures->greatest.breaks_a_limit = true;
  EXPECT_EQ(closure_words(problem, drive),
            "on mean soils the drive hangs on where the stress under the rim of a wheel is greatest (c1 and "
            "c2 of dune): with c1 0.18 and "
            "c2 0.32 it keeps all limits (slip 0.20), with c1 0.50 and c2 0.60 it breaks a limit (slip "
            "0.30); one soil in twenty lies "
            "beyond either");
  drive.closures->greatest.breaks_a_limit = false;
  drive.closures->least.immobilised_at_m = 3.0;
  EXPECT_NE(
      closure_words(problem, drive).find("c2 of firm): with c1 0.18 and c2 0.32 it is immobilised at 3.0 m"),
      std::string::npos);
}

TEST(VerdictWords, SegmentsAreCountedAndTheWorstIsTold) {
  sim::DriveOutcomes outcomes;
  sim::SegmentRisk go, open, bad;
  open.stop = {0.3, 0.2, 0.4};
  bad.stop = {0.6, 0.55, 0.7};
  bad.from_m = 250.0;
  bad.to_m = 500.0;
  outcomes.segments = {go, bad, open};
  outcomes.expected_stops = 0.9;
  const std::vector<std::string> words = segment_words(outcomes, {});
  EXPECT_EQ(
      words.front(),
      "3 segments, each a sol's drive: 1 GO, 1 NO-GO, 1 UNKNOWN; about 4 sols with one more for each halt");
  EXPECT_TRUE(words.back().starts_with(
      "the worst segment is from 250 to 500 m: a halt in 60 % of the draws that come there"));
}

}  // namespace
}  // namespace slipway::planner
