#include "api/wheel_sweep.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "api/documents/soil/wheel_sweep_answer.h"
#include "api/documents/soil/wheel_sweep_request.h"
#include "api/json/parse.h"
#include "api/report/sweep_chart.h"
#include "sim/rover/stance.h"
#include "small_world.h"

namespace slipway::api {
namespace {

using testing::example;
using testing::small_world;

const Catalogue& catalogue() {
  return *small_world().catalogue();
}

std::string sweep_with(const std::string& members) {
  return R"({"rover":"mer-class","soil":"jlu_mars_2_dense")" + members + "}";
}

std::string answer_to(const std::string& request) {
  const auto answer = run_wheel_sweep(catalogue(), request);
  EXPECT_TRUE(answer) << answer.error().detail;
  return answer ? json::write_wheel_sweep_answer(*answer) : "";
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::vector<std::string> pointers_of(const std::string& request) {
  const auto answer = read_wheel_sweep(catalogue(), request);
  std::vector<std::string> pointers;
  if (answer) return pointers;
  for (const Fault& fault : answer.error().faults) pointers.push_back(fault.pointer);
  return pointers;
}

TEST(WheelSweepRequest, DefaultsAreThoseOfTheRover) {
  const auto answer = read_wheel_sweep(catalogue(), sweep_with(""));
  ASSERT_TRUE(answer) << answer.error().detail;
  EXPECT_EQ(answer->request.wheel, "lf");
  EXPECT_NEAR(*answer->request.load_n, 174.0 * 3.71 / 6.0, 1e-12);
  EXPECT_EQ(answer->request.radius_m, 0.125);
  EXPECT_EQ(answer->request.speed_m_s, 0.04);
}

TEST(WheelSweepRequest, EveryKeyIsReadAndEchoed) {
  const auto answer = read_wheel_sweep(catalogue(), example("wheel_sweep_every_key.json"));
  ASSERT_TRUE(answer) << answer.error().detail;
  const sim::WheelRigConditions test = sim::points_of(answer->sweep).back().test;
  EXPECT_EQ(test.wheel.radius_m, 0.13);
  EXPECT_EQ(test.wheel.grousers.count, 24.0);
  EXPECT_EQ(test.soil.n1, 0.4);
  EXPECT_EQ(test.soil.multipass_stiffening, 0.5);
  EXPECT_EQ(test.slip, 0.8);
  EXPECT_EQ(test.slip_definition, sim::SlipDefinition::kTravel);
  EXPECT_TRUE(test.in_a_track && test.speed_is_of_travel);
  EXPECT_GT(test.drive->torque_constant_nm_per_a, 0.0224) << "colder than its reference";
  const std::string echoed = json::write_wheel_sweep_request(answer->request);
  const auto again = json::read_wheel_sweep_request(echoed);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->faults, std::vector<Fault>{});
  EXPECT_EQ(json::write_wheel_sweep_request(again->request), echoed);
}

TEST(WheelSweepRequest, EveryFaultIsNamed) {
  EXPECT_EQ(pointers_of(R"({"rover":"mer","soil":"sand","slip":2,"loadn":1,"sweep":[{"parameter":"slip"}]})"),
            (std::vector<std::string>{"/slip", "/sweep/0/from", "/sweep/0/to", "/sweep/0/step", "/loadn",
                                      "/rover", "/soil"}));
  EXPECT_EQ(pointers_of(sweep_with(R"(,"load_n":10,"sinkage_m":0.01)")),
            std::vector<std::string>{"/sinkage_m"});
  EXPECT_EQ(pointers_of(sweep_with(R"(,"wheel":"xx")")), std::vector<std::string>{"/wheel"});
  EXPECT_EQ(pointers_of(sweep_with(R"(,"effects":[{"name":"com_offset"},{"name":"grouser"}])")),
            (std::vector<std::string>{"/effects/1/name", "/effects/0/name"}));
  EXPECT_EQ(pointers_of(sweep_with(R"(,"sweep":[{"parameter":"slip","values":[0],"step":1}])")),
            std::vector<std::string>{"/sweep/0/step"});
  EXPECT_EQ(pointers_of(sweep_with(R"(,"sweep":[{"parameter":"slip","from":1,"to":0,"step":0.1}])")),
            std::vector<std::string>{"/sweep/0/to"});
  EXPECT_EQ(pointers_of(sweep_with(R"(,"sweep":[{"parameter":"slip","from":0,"to":0.9,"step":1e-9}])")),
            std::vector<std::string>{"/sweep"});
  EXPECT_EQ(pointers_of(sweep_with(R"(,"sweep":[{"parameter":"slip","from":-3,"to":2,"step":0.1}])")),
            (std::vector<std::string>{"/sweep/0/from", "/sweep/0/to"}));
  EXPECT_EQ(pointers_of(sweep_with(R"(,"sweep":[{"parameter":"slip","values":[0,0.5,2]}])")),
            std::vector<std::string>{"/sweep/0/values/2"});
  EXPECT_EQ(pointers_of(sweep_with(R"(,"slip_angle_deg":90)")), std::vector<std::string>{"/slip_angle_deg"});
  EXPECT_EQ(pointers_of(sweep_with(R"(,"slip_angle_deg":90,"slip_definition":"travel")")),
            std::vector<std::string>{});
  const auto malformed = read_wheel_sweep(catalogue(), "{");
  ASSERT_FALSE(malformed);
  EXPECT_EQ(malformed.error().code, ErrorCode::kMalformedJson);
}

TEST(WheelSweepRequest, AnUnknownParameterIsRefusedWithTheKnown) {
  const auto answer =
      read_wheel_sweep(catalogue(), sweep_with(R"(,"sweep":[{"parameter":"slop","values":[0]}])"));
  ASSERT_FALSE(answer);
  const std::string message = answer.error().faults.at(0).message;
  EXPECT_NE(message.find("slip_angle_deg"), std::string::npos);
  EXPECT_NE(message.find("effects.grousers.height_m"), std::string::npos);
  EXPECT_EQ(message.find("com_offset"), std::string::npos);
}

TEST(WheelSweepRequest, WhatCouldChangeNothingIsRefused) {
  const auto tips = R"(,"slip_radius":"tip")";
  EXPECT_EQ(pointers_of(sweep_with(tips)), std::vector<std::string>{"/slip_radius"});
  EXPECT_EQ(pointers_of(sweep_with(R"(,"slip_radius":"tip","grousers":{"height_m":0.01,"count":24})")),
            std::vector<std::string>{});
  EXPECT_EQ(pointers_of(sweep_with(R"(,"effects":[{"name":"cleat_shear_radius"}])")),
            std::vector<std::string>{"/effects/0/name"});
  EXPECT_EQ(
      pointers_of(sweep_with(R"(,"effects":[{"name":"cleat_shear_radius","parameters":{"height_m":0.01}}])")),
      std::vector<std::string>{});
  EXPECT_EQ(pointers_of(sweep_with(R"(,"in_a_track":true)")), std::vector<std::string>{"/in_a_track"});
  EXPECT_EQ(pointers_of(sweep_with(R"(,"effects":[{"name":"multipass"}])")),
            std::vector<std::string>{"/effects/0/name"});
  EXPECT_EQ(pointers_of(sweep_with(R"(,"in_a_track":true,"effects":[{"name":"multipass"}])")),
            std::vector<std::string>{});
}

double number_in(const json::JsonValue& row, std::string_view key) {
  const json::JsonValue* const value = row.find(key);
  EXPECT_NE(value, nullptr) << key;
  return value == nullptr ? 0.0 : value->number;
}

TEST(WholeRover, OnASlopeItsPullCarriesItsWeightAlongItAndItsWheelsLoadsDiffer) {
  const std::string document = answer_to(
      sweep_with(R"(,"whole_rover":true,"sweep":[{"parameter":"slope_deg","values":[-10,0,10,45]}])"));
  const auto parsed = json::parse(document, {.bytes = document.size(), .values = document.size()});
  ASSERT_TRUE(parsed);
  const auto& rows = parsed->find("rows")->elements;
  ASSERT_EQ(rows.size(), 4U);
  const double weight = 174.0 * 3.71;
  for (std::size_t i = 0; i < 3; ++i) {
    const double slope = (static_cast<double>(i) - 1.0) * 10.0 * M_PI / 180.0;
    EXPECT_NEAR(number_in(rows[i], "drawbar_pull_n"), weight * std::sin(slope), 1e-3 * weight);
    EXPECT_NEAR(number_in(rows[i], "load_n"), weight * std::cos(slope), 1e-3 * weight);
  }
  EXPECT_LT(number_in(rows[0], "slip"), number_in(rows[1], "slip"));
  EXPECT_LT(number_in(rows[1], "slip"), number_in(rows[2], "slip"));
  // Climbing, the rear wheels carry more than on level ground; the answer is that of the balance itself.
  EXPECT_GT(number_in(rows[2], "lr_load_n"), number_in(rows[1], "lr_load_n") + 1.0);
  const sim::RoverModel& rover = *catalogue().rovers.at("mer-class");
  sim::QuasiStaticSolver solver(rover, 3.71);
  const sim::StationState state =
      solver.solve(sim::stance_on_plane(rover, {.pitch_rad = -10.0 * M_PI / 180.0}),
                   catalogue().soils.at("jlu_mars_2_dense").mean, {.speed_m_s = rover.cruise_speed_m_s});
  EXPECT_NEAR(number_in(rows[2], "slip"), state.slip_ratio, 1e-6);
  EXPECT_NE(rows[3].find("outcome")->text, "balanced");
  EXPECT_EQ(rows[3].find("slip"), nullptr);
  EXPECT_TRUE(
      lines_of(json::wheel_sweep_csv(document).value())[0].starts_with("slope_deg,slip,slip_angle_deg,"));
  EXPECT_NE(draw_wheel_sweep(document).value().find("The whole of mer-class"), std::string::npos);
}

TEST(WholeRover, WhatIsOfASingleWheelIsRefused) {
  EXPECT_EQ(pointers_of(sweep_with(R"(,"whole_rover":true)")), std::vector<std::string>{"/slope_deg"});
  EXPECT_EQ(
      pointers_of(sweep_with(
          R"(,"whole_rover":true,"slope_deg":5,"slip":0.1,"load_n":9,"wheel":"lf","radius_m":0.1,"in_a_track":true)")),
      (std::vector<std::string>{"/slip", "/load_n", "/in_a_track", "/wheel", "/radius_m"}));
  EXPECT_EQ(pointers_of(sweep_with(
                R"(,"whole_rover":true,"slope_deg":5,"sweep":[{"parameter":"load_n","values":[10]}])")),
            std::vector<std::string>{"/sweep/0/parameter"});
  EXPECT_EQ(pointers_of(sweep_with(
                R"(,"whole_rover":true,"slope_deg":5,"effects":[{"name":"com_offset"}],"set":{"soil.n":1})")),
            std::vector<std::string>{});
}

TEST(WheelSweepCsv, HasTheStatedColumnsAndARowATest) {
  const std::string document = answer_to(sweep_with(
      R"(,"sweep":[{"parameter":"effects.grousers.height_m","from":0,"to":0.02,"step":0.005},{"parameter":"slip","values":[-0.5,0.4]}])"));
  const auto lines = lines_of(json::wheel_sweep_csv(document).value());
  ASSERT_EQ(lines.size(), 1U + 5U * 2U);
  EXPECT_EQ(
      lines[0],
      "effects.grousers.height_m,slip,slip_angle_deg,load_n,entry_angle_deg,exit_angle_deg,sinkage_m,"
      "drawbar_pull_n,lateral_force_n,vertical_force_n,torque_nm,current_a,thrust_n,compaction_resistance_n,"
      "bulldozing_resistance_n,tractive_efficiency,outcome,reason");
  const long commas = std::count(lines[0].begin(), lines[0].end(), ',');
  for (const std::string& line : lines) EXPECT_EQ(std::count(line.begin(), line.end(), ','), commas) << line;
  EXPECT_TRUE(lines[1].starts_with("0,-0.5,0,107.59,")) << lines[1];
  EXPECT_TRUE(lines[10].starts_with("0.02,0.4,0,107.59,")) << lines[10];
}

TEST(WheelSweepCsv, ASunkWheelHasItsReasonAndNoNumbers) {
  const std::string document =
      answer_to(sweep_with(R"(,"sweep":[{"parameter":"load_n","values":[100,50000]}])"));
  const auto lines = lines_of(json::wheel_sweep_csv(document).value());
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_TRUE(lines[2].starts_with("0,0,50000,,,,,,,,,,,,,sunk_to_axle,sunk to the axle: the soil carries"))
      << lines[2];
}

TEST(WheelSweepCsv, QuotesWhatMustBeQuoted) {
  EXPECT_EQ(json::csv_field("plain"), "plain");
  EXPECT_EQ(json::csv_field("a, \"b\""), "\"a, \"\"b\"\"\"");
}

TEST(WheelSweep, TheSameRequestHasTheSameBytes) {
  const std::string first = answer_to(example("wheel_sweep_every_key.json"));
  EXPECT_EQ(first, answer_to(example("wheel_sweep_every_key.json")));
  EXPECT_EQ(json::wheel_sweep_csv(first).value(),
            json::wheel_sweep_csv(answer_to(example("wheel_sweep_every_key.json"))).value());
  EXPECT_EQ(draw_wheel_sweep(first).value(), draw_wheel_sweep(first).value());
}

TEST(SweepChart, TitlesHaveWordsAndUnits) {
  EXPECT_EQ(parameter_title("slip"), "slip");
  EXPECT_EQ(parameter_title("slip_angle_deg"), "slip angle, deg");
  EXPECT_EQ(parameter_title("load_n"), "load, N");
  EXPECT_EQ(parameter_title("effects.grousers.height_m"), "grousers height, m");
  EXPECT_EQ(parameter_title("soil.k_phi"), "k_phi, N/m^(n+2)");
}

TEST(SweepChart, ALineForEachValueOfTheSecondAxis) {
  const std::vector<sim::SweepAxis> axes{{"load_n", {10.0, 20.0, 30.0}}, {"slip", {0.0, 0.5}}};
  const Chart chart = sweep_chart("", axes, {"pull, N", {1.0, 2.0, 3.0, std::nullopt, 5.0, 6.0}});
  ASSERT_EQ(chart.series.size(), 2U);
  EXPECT_EQ(chart.series[0].y, (std::vector<double>{1.0, 3.0, 5.0}));
  EXPECT_TRUE(std::isnan(chart.series[1].y[1])) << "a missing value parts the line";
  EXPECT_EQ(chart.series[1].name, "slip 0.5");
}

TEST(SweepChart, ManyLinesBecomeAHeatMap) {
  const std::string few = answer_to(sweep_with(
      R"(,"sweep":[{"parameter":"slip","values":[0,0.2]},{"parameter":"load_n","values":[50,100]}])"));
  const std::string many = answer_to(sweep_with(
      R"(,"sweep":[{"parameter":"slip","values":[0,0.2]},{"parameter":"load_n","from":20,"to":200,"step":20}])"));
  EXPECT_NE(draw_wheel_sweep(few).value().find("load 50 N"), std::string::npos);
  EXPECT_EQ(draw_wheel_sweep(many).value().find("load 20 N"), std::string::npos);
  EXPECT_NE(draw_wheel_sweep(many).value().find("drawbar pull, N"), std::string::npos);
}

TEST(SweepChart, NothingSweptIsNothingToDraw) {
  const auto picture = draw_wheel_sweep(answer_to(sweep_with("")));
  ASSERT_FALSE(picture);
  EXPECT_EQ(picture.error().code, ErrorCode::kInvalidRequest);
}

}  // namespace
}  // namespace slipway::api
