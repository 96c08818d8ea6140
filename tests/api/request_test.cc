#include <gtest/gtest.h>

#include "api/documents/plan_request.h"
#include "api/documents/prediction_request.h"
#include "api/service_drives.h"
#include "api/service_map.h"
#include "core/angle.h"
#include "small_world.h"

namespace slipway::api {
namespace {

using testing::example;
using testing::small_world;

std::vector<std::string> pointers_of(const Error& error) {
  std::vector<std::string> pointers;
  for (const Fault& fault : error.faults) pointers.push_back(fault.pointer);
  return pointers;
}

// A plan request with one part replaced.
std::string plan_with(const std::string& members) {
  return R"({"terrain":"yard","rover":"mer-class","start":{"x_m":20,"y_m":30},"goal":{"x_m":45,"y_m":40})" +
         members + "}";
}

TEST(PlanRequest, DefaultsAreThoseOfTheRoomsBelow) {
  const auto request = read_plan(small_world(), example("plan_shortest.json"));
  ASSERT_TRUE(request);
  EXPECT_EQ(request->drive.limits.max_slip_ratio, sim::DriveLimits{}.max_slip_ratio);
  EXPECT_EQ(request->weights.of("slip"), planner::Weights().of("slip"));
  EXPECT_EQ(request->routes, 3);
  EXPECT_FALSE(request->drive.draws) << "as many as the verdict needs";
  EXPECT_FALSE(request->start.yaw_rad);
}

TEST(PlanRequest, EveryKeyIsReadInItsUnit) {
  const auto request = read_plan(small_world(), example("plan_every_key.json"));
  ASSERT_TRUE(request) << request.error().detail;
  EXPECT_DOUBLE_EQ(*request->goal.yaw_rad, rad_from_deg(90.0));
  EXPECT_DOUBLE_EQ(request->drive.limits.max_tilt_rad, rad_from_deg(20.0));
  EXPECT_EQ(request->waypoints.size(), 1U);
  EXPECT_EQ(request->keep_out.at(0).at(2), Eigen::Vector2d(28.0, 35.0));
  EXPECT_EQ(request->keep_in.at(0).size(), 4U);
  EXPECT_EQ(request->weights.of("duration"), 2.0);
  EXPECT_EQ(request->ranking.by, planner::RankBy::kExpected);
  EXPECT_EQ(request->ranking.tail, 0.25);
  EXPECT_EQ(request->planners, std::vector<std::string>{"rrt_star"});
  EXPECT_EQ(request->drive.effects.at(0).parameters.at("n1"), 0.3);
  EXPECT_EQ(request->drive.seed, 7U);
  EXPECT_EQ(request->verify, 1);
  EXPECT_EQ(request->drive.failed_wheels.at("rm"), sim::WheelFailure::kFree);
  EXPECT_EQ(request->drive.speed_m_s, 0.03);
}

TEST(PlanRequest, RanksByTheMeanUnlessTheCvarIsAskedFor) {
  const auto plain = read_plan(small_world(), plan_with(""));
  ASSERT_TRUE(plain) << plain.error().detail;
  EXPECT_EQ(plain->ranking.by, planner::RankBy::kExpected);
  const auto tail = read_plan(small_world(), plan_with(R"(,"ranking":{"by":"cvar"})"));
  ASSERT_TRUE(tail) << tail.error().detail;
  EXPECT_EQ(tail->ranking.by, planner::RankBy::kCvar);
  EXPECT_EQ(tail->ranking.tail, 0.1);
}

TEST(PlanRequest, WhatIsEchoedReadsBackAsTheSameRequest) {
  for (const char* name : {"plan_shortest.json", "plan_every_key.json"}) {
    const auto first = json::read_plan_request(example(name));
    ASSERT_TRUE(first && first->faults.empty());
    const std::string echoed = json::write_plan_request(first->request);
    const auto second = json::read_plan_request(echoed);
    ASSERT_TRUE(second);
    EXPECT_EQ(second->faults, std::vector<Fault>{});
    EXPECT_EQ(json::write_plan_request(second->request), echoed);
  }
}

TEST(PlanRequest, ARefusalNamesEveryFault) {
  const auto request = read_plan(small_world(), example("plan_refused.json"));
  ASSERT_FALSE(request);
  EXPECT_EQ(request.error().code, ErrorCode::kInvalidRequest);
  EXPECT_EQ(pointers_of(request.error()),
            (std::vector<std::string>{"/routes", "/limits/max_tilt_deg", "/limits/max_slipp", "/rover",
                                      "/start", "/goal"}));
  EXPECT_EQ(request.error().faults[1].message, "max_tilt_deg = 212 deg, must be in (0, 60]");
  EXPECT_NE(request.error().faults[2].message.find("did you mean \"max_slip\"?"), std::string::npos);
  EXPECT_EQ(request.error().faults[3].message,
            "unknown rover \"mer\"; did you mean \"mer-class\"? known: cuadriga, fido-class, m2020-class, "
            "mer-class, "
            "msl-class, zhurong-class");
  EXPECT_EQ(request.error().faults[4].message, "(85, 45) m has no elevation: the terrain is not known there");
  EXPECT_EQ(request.error().faults[5].message,
            "(500, 40) m is off the map, must be in x [0, 120] m and y [0, 100] m");
}

TEST(PlanRequest, PlacesOffTheMapAloneAreOffMap) {
  const auto off = read_plan(
      small_world(),
      R"({"terrain":"yard","rover":"mer-class","start":{"x_m":-1,"y_m":30},"goal":{"x_m":45,"y_m":400}})");
  ASSERT_FALSE(off);
  EXPECT_EQ(off.error().code, ErrorCode::kOffMap);
  EXPECT_EQ(off.error().faults.size(), 2U);
  const auto hole = read_plan(
      small_world(),
      R"({"terrain":"yard","rover":"mer-class","start":{"x_m":85,"y_m":45},"goal":{"x_m":45,"y_m":40}})");
  ASSERT_FALSE(hole);
  EXPECT_EQ(hole.error().code, ErrorCode::kNoData);
}

TEST(PlanRequest, EachBadMemberIsRefusedAtItsPlace) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {R"(,"waypoints":[{"x_m":1}])", "/waypoints/0/y_m"},
      {R"(,"waypoints":{"x_m":1})", "/waypoints"},
      {R"(,"waypoints":[{"x_m":30,"y_m":30},{"x_m":130,"y_m":30}])", "/waypoints/1"},
      {R"(,"keep_in":[[[0,0],[1,1]]])", "/keep_in/0"},
      {R"(,"keep_in":[[[0,0],[1,"1"],[2,0]]])", "/keep_in/0/1/1"},
      {R"(,"keep_out":[[[0,0],[1,1]]])", "/keep_out/0"},
      {R"(,"keep_out":[[[0,0],[1,1],[2,2]]])", "/keep_out/0"},
      {R"(,"keep_out":[[[0,0],[1,1,1],[2,0]]])", "/keep_out/0/1"},
      {R"(,"keep_out":[[[0,0],[1,"1"],[2,0]]])", "/keep_out/0/1/1"},
      {R"(,"weights":{"speed":1})", "/weights/speed"},
      {R"(,"ranking":"cvar")", "/ranking"},
      {R"(,"ranking":{"by":"worst"})", "/ranking/by"},
      {R"(,"ranking":{"tail":0})", "/ranking/tail"},
      {R"(,"ranking":{"tail":1.1})", "/ranking/tail"},
      {R"(,"ranking":{"share":0.1})", "/ranking/share"},
      {R"(,"routes":0)", "/routes"},
      {R"(,"routes":"3")", "/routes"},
      {R"(,"verify":4)", "/verify"},
      {R"(,"verify":0.5)", "/verify"},
      {R"(,"rung":"dynamic")", "/rung"},
      {R"(,"failed_wheels":["rf"])", "/failed_wheels"},
      {R"(,"failed_wheels":{"rf":"broken"})", "/failed_wheels/rf"},
      {R"(,"failed_wheels":{"rf":1})", "/failed_wheels/rf"},
      {R"(,"failed_wheels":{"fr":"locked"})", "/failed_wheels/fr"},
      {R"(,"planners":["rrt_starr"])", "/planners/0"},
      {R"(,"planners":["rrt_star","rrt_star"])", "/planners/1"},
      {R"(,"effects":[{"name":"slip_sinkage","parameters":{"n1":9}}])", "/effects/0/parameters/n1"},
      {R"(,"effects":[{"name":"slip_sinkage","parameters":{"n2":0.1}}])", "/effects/0/parameters/n2"},
      {R"(,"effects":[{"name":"ghost"}])", "/effects/0/name"},
      {R"(,"effects":[{}])", "/effects/0/name"},
      {R"(,"draws":0)", "/draws"},
      {R"(,"seed":-1)", "/seed"},
      {R"(,"seed":9007199254740993)", "/seed"},
      {R"(,"speed_m_s":0)", "/speed_m_s"},
      {R"(,"speed_m_s":0.5)", "/speed_m_s"},
      {R"(,"limits":{"max_slip":1.5})", "/limits/max_slip"},
      {R"(,"limits":null)", "/limits"},
      {R"(,"x":1)", "/x"}};
  for (const auto& [members, pointer] : cases) {
    const auto request = read_plan(small_world(), plan_with(members));
    ASSERT_FALSE(request) << members;
    EXPECT_EQ(pointers_of(request.error()), std::vector<std::string>{pointer}) << members;
  }
}

