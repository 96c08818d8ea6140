// From a plan to its commands to a check of them: the same verdict and the same bytes of figures.
#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <string>

#include "api/documents/check_answer.h"
#include "api/documents/drive_commands.h"
#include "api/documents/plan_answer.h"
#include "api/job_kinds.h"
#include "api/jobs/open_job_store.h"
#include "api/json/parse.h"
#include "api/json/writer.h"
#include "api/plan_reference.h"
#include "api/service_drives.h"
#include "small_world.h"

namespace slipway::api {
namespace {

using json::JsonValue;

std::string text_of(const JsonValue* value) {
  json::Writer w;
  if (value == nullptr) return {};
  json::write_value(w, *value);
  return w.take();
}

JsonValue parsed(const std::string& bytes) {
  return json::parse(bytes, {.bytes = bytes.size(), .values = bytes.size()}).value();
}

std::string planned(const Service& service, const std::string& request) {
  NoProgress progress;
  const auto read = read_plan(service, request);
  EXPECT_TRUE(read) << (read ? "" : read.error().detail);
  return json::write_plan_answer(run_plan(service, *read, progress).value());
}

std::string checked(const Service& service, const std::string& request) {
  NoProgress progress;
  const auto read = read_check(service, request);
  EXPECT_TRUE(read) << (read ? "" : read.error().detail);
  return json::write_check_answer(run_check(service, *read, progress).value());
}

// Every figure that a check of the route's commands has is the plan's.
void expect_same_figures(const JsonValue& plan, std::size_t route, const JsonValue& check) {
  const JsonValue& row = plan.find("summary")->elements[route];
  const JsonValue* const properties =
      plan.find("routes")->find("features")->elements[route].find("properties");
  const JsonValue* const of_check = check.find("routes")->find("features")->elements[0].find("properties");
  EXPECT_EQ(properties->find("decision")->find("verdict")->text, check.find("verdict")->text);
  EXPECT_EQ(text_of(properties->find("outcomes")), text_of(check.find("outcomes")));
  EXPECT_EQ(text_of(properties->find("position_uncertainty")), text_of(check.find("position_uncertainty")));
  EXPECT_EQ(text_of(properties->find("stations")), text_of(of_check->find("stations")));
  for (const std::string& key : check.find("summary")->keys)
    EXPECT_EQ(text_of(row.find(key)), text_of(check.find("summary")->find(key))) << key;
  EXPECT_EQ(text_of(row.find("commands")), text_of(check.find("request")->find("commands")));
  EXPECT_EQ(text_of(row.find("start")), text_of(check.find("request")->find("start")));
}

constexpr std::array<const char*, 6> kPairs{
    R"("start":{"x_m":8142640,"y_m":-276640},"goal":{"x_m":8142600,"y_m":-276645})",
    R"("start":{"x_m":8142579.733,"y_m":-276648.736},"goal":{"x_m":8142566.402,"y_m":-276711.667})",
    R"("start":{"x_m":8142600,"y_m":-276600,"yaw_deg":37.77},"goal":{"x_m":8142570,"y_m":-276630,"yaw_deg":-90})",
    R"("start":{"x_m":8142640,"y_m":-276640},"goal":{"x_m":8142655,"y_m":-276610},"limits":{"max_slip":0.5})",
    R"("start":{"x_m":8142560,"y_m":-276560},"goal":{"x_m":8142600,"y_m":-276580},"draws":40,"seed":7)",
    R"("start":{"x_m":8142520,"y_m":-276600},"goal":{"x_m":8142550,"y_m":-276580},"confidence":0.8,)"
    R"("keep_out":[[[8142535,-276592],[8142537,-276592],[8142537,-276590]]])",
};

class PlanCommandsOnGale : public ::testing::TestWithParam<const char*> {};

TEST_P(PlanCommandsOnGale, GiveACheckTheSameVerdictAndBytes) {
  const auto service = Service::open({.data = SLIPWAY_DATA_FOLDER});
  ASSERT_TRUE(service);
  const JsonValue plan = parsed(planned(
      **service, std::string(R"({"terrain":"gale","rover":"msl-class","routes":2,)") + GetParam() + "}"));
  const std::size_t routes = plan.find("summary")->elements.size();
  ASSERT_GT(routes, 0U) << text_of(plan.find("fewer_because"));
  for (std::size_t route = 0; route < routes; ++route) {
    const auto request = json::check_of_route(plan, static_cast<int>(route) + 1);
    ASSERT_TRUE(request);
    expect_same_figures(plan, route, parsed(checked(**service, *request)));
  }
  EXPECT_EQ(json::check_of_route(plan, 9).error().faults.at(0).pointer, "/route");
}

INSTANTIATE_TEST_SUITE_P(Pairs, PlanCommandsOnGale, ::testing::ValuesIn(kPairs));

constexpr const char* kYardPlan =
    R"({"terrain":"yard","rover":"mer-class","start":{"x_m":20,"y_m":30},"goal":{"x_m":26,"y_m":31},)"
    R"("routes":1,"draws":4,"limits":{"max_tilt_deg":20}})";

TEST(PlanCommands, AsATableReadBackAsTheSame) {
  const JsonValue plan = parsed(planned(testing::small_world(), kYardPlan));
  const auto csv = json::commands_table(plan, 1);
  ASSERT_TRUE(csv);
  const auto table = read_commands_csv(*csv, "route.csv");
  ASSERT_TRUE(table) << table.error().detail;
  EXPECT_EQ(write_commands_csv(*table), *csv);
  const JsonValue request = parsed(json::check_of_table(*table));
  const JsonValue& row = plan.find("summary")->elements[0];
  EXPECT_EQ(text_of(request.find("commands")), text_of(row.find("commands")));
  EXPECT_EQ(text_of(request.find("start")), text_of(row.find("start")));
  EXPECT_EQ(request.find("rover")->text, "mer-class");
}

class APlanOfAJob : public ::testing::Test {
 protected:
  void add(const std::string& id, std::string_view kind, const std::string& outcome) {
    ASSERT_TRUE(store_->append({id, std::string(kind), "{}"}, 0, {10}));
    const auto claimed = store_->claim("test", {std::string(kind)}, 0, 1000);
    ASSERT_TRUE(claimed && *claimed);
    ASSERT_TRUE(store_->finish((*claimed)->lease(), JobState::kSuccessful, outcome, 1));
  }
  std::string pointer_of(const std::string& body) {
    const auto request = with_plans_route(body, *store_);
    return request ? "" : request.error().faults.at(0).pointer;
  }

