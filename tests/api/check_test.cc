// A check from its request to its answer: paths, command sequences, rules, and every branch of the verdict.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "api/documents/check_answer.h"
#include "api/documents/check_request.h"
#include "api/files/drive_outcomes.h"
#include "api/ground_evidence.h"
#include "api/json/parse.h"
#include "api/service_drives.h"
#include "planner/judge/drive_verdict.h"
#include "small_world.h"
#include "yard_requests.h"

namespace slipway::api {
namespace {

using json::JsonValue;

const testing::YardRequests kMer("mer-class");

constexpr const char* kPath = R"("path":[{"x_m":20,"y_m":30},{"x_m":24,"y_m":30}],"draws":8)";

TEST(Check, AnswersWithVerdictRulesGroundsAndStretches) {
  const auto answer = kMer.checked(kPath);
  ASSERT_TRUE(answer) << answer.error().detail;
  EXPECT_EQ(answer->find("format")->text, "check/1");
  const std::string& verdict = answer->find("verdict")->text;
  EXPECT_TRUE(verdict == "go" || verdict == "no_go" || verdict == "unknown") << verdict;
  EXPECT_FALSE(answer->find("reasons")->elements.empty());
  const JsonValue* const outcomes = answer->find("outcomes");
  const auto rules = sim::rule_catalogue();
  EXPECT_EQ(
      outcomes->find("rules")->elements.size(),
      std::count_if(rules.begin(), rules.end(),
                    [](const sim::RuleRow& row) {
                      return std::isfinite(sim::limit_of(row.rule, sim::DriveLimits{}, sim::SlipChecks{}));
                    }))
      << "a rule that nobody set a limit for is not listed";
  EXPECT_EQ(outcomes->find("draws")->number, 8.0);
  double ground = 0.0;
  for (const JsonValue& each : outcomes->find("grounds")->elements) ground += each.find("length_m")->number;
  EXPECT_NEAR(ground, answer->find("summary")->find("length_m")->number, 0.01);
  EXPECT_EQ(outcomes->find("stretches")->elements.size(), 1u);
}

TEST(Check, ACommandSequenceDrivesAsThePathThatItMakes) {
  const auto path = kMer.checked(kPath);
  const auto commands = kMer.checked(
      R"("start":{"x_m":20,"y_m":30,"yaw_deg":0},"commands":[{"drive_m":2,"repeat":2}],"draws":8)");
  ASSERT_TRUE(path && commands);
  EXPECT_EQ(path->find("summary")->find("mean_slip")->number,
            commands->find("summary")->find("mean_slip")->number);
  EXPECT_EQ(path->find("outcomes")->find("stop")->find("value")->number,
            commands->find("outcomes")->find("stop")->find("value")->number);
}

TEST(Check, ARequestMaySayWhatItBelievesOfTheGround) {
  EXPECT_EQ(kMer.faults_of(std::string(kPath) + R"(,"legend":"none","unknown_soil":"cheese","confidence":0)"),
            (std::vector<std::string>{"/confidence", "/unknown_soil", "/legend"}));
  const auto usual = kMer.checked(kPath);
  const auto sand =
      kMer.checked(std::string(kPath) + R"(,"unknown_soil":"jlu_mars_1_loose","legend":"default")");
  ASSERT_TRUE(usual && sand);
  EXPECT_EQ(usual->find("provenance")->find("legend")->text, "default");
  EXPECT_EQ(usual->find("provenance")->find("unknown_soil")->text, "unknown_ground");
  EXPECT_EQ(sand->find("provenance")->find("unknown_soil")->text, "jlu_mars_1_loose");
}

// The legend's soil of the path is weaker than most others.
TEST(Check, LessConfidenceInTheLegendMakesOtherSoilsLikely) {
  const auto slip = [](const char* confidence) {
    const auto answer = kMer.checked(
        std::string(R"("path":[{"x_m":20,"y_m":30},{"x_m":24,"y_m":30}],"draws":60,"confidence":)") +
        confidence);
    EXPECT_TRUE(answer);
    return answer->find("outcomes")->find("rules")->elements[0].find("value")->find("p50")->number;
  };
  EXPECT_LT(slip("0.1"), 0.9 * slip("1"));
}

TEST(Check, AnArcEndsWhereItsRadiusLeads) {
  const auto answer = kMer.checked(
      R"("start":{"x_m":20,"y_m":30,"yaw_deg":0},"commands":[{"arc_m":4.712389,"radius_m":3}],"draws":1)");
  ASSERT_TRUE(answer) << answer.error().detail;
  const auto& line =
      answer->find("routes")->find("features")->elements[0].find("geometry")->find("coordinates")->elements;
  EXPECT_NEAR(line.back().elements[0].number, 23.0, 0.01);
  EXPECT_NEAR(line.back().elements[1].number, 33.0, 0.01);
}

TEST(Check, ADriveThroughAKeepOutOrOutOfAKeepInIsANoGoWithThePlace) {
  const std::string lenient =
      R"(,"bars":{"max_embedding":1,"max_immobilised":1,"max_stop":1,"no_go_stop":1},"limits":{"max_slip":1})";
  const auto with = [&](const std::string& zones) { return kMer.checked(kPath + lenient + zones); };
  const auto free = with("");
  ASSERT_TRUE(free) << free.error().detail;
  ASSERT_EQ(free->find("verdict")->text, "go") << free->find("reasons")->elements[0].text;
  const auto clear =
      with(R"(,"keep_out":[[[21,40],[22,40],[22,41]]],"keep_in":[[[10,20],[40,20],[40,40],[10,40]]])");
  ASSERT_TRUE(clear) << clear.error().detail;
  EXPECT_EQ(clear->find("verdict")->text, "go");
  EXPECT_EQ(clear->find("request")->find("keep_in")->elements.size(), 1U);
  const auto enters = with(R"(,"keep_out":[[[23,30.5],[23.2,30.5],[23.2,30.7]]])");
  ASSERT_TRUE(enters);
  EXPECT_EQ(enters->find("verdict")->text, "no_go");
  EXPECT_NE(enters->find("reasons")->elements[0].text.find("would enter a keep-out at ("), std::string::npos);
  const auto leaves = with(R"(,"keep_in":[[[10,20],[23,20],[23,40],[10,40]]])");
  ASSERT_TRUE(leaves);
  EXPECT_EQ(leaves->find("verdict")->text, "no_go");
  EXPECT_NE(leaves->find("reasons")->elements[0].text.find("would leave a keep-in at ("), std::string::npos);
  EXPECT_EQ(kMer.faults_of(std::string(kPath) + R"(,"keep_in":[[[0,0],[1,1]]],"keep_out":3)"),
            (std::vector<std::string>{"/keep_out", "/keep_in/0"}));
}

// An area far off the map guards nothing: its corners may be swapped, or degrees.
TEST(CheckRequest, AreasThatAreOffTheMapBecauseTheirCornersAreSwappedAreRefused) {
  const std::string path = R"("path":[{"x_m":20,"y_m":30},{"x_m":24,"y_m":30}])";
  EXPECT_EQ(kMer.faults_of(path + R"(,"keep_out":[[[30,105],[30,115],[40,110]]])"),
            std::vector<std::string>{"/keep_out/0"});
  // Of the ground beside the map.
  EXPECT_TRUE(kMer.faults_of(path + R"(,"keep_out":[[[3000,10000],[3000,11000],[4000,10000]]])").empty());
}

TEST(Check, TheSameRequestGivesTheSameBytes) {
  const auto read = read_check(testing::small_world(), kMer.with(kPath));
  ASSERT_TRUE(read);
  NoProgress progress;
  EXPECT_EQ(json::write_check_answer(run_check(testing::small_world(), *read, progress).value()),
            json::write_check_answer(run_check(testing::small_world(), *read, progress).value()));
}

TEST(Check, EveryFaultIsNamed) {
  EXPECT_EQ(kMer.faults_of(R"("commands":[{"drive_m":2}])"), std::vector<std::string>{"/start"});
  EXPECT_EQ(kMer.faults_of(R"("start":{"x_m":20,"y_m":30},"commands":[{"drive_m":2}])"),
            std::vector<std::string>{"/start"});
  EXPECT_EQ(
      kMer.faults_of(R"("start":{"x_m":20,"y_m":30,"yaw_deg":0},"commands":[{"drive_m":2,"turn_deg":5}])"),
      std::vector<std::string>{"/commands/0"});
  EXPECT_EQ(
      kMer.faults_of(R"("start":{"x_m":20,"y_m":30,"yaw_deg":0},"commands":[{"arc_m":2,"radius_m":0}])"),
      std::vector<std::string>{"/commands/0/radius_m"});
  EXPECT_EQ(kMer.faults_of(std::string(kPath) + R"(,"rules":"no_such")"), std::vector<std::string>{"/rules"});
  EXPECT_EQ(
      kMer.faults_of(std::string(kPath) + R"(,"checks":{"slip_check_every_m":0},"bars":{"max_embedding":2})"),
      (std::vector<std::string>{"/checks/slip_check_every_m", "/bars/max_embedding"}));
  EXPECT_EQ(kMer.faults_of(std::string(kPath) + R"(,"bars":{"max_expected_stops":0.5})"),
            std::vector<std::string>{"/bars/max_expected_stops"});
  EXPECT_EQ(kMer.faults_of(std::string(kPath) + R"(,"bars":{"max_stop":0.6})"),
            std::vector<std::string>{"/bars/no_go_stop"});
  EXPECT_EQ(kMer.faults_of(std::string(kPath) + R"(,"limits":{"max_pitch_deg":70,"max_drive_h":0})"),
            (std::vector<std::string>{"/limits/max_pitch_deg", "/limits/max_drive_h"}));
  EXPECT_EQ(kMer.faults_of(std::string(kPath) + R"(,"start":{"x_m":1,"y_m":1,"yaw_deg":0})").front(),
            "/path");
}

// Where the drive on the mean soils hangs on c1 and c2, the reasons say so with both pairs.
TEST(Check, NamesC1AndC2WhereTheyDecide) {
  const auto named = [](const sim::ClosureReach& closures) {
    sim::DrivePrediction drive;
    drive.draws = 272;
    drive.closures = closures;
    const auto reasons = planner::judge_drive(planner::PlanProblem{}, drive).reasons;
    return std::find_if(reasons.begin(), reasons.end(), [](const std::string& reason) {
             return reason.find("(c1 and c2 of unmapped ground)") != std::string::npos &&
                    reason.find("with c1 0.10 and c2 0.20 it keeps all limits (slip 0.12)") !=
                        std::string::npos &&
                    reason.find("with c1 0.70 and c2 0.50 it is immobilised at 41.0 m") != std::string::npos;
           }) != reasons.end();
  };
  sim::ClosureReach closures;
  closures.least = {.max_slip_ratio = 0.12, .soil = {}, .c1 = 0.1, .c2 = 0.2, .immobilised_at_m = {}};
  closures.greatest = {.max_slip_ratio = 0.9,
                       .soil = {},
                       .c1 = 0.7,
                       .c2 = 0.5,
                       .breaks_a_limit = true,
                       .immobilised_at_m = 41.0};
  EXPECT_TRUE(named(closures));
  closures.greatest.breaks_a_limit = false;
  closures.greatest.immobilised_at_m.reset();
  EXPECT_FALSE(named(closures));
}

TEST(DriveOutcomeTable, ReadsDrivesBySolAndNamesEveryFault) {
  const auto table = read_drive_outcomes(
      R"({"format":"drive-outcomes/1","rover":"msl-class","drives":[)"
      R"({"sol":5,"outcome":"slip_stop","path":[[0,0],[1,0]]},{"sol":2,"outcome":"completed","path":[[0,0],[1,0]]}]})");
  ASSERT_TRUE(table) << table.error().detail;
  EXPECT_EQ(table->drives.front().sol, 2);
  EXPECT_EQ(table->drives.back().outcome, PastOutcome::kSlipStop);
  std::vector<steps::SlipStep> measured(3);
  measured[0].x_eqc_m = measured[0].y_eqc_m = 1.0;
  measured[0].sol = 4;
  measured[1] = measured[0];
  measured[1].sol = 5;
  measured[2].sol = 1;
  EXPECT_EQ(places_of({*table, measured}, 5).size(), 3u) << "only drives and mapped steps before the sol";
  const auto faulty = read_drive_outcomes(
      R"({"format":"drive-outcomes/1","rover":"msl-class","drives":[{"sol":-1,"outcome":"lost","path":[[0,0],[1]]}]})");
  ASSERT_FALSE(faulty);
  EXPECT_EQ(faulty.error().faults.size(), 3u);
}

}  // namespace
}  // namespace slipway::api