TEST(PlanRequest, AFailedWheelThatIsNotKnownIsRefusedWithThoseThatAre) {
  const auto wheel = read_plan(small_world(), plan_with(R"(,"failed_wheels":{"fr":"locked"})"));
  ASSERT_FALSE(wheel);
  EXPECT_NE(wheel.error().detail.find("unknown wheel \"fr\""), std::string::npos) << wheel.error().detail;
  EXPECT_NE(wheel.error().detail.find("known: lf, lm, lr, rf, rm, rr"), std::string::npos);
  const auto failure = read_plan(small_world(), plan_with(R"(,"failed_wheels":{"rf":"broken"})"));
  ASSERT_FALSE(failure);
  for (const char* known : {"locked", "free", "off"})
    EXPECT_NE(failure.error().detail.find(known), std::string::npos) << failure.error().detail;
}

TEST(PredictionRequest, ARoverThatDoesNotSteerDoesNotCrab) {
  const auto asked = [](const std::string& rover, const std::string& crab_deg) {
    return read_prediction(
        small_world(), R"({"terrain":"yard","rover":")" + rover +
                           R"(","path":[{"x_m":20,"y_m":30},{"x_m":28,"y_m":30}],"crab_deg":)" + crab_deg +
                           "}");
  };
  EXPECT_TRUE(asked("mer-class", "30"));
  EXPECT_TRUE(asked("cuadriga", "0"));
  const auto crab = asked("cuadriga", "30");
  ASSERT_FALSE(crab);
  EXPECT_EQ(pointers_of(crab.error()), std::vector<std::string>{"/crab_deg"});
  EXPECT_NE(crab.error().detail.find("the wheels of cuadriga don't steer (lf, lr, rf, rr)"),
            std::string::npos)
      << crab.error().detail;
}

