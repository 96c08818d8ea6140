// A cost and a planner that somebody adds: one row each, and from the request's JSON to the answer's they act
// as those that are built in do.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "api/documents/catalogue_documents.h"
#include "api/documents/plan_answer.h"
#include "api/json/parse.h"
#include "api/service_drives.h"
#include "small_world.h"

namespace slipway::api {
namespace {

using json::JsonValue;

double right_angles(const planner::DriveFigures& drive) {
  return drive.turned_rad / (0.5 * M_PI);
}

std::span<const planner::CostTerm> costs_with_turning() {
  static const std::vector<planner::CostTerm> rows = [] {
    std::vector<planner::CostTerm> all(planner::cost_catalogue().begin(), planner::cost_catalogue().end());
    all.push_back({"turning",
                   "turns in place",
                   {"turning", "1/(90 deg)", "cost of a right angle turned in place", 0.0, 50.0, 0.0},
                   "90 deg",
                   right_angles});
    return all;
  }();
  return rows;
}

// Straight to the goal, whatever lies between.
class Beeline final : public planner::LegPlanner {
 public:
  std::vector<Pose2> search(const planner::LegSearch& leg) const override {
    return {leg.from, {leg.to_x_m, leg.to_y_m, leg.arrival_rad.front()}};
  }
};

std::span<const planner::PlannerRow> planners_with_beeline() {
  static const std::vector<planner::PlannerRow> rows = [] {
    std::vector<planner::PlannerRow> all(planner::planner_catalogue().begin(),
                                         planner::planner_catalogue().end());
    all.push_back({"beeline", "straight to the goal", "Euclid", false,
                   []() -> std::unique_ptr<planner::LegPlanner> { return std::make_unique<Beeline>(); }});
    return all;
  }();
  return rows;
}

const Service& extended_world() {
  static const testing::ScratchFolder folder;
  static const std::unique_ptr<Service> service = [] {
    testing::copy_small_world(folder.path());
    return std::move(Service::open({.data = folder.path(),
                                    .threads = 2,
                                    .costs = costs_with_turning(),
                                    .planners = planners_with_beeline()}))
        .value();
  }();
  return *service;
}

// From (20, 30), heading away from the goal.
std::string request_with(const std::string& members) {
  return R"({"terrain":"yard","rover":"mer-class","start":{"x_m":20,"y_m":30,"yaw_deg":170},)"
         R"("goal":{"x_m":45,"y_m":40},"draws":2)" +
         members + "}";
}

JsonValue answer_of(const Service& service, const std::string& request) {
  const auto read = read_plan(service, request);
  EXPECT_TRUE(read) << read.error().detail;
  NoProgress progress;
  const auto answer = run_plan(service, read.value(), progress);
  EXPECT_TRUE(answer) << answer.error().detail;
  return json::parse(json::write_plan_answer(answer.value())).value();
}

const JsonValue* share_of(const JsonValue& route, std::string_view name) {
  for (const JsonValue& share : route.find("cost_shares")->elements)
    if (share.find("name")->text == name) return &share;
  return nullptr;
}

// Why there are fewer routes than asked for, a line each.
std::string because(const JsonValue& answer) {
  std::string lines;
  for (const JsonValue& words : answer.find("fewer_because")->elements) lines += words.text + "\n";
  return lines;
}

double turned(const JsonValue& answer) {
  return share_of(answer.find("summary")->elements.at(0), "turning")->find("value")->number;
}

TEST(AddedCost, ActsFromTheRequestsWeightsToTheRoutesThatAreSearchedAndTheirShares) {
  const std::string one_route = R"(,"routes":1,"planners":["rrt_star"])";
  const JsonValue freely = answer_of(extended_world(), request_with(one_route));
  const JsonValue dearly =
      answer_of(extended_world(), request_with(R"(,"weights":{"turning":50})" + one_route));
  EXPECT_EQ(dearly.find("request")->find("weights")->find("turning")->number, 50.0);
  const JsonValue& route = dearly.find("summary")->elements.at(0);
  const JsonValue* const share = share_of(route, "turning");
  ASSERT_NE(share, nullptr);
  EXPECT_EQ(share->find("weight")->number, 50.0);
  EXPECT_NEAR(share->find("cost")->number, 50.0 * share->find("value")->number,
              1e-3 * share->find("cost")->number + 1e-9);
  double sum = 0.0;
  for (const JsonValue& each : route.find("cost_shares")->elements) sum += each.find("cost")->number;
  EXPECT_NEAR(route.find("cost")->number, sum, 1e-2 * sum);
  // Away from the goal by half a turn: in place where that is cheap, around an arc where it is dear.
  EXPECT_GT(turned(freely), 1.0);
  EXPECT_LT(turned(dearly), turned(freely));
}

TEST(AddedCost, IsReadAsStrictlyAsTheOthersAndListed) {
  const auto over = read_plan(extended_world(), request_with(R"(,"weights":{"turning":51})"));
  ASSERT_FALSE(over);
  EXPECT_EQ(over.error().faults.at(0).pointer, "/weights/turning");
  EXPECT_FALSE(read_plan(testing::small_world(), request_with(R"(,"weights":{"turning":5})")));
  const std::string listed =
      json::write_planners(extended_world().options().planners, extended_world().options().costs);
  EXPECT_NE(listed.find(R"("name":"turning")"), std::string::npos);
  EXPECT_EQ(json::write_planners().find(R"("name":"turning")"), std::string::npos);
}

TEST(AddedPlanner, IsListedAndReadByTheServiceThatHasIt) {
  EXPECT_TRUE(read_plan(extended_world(), request_with(R"(,"planners":["beeline"])")));
  EXPECT_FALSE(read_plan(testing::small_world(), request_with(R"(,"planners":["beeline"])")));
  const std::string listed =
      json::write_planners(extended_world().options().planners, extended_world().options().costs);
  EXPECT_NE(listed.find(R"("name":"beeline")"), std::string::npos);
}

TEST(AddedPlanner, GivesARouteOfItsOwnWhereTheStraightLineCanBeDriven) {
  const JsonValue answer = answer_of(
      extended_world(), R"({"terrain":"yard","rover":"mer-class","start":{"x_m":30,"y_m":40,"yaw_deg":270},)"
                        R"("goal":{"x_m":30,"y_m":30},"draws":2,"planners":["beeline"],"routes":1})");
  ASSERT_EQ(answer.find("summary")->elements.size(), 1U) << because(answer);
  EXPECT_EQ(answer.find("summary")->elements[0].find("planner")->text, "beeline");
}

// The straight line leads up a slope that is too much for this soil, which no keep-out has anything to do
// with.
TEST(AddedPlanner, WhoseRouteTheGroundClosesIsAnsweredWithThePlaceAndTheReason) {
  const JsonValue answer = answer_of(extended_world(), request_with(R"(,"planners":["beeline"])"));
  EXPECT_TRUE(answer.find("summary")->elements.empty());
  EXPECT_NE(
      because(answer).find("beeline found is closed at (20.0, 30.0), heading 22 deg: a slope of 2.9 deg "
                           "that the mean soil does not hold the rover on"),
      std::string::npos)
      << because(answer);
}

TEST(AddedPlanner, ThatHeedsNoKeepOutGivesNoRouteAndTheAnswerSaysWhere) {
  const JsonValue answer =
      answer_of(extended_world(),
                request_with(R"(,"planners":["beeline"],"keep_out":[[[30,30],[34,30],[34,40],[30,40]]])"));
  EXPECT_TRUE(answer.find("summary")->elements.empty());
  EXPECT_NE(because(answer).find("the rover's body would enter a keep-out, the first at (2"),
            std::string::npos)
      << because(answer);
}

}  // namespace
}  // namespace slipway::api
