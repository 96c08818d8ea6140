// The telemetry of a drive under way: from its rows to another verdict ahead.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "api/documents/check_answer.h"
#include "api/documents/plan_answer.h"
#include "api/files/telemetry_csv.h"
#include "api/json/parse.h"
#include "api/service_drives.h"
#include "small_world.h"
#include "yard_requests.h"

namespace slipway::api {
namespace {

using json::JsonValue;

const testing::YardRequests kMsl("msl-class");

// Six metres east on the level line y = 30 m, with one slip all the way.
std::string drive_with_slip(double slip) {
  std::string rows;
  for (int k = 0; k <= 6; ++k)
    rows += fmt::format(R"({}{{"driven_m":{:.4f},"x_m":{},"y_m":30}})", k == 0 ? "" : ",", k / (1.0 - slip),
                        10 + k);
  return R"("drive_so_far":{"rows":[)" + rows + "]}";
}

// The path's ground is firm, it is believed: but for one draw in 25, and with an error of slip.
constexpr const char* kFirm = R"("beliefs":[{"name":"mer_b_sandy_loam","summary":"firm, it is believed",
  "source":"made up for this test","assumed":[],"k_c":58375.0,"k_phi":10276770.0,"n":1.067,"cohesion_pa":541.0,
  "friction_angle_deg":30.6,"shear_modulus_x_m":0.0138,"density_kg_m3":1500.0,"c1":0.18,"c2":0.32,
  "std":{"stiffness_ratio":0.25,"n":0.05,"cohesion_pa":162.3,"friction_angle_deg":2.0,"shear_modulus_ratio":0.25},
  "correlation_length_m":20.0,"slip_error":0.5,
  "alternatives":[{"soil":"jlu_mars_1_dense","weight":0.998},{"soil":"soup","weight":0.002}]},
  {"name":"soup","summary":"loose","source":"made up for this test","assumed":[],"k_c":2000.0,"k_phi":60000.0,
  "n":1.0,"cohesion_pa":100.0,"friction_angle_deg":16.0,"shear_modulus_x_m":0.03,"density_kg_m3":1500.0,
  "c1":0.18,"c2":0.32,"std":{"stiffness_ratio":0.25,"n":0.05,"cohesion_pa":30.0,"friction_angle_deg":2.0,
  "shear_modulus_ratio":0.25},"correlation_length_m":20.0},
  {"name":"unknown_ground","summary":"firm","source":"made up for this test","assumed":[],"k_c":58375.0,
  "k_phi":10276770.0,"n":1.067,"cohesion_pa":541.0,"friction_angle_deg":30.6,"shear_modulus_x_m":0.0138,
  "density_kg_m3":1500.0,"c1":0.18,"c2":0.32,"std":{"stiffness_ratio":0.25,"n":0.05,"cohesion_pa":162.3,
  "friction_angle_deg":2.0,"shear_modulus_ratio":0.25},"correlation_length_m":20.0}])";
constexpr const char* kAhead = R"("path":[{"x_m":16,"y_m":30},{"x_m":40,"y_m":30}])";

double stops_of(const JsonValue& check) {
  return check.find("outcomes")->find("expected_stops")->find("value")->number;
}

TEST(DriveSoFar, MuchSlipOnGroundThatWasBelievedFirmTurnsAGoIntoANoGoAndLittleSlipLowersTheRisk) {
  const std::string ask = std::string(kAhead) + "," + kFirm;
  const auto before = kMsl.checked(ask);
  ASSERT_TRUE(before) << before.error().detail;
  EXPECT_EQ(before->find("verdict")->text, "go") << before->find("reasons")->elements[0].text;
  EXPECT_EQ(before->find("drive_so_far"), nullptr);
  const auto slipped = kMsl.checked(ask + "," + drive_with_slip(0.5));
  ASSERT_TRUE(slipped) << slipped.error().detail;
  EXPECT_EQ(slipped->find("verdict")->text, "no_go") << slipped->find("reasons")->elements[0].text;
  const JsonValue& learnt = *slipped->find("drive_so_far");
  ASSERT_GE(learnt.find("stretches")->elements.size(), 2U);
  const JsonValue& first = learnt.find("stretches")->elements.front();
  EXPECT_NEAR(first.find("slip")->number, 0.5, 1e-3);
  EXPECT_LT(first.find("predicted_slip")->find("p95")->number, 0.4);
  const auto held = kMsl.checked(ask + "," + drive_with_slip(0.05));
  ASSERT_TRUE(held);
  EXPECT_LE(stops_of(*held), stops_of(*before));
  EXPECT_GT(stops_of(*slipped), 1.0);
}