  std::unique_ptr<JobStore> store_ = open_job_store("").value();
};

TEST_F(APlanOfAJob, IsCheckedByItsName) {
  const std::string answer = planned(testing::small_world(), kYardPlan);
  add("p1", kPlanKind, answer);
  const auto request = with_plans_route(R"({"plan":"p1"})", *store_);
  ASSERT_TRUE(request) << request.error().detail;
  expect_same_figures(parsed(answer), 0, parsed(checked(testing::small_world(), *request)));
  // What the body says itself stands over the plan's.
  const auto tighter = with_plans_route(R"({"plan":"p1","route":1,"limits":{"max_slip":0.3}})", *store_);
  ASSERT_TRUE(tighter);
  const JsonValue limits = *parsed(*tighter).find("limits");
  EXPECT_EQ(limits.find("max_slip")->number, 0.3);
  EXPECT_EQ(limits.find("max_tilt_deg")->number, 20.0);
}

TEST_F(APlanOfAJob, ThatIsNoneOrHasNoSuchRouteIsRefusedAtItsPlace) {
  add("p1", kPlanKind, planned(testing::small_world(), kYardPlan));
  add("c1", kCheckKind, "{}");
  EXPECT_EQ(pointer_of(R"({"plan":"none"})"), "/plan");
  EXPECT_EQ(pointer_of(R"({"plan":"c1"})"), "/plan");
  EXPECT_EQ(pointer_of(R"({"plan":"p1","route":2})"), "/route");
  EXPECT_EQ(pointer_of(R"({"plan":"p1","route":0})"), "/route");
  EXPECT_EQ(pointer_of(R"({"plan":"p1","path":[]})"), "/path");
  // Others stay as they came.
  EXPECT_EQ(*with_plans_route(R"( {"terrain": "yard"})", *store_), R"( {"terrain": "yard"})");
}

TEST(PlanCommands, APlanToTheSamePlaceIsRefusedAndNamesBoth) {
  const auto read = read_plan(
      testing::small_world(),
      R"({"terrain":"yard","rover":"mer-class","start":{"x_m":20,"y_m":30},"goal":{"x_m":20,"y_m":30}})");
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().code, ErrorCode::kInvalidRequest);
  EXPECT_EQ(read.error().faults.at(0).pointer, "/goal");
  EXPECT_NE(read.error().faults.at(0).message.find("/start"), std::string::npos);
}

}  // namespace
}  // namespace slipway::api