TEST(PredictionRequest, TheRungIsReadAndEchoed) {
  const auto request = read_prediction(small_world(), example("prediction_dynamic.json"));
  ASSERT_TRUE(request) << request.error().detail;
  EXPECT_EQ(request->level, FidelityLevel::kDynamic);
  EXPECT_EQ(request->drive.failed_wheels.at("lr"), sim::WheelFailure::kOff);
  const auto plain = read_prediction(small_world(), example("prediction_path.json"));
  ASSERT_TRUE(plain);
  EXPECT_EQ(plain->level, FidelityLevel::kQuasiStatic);
  const std::string echoed = json::write_prediction_request(*request);
  const auto again = json::read_prediction_request(echoed);
  ASSERT_TRUE(again && again->faults.empty());
  EXPECT_EQ(json::write_prediction_request(again->request), echoed);
  const auto refused = read_prediction(
      small_world(),
      R"({"terrain":"yard","rover":"mer-class","path":[{"x_m":20,"y_m":30},{"x_m":21,"y_m":30}],"rung":"table"})");
  ASSERT_FALSE(refused);
  EXPECT_EQ(pointers_of(refused.error()), std::vector<std::string>{"/rung"});
}

TEST(PlanRequest, ABodyThatIsNoObjectIsRefusedOnce) {
  for (const char* body : {"[]", "null", "3", "\"plan\""}) {
    const auto request = read_plan(small_world(), body);
    ASSERT_FALSE(request);
    EXPECT_EQ(request.error().faults.front().pointer, "");
  }
}