TEST(DriveSoFar, TheRestBeginsWhereTheRoverIs) {
  const auto to_corner = kMsl.checked(R"("path":[{"x_m":24,"y_m":30}],"draws":8,)" + drive_with_slip(0.1));
  ASSERT_TRUE(to_corner) << to_corner.error().detail;
  EXPECT_NEAR(to_corner->find("summary")->find("length_m")->number, 8.0, 0.01);
  const auto given =
      kMsl.checked(R"("path":[{"x_m":20,"y_m":30},{"x_m":24,"y_m":30}],"draws":8,)" + drive_with_slip(0.1));
  ASSERT_TRUE(given);
  EXPECT_NEAR(given->find("summary")->find("length_m")->number, 4.0, 0.01);
  EXPECT_EQ(kMsl.faults_of(R"("commands":[{"drive_m":2}],)" + drive_with_slip(0.1)),
            std::vector<std::string>{"/start"});
  const auto plan =
      read_plan(testing::small_world(),
                kMsl.with(R"("goal":{"x_m":24,"y_m":30},"draws":8,"routes":1,)" + drive_with_slip(0.1)));
  ASSERT_TRUE(plan) << plan.error().detail;
  EXPECT_EQ(plan->start.x_m, 16.0);
  NoProgress progress;
  const auto answer = run_plan(testing::small_world(), *plan, progress);
  ASSERT_TRUE(answer) << answer.error().detail;
  const auto document = json::parse(json::write_plan_answer(*answer));
  ASSERT_TRUE(document);
  EXPECT_FALSE(document->find("drive_so_far")->find("stretches")->elements.empty());
  EXPECT_FALSE(document->find("summary")->elements.empty());
}

TEST(DriveSoFar, EveryFaultOfTheRowsIsNamedWithItsPlace) {
  const auto rows = [](const std::string& list) {
    return R"("path":[{"x_m":20,"y_m":30},{"x_m":24,"y_m":30}],"drive_so_far":{"rows":[)" + list + "]}";
  };
  EXPECT_EQ(kMsl.faults_of(rows(R"({"driven_m":0,"x_m":10,"y_m":30})")),
            std::vector<std::string>{"/drive_so_far/rows"});
  EXPECT_EQ(kMsl.faults_of(rows(R"({"driven_m":-1,"x_m":10},{"driven_m":2,"x_m":12,"y_m":30,"current_a":1,
                              "currents_a":{"lf":1},"sinkage_m":0})")),
            (std::vector<std::string>{"/drive_so_far/rows/0/driven_m", "/drive_so_far/rows/0/y_m",
                                      "/drive_so_far/rows/1/currents_a", "/drive_so_far/rows/1/sinkage_m"}));
  EXPECT_EQ(kMsl.faults_of(rows(
                R"({"time_s":9,"driven_m":3,"x_m":10,"y_m":30},{"time_s":8,"driven_m":2,"x_m":12,"y_m":30},
                              {"driven_m":4,"x_m":16,"y_m":30})")),
            (std::vector<std::string>{"/drive_so_far/rows/1/time_s", "/drive_so_far/rows/1/driven_m",
                                      "/drive_so_far/rows/2"}));
  EXPECT_EQ(kMsl.faults_of(rows(R"({"driven_m":3,"x_m":10,"y_m":30},{"driven_m":3,"x_m":10,"y_m":30})")),
            std::vector<std::string>{"/drive_so_far/rows"});
  EXPECT_EQ(
      kMsl.faults_of(rows(
          R"({"driven_m":0,"x_m":118,"y_m":30},{"driven_m":3,"x_m":121,"y_m":30,"currents_a":{"zz":1}})")),
      (std::vector<std::string>{"/drive_so_far/rows/1", "/drive_so_far/rows/1/currents_a/zz"}));
}

TEST(DriveSoFar, ATableIsReadAndItsFaultsHaveTheirLines) {
  const auto good = read_telemetry_csv(
      "driven_m,x_m,y_m,time_s,yaw_deg,lf_current_a\n0,10,30,0,90,\n2,12,30,60,,1.5\n", "t.csv");
  ASSERT_TRUE(good) << good.error().detail;
  ASSERT_EQ(good->rows.size(), 2U);
  EXPECT_EQ(good->rows[1].currents_a.at("lf"), 1.5);
  EXPECT_FALSE(good->rows[1].yaw_rad);
  const auto bad = read_telemetry_csv("driven_m,x_m,yy_m\n0,10,30\n2,east,30,4\n", "t.csv");
  ASSERT_FALSE(bad);
  std::vector<std::string> places;
  for (const Fault& fault : bad.error().faults) places.push_back(fault.pointer);
  EXPECT_EQ(places, (std::vector<std::string>{"t.csv, line 1, column 3", "t.csv, line 1", "t.csv, line 3",
                                              "t.csv, line 3, column 2 (x_m)"}));
  const auto leaps = read_telemetry_csv("driven_m,x_m,y_m\n0,10,30\n\n2,20,30\n", "t.csv");
  ASSERT_FALSE(leaps);
  EXPECT_EQ(leaps.error().faults[0].pointer, "t.csv, line 4");
}

TEST(Beliefs, WholeSoilsStandInForThoseOfTheCatalogue) {
  const std::string loose = R"("beliefs":[{"name":"unknown_ground","summary":"s","source":"s","assumed":[],
    "k_c":2000.0,"k_phi":60000.0,"n":1.0,"cohesion_pa":100.0,"friction_angle_deg":20.0,"shear_modulus_x_m":0.03,
    "density_kg_m3":1500.0,"c1":0.18,"c2":0.32,"std":{"stiffness_ratio":0.2,"n":0.05,"cohesion_pa":30.0,
    "friction_angle_deg":2.0,"shear_modulus_ratio":0.25,"c1":0.05,"c2":0.1},"correlation_length_m":5.0}])";
  const auto answer = kMsl.checked(R"("path":[{"x_m":20,"y_m":30},{"x_m":24,"y_m":30}],"draws":4,)" + loose);
  ASSERT_TRUE(answer) << answer.error().detail;
  const JsonValue& soil = answer->find("request")->find("beliefs")->elements.front();
  EXPECT_EQ(soil.find("std")->find("c1")->number, 0.05);
  // A soil that is no soil, one that is given twice, and an alternative that nobody knows.
  std::string twice = loose.substr(0, loose.size() - 1) + "," + loose.substr(loose.find('{'));
  EXPECT_EQ(kMsl.faults_of(std::string(R"("path":[{"x_m":20,"y_m":30},{"x_m":24,"y_m":30}],)") + twice),
            std::vector<std::string>{"/beliefs/1/name"});
  std::string unknown = loose;
  unknown.insert(unknown.size() - 2, R"(,"alternatives":[{"soil":"cheese","weight":1}])");
  EXPECT_EQ(kMsl.faults_of(std::string(R"("path":[{"x_m":20,"y_m":30},{"x_m":24,"y_m":30}],)") + unknown),
            std::vector<std::string>{"/beliefs/0/alternatives/0/soil"});
  EXPECT_EQ(
      kMsl.faults_of(R"("path":[{"x_m":20,"y_m":30},{"x_m":24,"y_m":30}],"beliefs":[{"name":"a"}])").front(),
      "/beliefs/0/summary");
}