TEST(PredictionRequest, APathThatLeavesTheTerrainNamesEachCorner) {
  const auto request = read_prediction(
      small_world(),
      R"({"terrain":"yard","rover":"mer-class","path":[{"x_m":20,"y_m":30},{"x_m":121,"y_m":30},{"x_m":85,"y_m":45}]})");
  ASSERT_FALSE(request);
  EXPECT_EQ(pointers_of(request.error()), (std::vector<std::string>{"/path/1", "/path/2"}));
}

TEST(PredictionRequest, APathHasTwoCornersAndNotTooMany) {
  const auto read = [](const std::string& path) {
    return read_prediction(small_world(), R"({"terrain":"yard","rover":"mer-class","path":[)" + path + "]}");
  };
  EXPECT_FALSE(read(R"({"x_m":20,"y_m":30})"));
  std::string many = R"({"x_m":20,"y_m":30})";
  for (std::size_t i = 0; i < RequestLimits::kPathCorners; ++i) many += R"(,{"x_m":20,"y_m":30})";
  const auto refused = read(many);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().detail, "path has 2001 elements, must have 2 to 2000");
}

TEST(PredictionRequest, WhatIsEchoedReadsBackAsTheSameRequest) {
  const auto first = json::read_prediction_request(example("prediction_path.json"));
  ASSERT_TRUE(first && first->faults.empty());
  const std::string echoed = json::write_prediction_request(first->request);
  const auto second = json::read_prediction_request(echoed);
  ASSERT_TRUE(second && second->faults.empty());
  EXPECT_EQ(json::write_prediction_request(second->request), echoed);
}

TEST(GroundAt, KnowsHeightSlopeAndSoil) {
  const auto at = ground_at(small_world(), "yard", 20.0, 20.0);
  ASSERT_TRUE(at);
  EXPECT_NEAR(at->height_m, 1.0, 0.01);
  EXPECT_NEAR(deg_from_rad(at->slope_rad), 2.86, 0.05);
  EXPECT_NEAR(deg_from_rad(at->aspect_rad), 270.0, 1.0) << "it falls to the west";
  EXPECT_EQ(at->soil, "mer_b_sandy_loam");
  EXPECT_EQ(at->label, "firm");
  EXPECT_LT(at->roughness_m.value(), 0.01);
  EXPECT_EQ(ground_at(small_world(), "yard", 115.0, 20.0)->soil, std::nullopt);
  EXPECT_EQ(ground_at(small_world(), "yard", 85.0, 45.0).error().code, ErrorCode::kNoData);
  EXPECT_EQ(ground_at(small_world(), "yard", 1e9, 45.0).error().code, ErrorCode::kOffMap);
  EXPECT_EQ(ground_at(small_world(), "../yard", 1.0, 45.0).error().code, ErrorCode::kNotFound);
}

}  // namespace
}  // namespace slipway::api