// Spreadsheets and rovers' own tools write the same table in many ways.
TEST(DriveSoFarCsv, EveryWayToWriteTheTableIsTheSameTelemetry) {
  const std::string plain = "driven_m,x_m,y_m,current_a\n0,8142640,-276640,\n2.5,8142638,-276640.25,6.5\n";
  for (const std::string text :
       {"driven_m;x_m;y_m;current_a\r\n0;8142640;-276640;\r\n2,5;8142638;-276640,25;6,5\r\n",
        "sep=;\ndriven_m;x_m;y_m;current_a\n0;8142640;-276640;-\n2.5;8142638;-276640.25;6.5\n",
        "\xEF\xBB\xBF"
        "driven_m\tx_m\ty_m\tcurrent_a\n0\t8142640\t-276640\tNaN\n2.5\t8142638\t-276640.25\t6.5\n",
        "driven_m,x_m,y_m,current_a\n0,\"8142640\",-276640,N/A\n2.5,8142638,-276640.25,6.5\n"}) {
    const auto expected = read_telemetry_csv(plain, "t.csv"), read = read_telemetry_csv(text, "t.csv");
    ASSERT_TRUE(expected);
    ASSERT_TRUE(read) << text << (read ? "" : read.error().faults[0].message);
    ASSERT_EQ(read->rows.size(), 2U);
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_EQ(read->rows[k].driven_m, expected->rows[k].driven_m) << text;
      EXPECT_EQ(read->rows[k].x_m, expected->rows[k].x_m) << text;
      EXPECT_EQ(read->rows[k].y_m, expected->rows[k].y_m) << text;
      EXPECT_EQ(read->rows[k].current_a, expected->rows[k].current_a) << text;
    }
  }
}

}  // namespace
}  // namespace slipway::api
